// One side of the captured endoscope: its calibration, its topics, and whether it is worth looking at.
#pragma once

#include <image_transport/image_transport.h>
#include <sensor_msgs/CameraInfo.h>

#include <optional>

#include "picture.hpp"
#include "saras/overlay/image_watch.hpp"

namespace saras_ros1 {

struct CapturedEyeConfig {
  std::string side;       ///< left | right
  std::string topics;     ///< what the names of its topics begin with
  int jpeg_quality = 80;  ///< of image_raw/compressed
  double frozen_s = 0.2;  ///< a picture repeated for so long is frozen; 0: never
  std::optional<sensor_msgs::CameraInfo> calibration;
};

/// Not for two threads at once.
class CapturedEye {
 public:
  CapturedEye(ros::NodeHandle& handle, image_transport::ImageTransport& transport, CapturedEyeConfig config);

  /// On …/status, when it changes.
  void say(const std::string& status);
  /// Publishes, unless the picture is the one that was there all the time: old data gets no new stamp.
  void show(const Picture& picture, const ros::Time& stamp);

  const std::string& side() const { return config_.side; }
  /// OK, or what is wrong.
  const std::string& condition() const { return wrong_size_.empty() ? status_ : wrong_size_; }
  std::uint64_t shown() const { return shown_; }
  /// Pictures that a reader in this process holds as they were filled here: no byte of them was copied.
  std::uint64_t shared() const { return shared_; }

 private:
  bool frozen(const Picture& picture);
  void publish_info(const saras::ImageView& pixels, const ros::Time& stamp);
  void publish_image(const saras::ImageView& pixels, const ros::Time& stamp);
  void publish_jpeg(const saras::ImageView& pixels, const ros::Time& stamp);

  CapturedEyeConfig config_;
  std::string frame_;
  std::optional<saras::FrozenWatch> watch_;
  ros::SteadyTime looked_at_;
  std::string status_ = "STARTING", wrong_size_;
  std::uint64_t shown_ = 0, shared_ = 0;
  image_transport::Publisher image_;
  ros::Publisher jpeg_, info_, said_;
};

}  // namespace saras_ros1
