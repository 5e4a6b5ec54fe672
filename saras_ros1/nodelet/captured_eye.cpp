#include "captured_eye.hpp"

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/String.h>

#include <algorithm>

#include "jpeg.hpp"

namespace saras_ros1 {
namespace {

constexpr std::uint32_t kQueue = 2;  // a viewer that is slow gets the newest picture, not the last twenty

/// With its plugin installed image_transport publishes …/compressed by itself.
bool transport_compresses(const image_transport::ImageTransport& transport) {
  const std::vector<std::string> known = transport.getLoadableTransports();
  return std::find(known.begin(), known.end(), "image_transport/compressed") != known.end();
}

std::string size_text(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

/// Rows may begin further apart in pixels than in the message.
void copy_rows(const saras::ImageView& pixels, std::size_t row_bytes, std::vector<std::uint8_t>& data) {
  data.reserve(row_bytes * static_cast<std::size_t>(pixels.height));
  for (int y = 0; y < pixels.height; ++y) {
    const std::uint8_t* const row = pixels.data + static_cast<std::size_t>(y) * pixels.stride;
    data.insert(data.end(), row, row + row_bytes);
  }
}

}  // namespace

CapturedEye::CapturedEye(ros::NodeHandle& handle, image_transport::ImageTransport& transport, CapturedEyeConfig config)
    : config_(std::move(config)), frame_("endoscope_" + config_.side + "_optical"), looked_at_(ros::SteadyTime::now()) {
  if (config_.frozen_s > 0.0) {
    watch_.emplace(saras::FrozenWatchConfig{config_.frozen_s});
  }
  const std::string base = config_.topics + "/" + config_.side;
  image_ = transport.advertise(base + "/image_raw", kQueue);
  if (!transport_compresses(transport)) {
    jpeg_ = handle.advertise<sensor_msgs::CompressedImage>(base + "/image_raw/compressed", kQueue);
  }
  info_ = handle.advertise<sensor_msgs::CameraInfo>(base + "/camera_info", kQueue);
  said_ = handle.advertise<std_msgs::String>(base + "/status", 5, true);
  std_msgs::String first;
  first.data = status_;
  said_.publish(first);
}

void CapturedEye::say(const std::string& status) {
  if (status == status_) {
    return;
  }
  status_ = status;
  if (status == "OK") {
    ROS_INFO("%s eye: OK", config_.side.c_str());
  } else {
    ROS_ERROR("%s eye: %s", config_.side.c_str(), status.c_str());
  }
  std_msgs::String message;
  message.data = status;
  said_.publish(message);
}

bool CapturedEye::frozen(const Picture& picture) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double dt = (now - looked_at_).toSec();
  looked_at_ = now;
  return watch_ && watch_->step({saras::fingerprint(picture.pixels)}, dt).frozen;
}

void CapturedEye::show(const Picture& picture, const ros::Time& stamp) {
  if (frozen(picture)) {
    say("FROZEN");
    return;
  }
  say("OK");
  publish_info(picture.pixels, stamp);
  publish_image(picture.pixels, stamp);
  publish_jpeg(picture.pixels, stamp);
  ++shown_;
}

void CapturedEye::publish_info(const saras::ImageView& pixels, const ros::Time& stamp) {
  const auto info = boost::make_shared<sensor_msgs::CameraInfo>();
  const auto width = static_cast<std::uint32_t>(pixels.width), height = static_cast<std::uint32_t>(pixels.height);
  wrong_size_.clear();
  if (config_.calibration) {
    const sensor_msgs::CameraInfo& known = *config_.calibration;
    if (known.width == width && known.height == height) {
      *info = known;
    } else {  // numbers of another size would put the overlay elsewhere
      wrong_size_ = "pictures are " + size_text(width, height) + ", calibrated " + size_text(known.width, known.height);
    }
  }
  info->width = width;
  info->height = height;
  info->header.stamp = stamp;
  info->header.frame_id = frame_;
  info_.publish(sensor_msgs::CameraInfoConstPtr(info));
}

void CapturedEye::publish_image(const saras::ImageView& pixels, const ros::Time& stamp) {
  if (image_.getNumSubscribers() == 0) {
    return;
  }
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.stamp = stamp;
  image->header.frame_id = frame_;
  image->width = static_cast<std::uint32_t>(pixels.width);
  image->height = static_cast<std::uint32_t>(pixels.height);
  image->encoding = sensor_msgs::image_encodings::BGR8;
  image->step = image->width * 3;
  copy_rows(pixels, image->step, image->data);
  image_.publish(sensor_msgs::ImageConstPtr(image));
  shared_ += image.use_count() > 1 ? 1 : 0;
}

void CapturedEye::publish_jpeg(const saras::ImageView& pixels, const ros::Time& stamp) {
  if (!jpeg_ || jpeg_.getNumSubscribers() == 0) {
    return;
  }
  const auto message = boost::make_shared<sensor_msgs::CompressedImage>();
  message->header.stamp = stamp;
  message->header.frame_id = frame_;
  message->format = "bgr8; jpeg compressed bgr8";
  message->data = jpeg(pixels, config_.jpeg_quality);
  if (!message->data.empty()) {
    jpeg_.publish(sensor_msgs::CompressedImageConstPtr(message));
  }
}

}  // namespace saras_ros1
