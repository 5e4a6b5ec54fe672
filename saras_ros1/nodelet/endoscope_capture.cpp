#include "endoscope_capture.hpp"

#include <cmath>
#include <cstdlib>
#include <pluginlib/class_list_macros.hpp>
#include <sstream>

#include "camera_file.hpp"
#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

constexpr std::array<const char*, 2> kSides = {"left", "right"};

Layout layout_of(const std::string& name) {
  return name == "side_by_side" ? Layout::kSideBySide : name == "top_bottom" ? Layout::kTopBottom : Layout::kTwoDevices;
}

ros::Time stamp_of(std::int64_t taken_ns) {
  ros::Time stamp;
  return stamp.fromNSec(static_cast<std::uint64_t>(taken_ns));
}

/// One decimal, as people read it.
std::string one_decimal(double value) {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(1);
  text << value;
  return text.str();
}

}  // namespace

EndoscopeCapture::~EndoscopeCapture() {
  reporter_.stop();
  for (const std::unique_ptr<Grabber>& grabber : grabbers_) {
    grabber->stop();
  }
}

void EndoscopeCapture::onInit() {
  try {
    start();
  } catch (const saras::Error& error) {
    NODELET_FATAL("%s: configuration refused: %s", getName().c_str(), error.what());
    throw;
  }
}

void EndoscopeCapture::start() {
  Parameters own(getPrivateNodeHandle());
  layout_ = layout_of(own.choice("layout", {"two_devices", "side_by_side", "top_bottom"}));
  swap_ = own.flag("swap");
  saras::StereoPairingConfig pairing;
  pairing.max_skew_s = own.number("skew_s", 0.0, 0.5);
  make_grabbers(own);
  pairing.wait_s = own.number("silence_s", 0.1, 60.0);  // the next picture of its own eye ends the wait before that
  pairing_.emplace(pairing);
  make_eyes(own);
  diagnostics_ = getNodeHandle().advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 20);
  paired_at_ = reported_at_ = ros::SteadyTime::now();
  reporter_ = getNodeHandle().createSteadyTimer(ros::WallDuration(1.0), &EndoscopeCapture::report, this);
  for (const std::unique_ptr<Grabber>& grabber : grabbers_) {
    grabber->start();
  }
  NODELET_INFO("%s runs", getName().c_str());
}

void EndoscopeCapture::make_grabbers(Parameters& own) {
  CaptureSource wanted;
  wanted.width = own.integer("width", 0, 8192);
  wanted.height = own.integer("height", 0, 8192);
  wanted.rate_hz = own.number("rate_hz", 0.0, 240.0);
  GrabberConfig config;
  config.loop = own.flag("loop");
  config.latency_s = own.number("latency_s", 0.0, 1.0);
  config.silence_s = own.number("silence_s", 0.1, 60.0);
  config.retry_s = own.number("retry_s", 0.1, 600.0);
  const bool two = layout_ == Layout::kTwoDevices;
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    const std::string side = kSides[i];
    wanted.kind = own.choice(side + "/source", source_kinds());
    wanted.device = own.text_or_empty(side + "/device");
    wanted.options = own.text_or_empty(side + "/options");
    if (i == 1 && !two) {
      continue;  // both eyes come from the left one
    }
    try {
      config.source = source_text(wanted);
    } catch (const saras::ConfigError& error) {
      throw saras::ConfigError(getName() + "/" + side + ": " + error.what());
    }
    config.name = two ? side + " eye" : "endoscope";
    const std::size_t eye = swap_ ? 1 - i : i;
    const EyeRange of = two ? EyeRange{eye, eye + 1} : EyeRange{0, 2};
    grabbers_.push_back(std::make_unique<Grabber>(
        config, [this, two, eye](const Picture& picture) { two ? on_one(eye, picture) : on_both(picture); },
        [this, of](const std::string& state) { on_state(of, state); }));
  }
}

void EndoscopeCapture::make_eyes(Parameters& own) {
  CapturedEyeConfig config;
  config.topics = own.text("topics");
  config.frozen_s = own.number("frozen_s", 0.0, 10.0);
  config.jpeg_quality = own.integer("jpeg_quality", 10, 100);
  std::array<std::optional<sensor_msgs::CameraInfo>, 2> calibrations;
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    const std::string entry = std::string("camera_info/") + kSides[i], file = own.text_or_empty(entry);
    if (file.empty()) {
      NODELET_WARN("%s: %s eye is not calibrated: nothing can be drawn on its pictures", getName().c_str(), kSides[i]);
    } else if (file[0] != '/') {  // roslaunch starts nodes in a directory of its own
      throw saras::ConfigError(getName() + "/" + entry + " = " + file + ": must be an absolute path");
    } else {
      try {
        calibrations[i] = read_camera_file(file);
      } catch (const saras::ConfigError& error) {
        throw saras::ConfigError(getName() + "/" + entry + ": " + error.what());
      }
    }
  }
  own.finish();
  image_transport::ImageTransport transport(getNodeHandle());
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    config.side = kSides[i];
    config.calibration = calibrations[i];
    eyes_[i] = std::make_unique<CapturedEye>(getNodeHandle(), transport, config);
  }
}

void EndoscopeCapture::on_state(EyeRange eyes, const std::string& state) {
  if (state == "OK") {
    return;  // each eye says it by its own pictures
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  saras::StereoPairingState pairing = pairing_->state();
  for (std::size_t i = eyes[0]; i < eyes[1]; ++i) {
    pairing.waiting[i] = false;  // a picture of before must not be shown after it
    eyes_[i]->say(state);
  }
  pairing_->reset(pairing);
}

void EndoscopeCapture::on_both(const Picture& picture) {
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    const std::array<Picture, 2> both = halves(picture, layout_);
    const ros::Time stamp = stamp_of(picture.taken_ns);
    for (std::size_t i = 0; i < eyes_.size(); ++i) {
      eyes_[i]->show(both[swap_ ? 1 - i : i], stamp);
    }
  } catch (const saras::ConfigError& error) {
    for (const std::unique_ptr<CapturedEye>& eye : eyes_) {
      eye->say(std::string("LOST: ") + error.what());
    }
  }
}

// Two devices, from two threads. A pair gets one stamp; what stays alone keeps its own, and readers see for themselves
// that the eyes are out of step.
void EndoscopeCapture::on_one(std::size_t eye, const Picture& picture) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::size_t other = 1 - eye;
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double dt = (now - paired_at_).toSec();
  paired_at_ = now;
  taken_ns_[eye] = picture.taken_ns;
  const auto side = eye == 0 ? saras::EyeSide::kLeft : saras::EyeSide::kRight;
  const saras::StereoPairingOutput output = pairing_->step({side, picture.taken_ns}, dt);
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    if (output.waiting_alone[i]) {
      release_alone(i);
    }
  }
  if (output.pair) {
    const Picture& partner = waiting_[other].picture;
    const ros::Time stamp = stamp_of(partner.taken_ns + (picture.taken_ns - partner.taken_ns) / 2);
    eyes_[other]->show(partner, stamp);
    eyes_[eye]->show(picture, stamp);
  } else if (output.arrived_alone) {
    ++unpaired_;
    eyes_[eye]->show(picture, stamp_of(picture.taken_ns));
  } else {
    Waiting& kept = waiting_[eye];
    const saras::ImageView& view = picture.pixels;
    kept.bytes.assign(view.data, view.data + view.stride * static_cast<std::size_t>(view.height));
    kept.picture = picture;
    kept.picture.pixels.data = kept.bytes.data();
  }
}

void EndoscopeCapture::release_alone(std::size_t eye) {
  ++unpaired_;
  eyes_[eye]->show(waiting_[eye].picture, stamp_of(waiting_[eye].picture.taken_ns));
}

void EndoscopeCapture::report(const ros::SteadyTimerEvent&) {
  diagnostic_msgs::DiagnosticStatus status;
  status.name = getName();
  const auto add = [&](const std::string& key, const std::string& value) {
    diagnostic_msgs::KeyValue pair;
    pair.key = key;
    pair.value = value;
    status.values.push_back(pair);
  };
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const ros::SteadyTime now = ros::SteadyTime::now();
    const double span_s = std::max((now - reported_at_).toSec(), 1e-3);
    const std::uint64_t shown = eyes_[0]->shown() + eyes_[1]->shown();
    add("rate_hz", one_decimal(0.5 * static_cast<double>(shown - reported_shown_) / span_s));
    reported_at_ = now;
    reported_shown_ = shown;
    add("unpaired", std::to_string(unpaired_));
    const bool both = taken_ns_[0] != 0 && taken_ns_[1] != 0;
    add("skew_ms", one_decimal(both ? 1e-6 * static_cast<double>(taken_ns_[1] - taken_ns_[0]) : 0.0));
    for (const std::unique_ptr<CapturedEye>& eye : eyes_) {
      if (eye->condition() != "OK") {
        status.message += (status.message.empty() ? "" : "; ") + eye->side() + " eye " + eye->condition();
      }
      add(eye->side(), eye->condition());
      add(eye->side() + " shown", std::to_string(eye->shown()));
      add(eye->side() + " shared", std::to_string(eye->shared()));
    }
  }
  for (const std::unique_ptr<Grabber>& grabber : grabbers_) {
    add(grabber->name(), grabber->state() + " frames=" + std::to_string(grabber->pictures()) +
                             " failures=" + std::to_string(grabber->failures()));
  }
  status.level =
      status.message.empty() ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN;
  status.message = status.message.empty() ? "RUNNING" : status.message;
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ros::Time::now();
  array.status.push_back(status);
  diagnostics_.publish(array);
}

}  // namespace saras_ros1

PLUGINLIB_EXPORT_CLASS(saras_ros1::EndoscopeCapture, nodelet::Nodelet)
