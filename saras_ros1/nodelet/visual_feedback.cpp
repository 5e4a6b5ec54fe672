#include "visual_feedback.hpp"

#include <pluginlib/class_list_macros.hpp>

#include "parameters.hpp"
#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

constexpr std::array<const char*, 2> kEyes = {"left", "right"};
constexpr double kTimer_s = 0.03;
constexpr double kTellAgain_s = 0.5;  // that an eye is silent

bool same_camera(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.width == b.width && a.height == b.height && a.K == b.K && a.R == b.R && a.P == b.P && a.D == b.D &&
         a.distortion_model == b.distortion_model && a.binning_x == b.binning_x && a.binning_y == b.binning_y &&
         a.roi == b.roi;
}

double seconds_since(const ros::SteadyTime& then) { return (ros::SteadyTime::now() - then).toSec(); }

}  // namespace

void VisualFeedback::onInit() {
  try {
    start();
  } catch (const saras::Error& error) {
    NODELET_FATAL("%s: configuration refused: %s", getName().c_str(), error.what());
    throw;
  }
}

void VisualFeedback::read_parameters() {
  Parameters own(getPrivateNodeHandle());
  camera_ = own.text("camera");
  image_topic_ = own.text("image");
  info_topic_ = own.text("camera_info");
  rectified_ = own.flag("rectified");
  near_m_ = own.number("near_m", 1e-4, 1.0);
  silent_after_s_ = own.number("silent_after_s", 0.05, 5.0);
  sources_config_.tools = own.texts("tools");
  if (sources_config_.tools.size() > static_cast<std::size_t>(saras::kMaxTools)) {
    throw saras::ConfigError("tools: more than " + std::to_string(saras::kMaxTools));
  }
  const std::string frame = own.text("optical_frame");
  sources_config_.optical_frame = frame == "image" ? "" : frame;
  sources_config_.frame_is_raw = own.choice("optical_frame_is", {"raw", "rectified"}) == "raw";
  saras::ToolOverlayConfig law;
  law.witness_below_m = own.number("witness_below_m", 0.0, 1.0);
  law.distances_timeout_s = own.number("distances_timeout_s", 0.02, 0.15);
  law.tools_timeout_s = own.number("tools_timeout_s", 0.02, 0.15);
  law.camera_timeout_s = own.number("camera_timeout_s", 0.02, 1.0);
  map_pose_within_s_ = law.camera_timeout_s;
  sources_config_.places_within_s = law.tools_timeout_s;
  const saras::FrozenWatchConfig frozen{own.number("frozen_after_s", 0.02, 0.2)};
  saras::StereoPairingConfig pairing;
  pairing.max_skew_s = own.number("max_skew_s", 0.0, 0.1);
  pairing.wait_s = own.number("pair_wait_s", 0.005, 0.5);
  style_.line_m = own.number("style/line_m", 1e-5, 0.1);
  style_.least_line_px = own.number("style/least_line_px", 0.5, 100.0);
  style_.greatest_line_px = own.number("style/greatest_line_px", 0.5, 200.0);
  style_.ruler_step_m = own.number("style/ruler_step_m", 0.0, 1.0);
  style_.ruler_ticks = own.integer("style/ruler_ticks", 0, 20);
  style_.text_height = own.number("style/text_height", 0.01, 0.2);
  style_.panel = own.flag("style/panel");
  inset_wanted_ = own.flag("awareness_inset");
  inset_style_.width = own.number("inset/width", 0.1, 0.5);
  inset_style_.span_m = own.number("inset/span_m", 0.001, 1.0);
  inset_style_.arrow_m_per_N = own.number("inset/arrow_m_per_N", 1e-4, 1.0);
  map_wanted_ = own.flag("stiffness_map");
  map_timeout_s_ = own.number("stiffness/timeout_s", 0.1, 60.0);
  stiffness_style_.low_N_m = own.number("stiffness/low_N_m", 0.0, 1e6);
  stiffness_style_.high_N_m = own.number("stiffness/high_N_m", 0.0, 1e6);
  stiffness_style_.opacity = own.number("stiffness/opacity", 0.05, 1.0);
  stiffness_style_.uncertain_std_N_m = own.number("stiffness/uncertain_std_N_m", 1.0, 1e6);
  stiffness_style_.faint_opacity = own.number("stiffness/faint_opacity", 0.0, 1.0);
  stiffness_style_.validate();
  own.text("image_transport");  // read by image_transport itself
  own.finish();
  style_.validate();
  // The colours change where the states of colliding_regions do: its own thresholds, not a copy of them.
  Parameters collision(ros::NodeHandle("/colliding_regions/law"));
  law.collision_m = collision.number("collision_m", 0.0, 1e3);
  law.warning_m = collision.number("warning_m", 0.0, 1e3);
  law.hysteresis_m = collision.number("hysteresis_m", 0.0, 1e3);
  law_.emplace(law);
  pairing_.emplace(pairing);
  for (Eye& eye : eyes_) {
    eye.frozen_watch.emplace(frozen);
  }
}

void VisualFeedback::start() {
  read_parameters();
  sources_ = std::make_unique<OverlaySources>(getMTNodeHandle(), sources_config_);
  if (inset_wanted_) {
    awareness_ = std::make_unique<AwarenessSource>(getMTNodeHandle());
  }
  if (map_wanted_) {
    stiffness_ = std::make_unique<StiffnessSource>(getMTNodeHandle(), map_timeout_s_);
  }
  ros::NodeHandle& handle = getNodeHandle();
  image_transport::ImageTransport transport(handle);
  stepped_at_ = drawn_at_ = ros::SteadyTime::now();
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    Eye& eye = eyes_[i];
    eye.name = kEyes[i];
    const std::string base = camera_ + "/" + eye.name + "/";
    eye.out = transport.advertise(base + "image_overlay", 2);
    eye.infos = handle.subscribe<sensor_msgs::CameraInfo>(
        base + info_topic_, 1, [this, i](const sensor_msgs::CameraInfoConstPtr& info) { on_info(i, info); });
    const image_transport::TransportHints hints("raw", ros::TransportHints().tcpNoDelay(), getPrivateNodeHandle());
    eye.images = transport.subscribe(
        base + image_topic_, 1, [this, i](const sensor_msgs::ImageConstPtr& image) { on_image(i, image); }, {}, hints);
  }
  diagnostics_ = handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 20);
  timer_ = handle.createSteadyTimer(ros::WallDuration(kTimer_s), &VisualFeedback::on_timer, this);
  reporter_ = handle.createSteadyTimer(ros::WallDuration(1.0), &VisualFeedback::report, this);
  NODELET_INFO("%s runs", getName().c_str());
}

void VisualFeedback::on_info(std::size_t i, const sensor_msgs::CameraInfoConstPtr& info) {
  Eye& eye = eyes_[i];
  if ((eye.painter || !eye.why_no_painter.empty()) && same_camera(*info, eye.info)) {
    return;
  }
  eye.info = *info;
  eye.painter.reset();
  eye.inset.reset();
  eye.stiffness.reset();
  try {
    const saras::CameraConfig camera = camera_config(*info, rectified_, near_m_);
    eye.painter.emplace(camera, style_);
    if (inset_wanted_) {
      eye.inset.emplace(camera.width_px, camera.height_px, inset_style_);
    }
    if (map_wanted_) {
      eye.stiffness = std::make_unique<saras::StiffnessOverlay>(camera, stiffness_style_);
    }
    eye.rectified_R_raw = camera.R;
    eye.why_no_painter.clear();
  } catch (const saras::ConfigError& error) {
    eye.why_no_painter = error.what();
    NODELET_WARN("%s: %s eye has no overlay: %s", getName().c_str(), eye.name, error.what());
  }
}

double VisualFeedback::since_last_step() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double dt = (now - stepped_at_).toSec();
  stepped_at_ = now;
  return std::max(dt, 1e-9);
}

void VisualFeedback::on_image(std::size_t i, const sensor_msgs::ImageConstPtr& image) {
  Eye& eye = eyes_[i];
  ++eye.received;
  const double dt = eye.last_at.isZero() ? kTimer_s : seconds_since(eye.last_at);
  eye.last = image;
  eye.last_at = ros::SteadyTime::now();
  eye.told_at = ros::SteadyTime();
  saras::ImageView view;
  // Only read: the pixels belong to whoever published them.
  if (view_of(const_cast<sensor_msgs::Image&>(*image), view)) {
    eye.frozen = eye.frozen_watch->step({saras::fingerprint(view)}, dt).frozen;
    eye.frozen_images += eye.frozen ? 1 : 0;
  }
  const auto side = i == 0 ? saras::EyeSide::kLeft : saras::EyeSide::kRight;
  const auto stamp_ns = static_cast<std::int64_t>(image->header.stamp.toNSec());
  const saras::StereoPairingOutput output = pairing_->step({side, stamp_ns}, since_last_step());
  follow_pairing(output);
  if (output.pair) {
    Eye& other = eyes_[1 - i];
    std::array<sensor_msgs::ImageConstPtr, 2> pair;
    pair[i] = image;
    pair[1 - i] = std::move(other.waiting);
    other.waiting.reset();
    release_pair(pair);
  } else if (output.arrived_alone) {
    release_alone(i, image);
  } else {
    eye.waiting = image;
  }
}

void VisualFeedback::follow_pairing(const saras::StereoPairingOutput& output) {
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    if (output.waiting_alone[i] && eyes_[i].waiting) {
      const sensor_msgs::ImageConstPtr image = std::move(eyes_[i].waiting);
      eyes_[i].waiting.reset();
      release_alone(i, image);
    }
  }
}

void VisualFeedback::release_alone(std::size_t i, const sensor_msgs::ImageConstPtr& image) {
  ++eyes_[i].alone;
  const bool frozen = eyes_[i].frozen;
  publish(i, image, frozen ? saras::OverlayNotice::kFrozen : saras::OverlayNotice::kOutOfStep, nullptr);
}

// Both eyes show one moment: tools, ages and the camera's pose are taken once.
void VisualFeedback::release_pair(const std::array<sensor_msgs::ImageConstPtr, 2>& images) {
  saras::ToolOverlayInput input;
  sources_->fill(images[0]->header, eyes_[0].rectified_R_raw, input);
  look_at_map(images[0]->header);
  const double dt = seconds_since(drawn_at_);
  drawn_at_ = ros::SteadyTime::now();
  const saras::ToolOverlayOutput tools = law_->step(input, std::max(dt, 1e-9));
  // A frozen eye takes the overlay from both: tools that move over a picture that does not would look like truth.
  const bool frozen = eyes_[0].frozen || eyes_[1].frozen;
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    publish(i, images[i], frozen ? saras::OverlayNotice::kFrozen : saras::OverlayNotice::kNone, &tools);
  }
}

void VisualFeedback::publish(std::size_t i, const sensor_msgs::ImageConstPtr& image, saras::OverlayNotice notice,
                             const saras::ToolOverlayOutput* tools) {
  Eye& eye = eyes_[i];
  saras::ImageView view;
  if (!view_of(const_cast<sensor_msgs::Image&>(*image), view)) {
    ++eye.refused;
    eye.why_not = "encoding, or too few bytes";
    eye.out.publish(image);  // as it is: what cannot be drawn on cannot be written on either
    return;
  }
  const bool watched = eye.out.getNumSubscribers() > 0;
  const auto begin = ros::SteadyTime::now();
  sensor_msgs::ImagePtr copy;
  if (watched) {
    copy = boost::make_shared<sensor_msgs::Image>(*image);
    view_of(*copy, view);
  }
  if (notice == saras::OverlayNotice::kNone && !eye.painter) {
    notice = saras::OverlayNotice::kNoIntrinsics;
  }
  if (notice == saras::OverlayNotice::kNone && tools != nullptr) {
    const saras::CameraConfig& camera = eye.painter->eye().config();
    if (view.width != camera.width_px || view.height != camera.height_px) {
      notice = saras::OverlayNotice::kSizeDiffers;
    } else {
      if (watched) {
        draw_map(eye, view);  // under the tools
        eye.painter->draw(*tools, view);
        draw_inset(eye, view);
      }
      notice = tools->camera_known ? saras::OverlayNotice::kNone : saras::OverlayNotice::kNoCameraPose;
      ++eye.drawn;
      eye.unknown_tools += tools->status == saras::Status::kOk ? 0 : 1;
      eye.ages.add((ros::Time::now() - image->header.stamp).toSec());
    }
  }
  eye.why_not = saras::to_string(notice);
  if (watched) {
    notices_.draw(notice, view);
    eye.out.publish(copy);
  }
  eye.draw_s += seconds_since(begin);
}

void VisualFeedback::look_at_map(const std_msgs::Header& left_image) {
  map_.reset();
  if (!stiffness_) {
    return;
  }
  map_ = stiffness_->map(map_why_not_);
  if (map_ && !sources_->left_T(map_->frame, left_image, eyes_[0].rectified_R_raw, map_pose_within_s_, left_T_map_)) {
    map_why_not_ = "stiffness map: tf does not know its frame " + map_->frame;
    map_.reset();
  }
}

void VisualFeedback::draw_map(Eye& eye, const saras::ImageView& image) {
  if (!eye.stiffness) {
    return;
  }
  if (!map_) {
    eye.stiffness->draw_unknown(image);
    return;
  }
  saras::StiffnessMapView view;
  view.vertices = map_->vertices.data();
  view.vertex_count = static_cast<int>(map_->vertices.size());
  view.triangles = map_->triangles.data();
  view.triangle_count = static_cast<int>(map_->triangles.size());
  view.left_T_map = left_T_map_;
  eye.stiffness->draw(view, image);
}

void VisualFeedback::draw_inset(const Eye& eye, const saras::ImageView& image) {
  saras::AwarenessView view;
  if (awareness_ && eye.inset && awareness_->fill(view)) {
    const AwarenessSource::Map map = awareness_->map();
    view.dots = map ? map->data() : nullptr;
    view.dot_count = map ? static_cast<int>(map->size()) : 0;
    eye.inset->draw(view, image);
  }
}

void VisualFeedback::on_timer(const ros::SteadyTimerEvent&) {
  follow_pairing(pairing_->step({}, since_last_step()));
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    Eye& eye = eyes_[i];
    // Viewers keep the last picture: when none comes any more, it is sent again, with the word that it is old.
    const bool silent = eye.last && seconds_since(eye.last_at) > silent_after_s_;
    if (silent && (eye.told_at.isZero() || seconds_since(eye.told_at) > kTellAgain_s)) {
      eye.told_at = ros::SteadyTime::now();
      eye.frozen = true;
      publish(i, eye.last, saras::OverlayNotice::kFrozen, nullptr);
    }
  }
}

void VisualFeedback::report(const ros::SteadyTimerEvent&) {
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ros::Time::now();
  diagnostic_msgs::DiagnosticStatus status;
  status.name = getName();
  status.message = "RUNNING";
  const auto add = [&](const std::string& key, const std::string& value) {
    diagnostic_msgs::KeyValue pair;
    pair.key = key;
    pair.value = value;
    status.values.push_back(pair);
  };
  for (Eye& eye : eyes_) {
    const std::string name = std::string(eye.name) + " ";
    if (eye.why_not[0] != '\0' || !eye.painter || eye.received == 0) {
      status.level = diagnostic_msgs::DiagnosticStatus::WARN;
      const std::string why = eye.received == 0 ? "no images" : eye.painter ? eye.why_not : eye.why_no_painter;
      status.message = "RUNNING: " + name + "eye: " + why;
    }
    add(name + "received", std::to_string(eye.received));
    add(name + "drawn", std::to_string(eye.drawn));
    add(name + "out_of_step", std::to_string(eye.alone));
    add(name + "frozen", std::to_string(eye.frozen_images));
    add(name + "refused", std::to_string(eye.refused));
    add(name + "with_unknown_tools", std::to_string(eye.unknown_tools));
    add(name + "age_p50_ms", std::to_string(eye.ages.percentile_ms(0.5)));
    add(name + "age_p99_ms", std::to_string(eye.ages.percentile_ms(0.99)));
    add(name + "age_worst_ms", std::to_string(eye.ages.worst_ms()));
    const double published = static_cast<double>(eye.drawn + eye.alone);
    add(name + "copy_and_draw_mean_us", std::to_string(published > 0 ? 1e6 * eye.draw_s / published : 0.0));
  }
  if (stiffness_) {
    add("stiffness_map", map_ ? "drawn" : map_why_not_);
    if (!map_) {
      status.level = diagnostic_msgs::DiagnosticStatus::WARN;
      status.message += status.message == "RUNNING" ? ": " + map_why_not_ : "; " + map_why_not_;
    }
  }
  array.status.push_back(status);
  diagnostics_.publish(array);
}

}  // namespace saras_ros1

PLUGINLIB_EXPORT_CLASS(saras_ros1::VisualFeedback, nodelet::Nodelet)
