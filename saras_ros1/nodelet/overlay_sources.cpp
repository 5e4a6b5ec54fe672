#include "overlay_sources.hpp"

#include <cmath>

namespace saras_ros1 {
namespace {

constexpr const char* kWorld = "world";
constexpr std::size_t kStates = 40;         // the last 0.8 s at 50 Hz
constexpr double kClockTolerance_s = 0.02;  // a stamp may be so far in the future: clocks of two hosts
constexpr double kUnitTolerance = 1e-3;

/// The older of: since it came, since it was made. Negative (unknown) for a stamp from the future.
double age(const ros::SteadyTime& received, const ros::Time& stamp) {
  if (received.isZero()) {
    return std::numeric_limits<double>::infinity();
  }
  const double since_received = (ros::SteadyTime::now() - received).toSec();
  if (stamp.isZero()) {
    return since_received;
  }
  const double since_made = (ros::Time::now() - stamp).toSec();
  return since_made < -kClockTolerance_s ? since_made : std::max(since_received, since_made);
}

saras::Pose pose_of(const geometry_msgs::Transform& transform) {
  saras::Pose pose;
  pose.translation = {transform.translation.x, transform.translation.y, transform.translation.z};
  pose.rotation = {transform.rotation.w, transform.rotation.x, transform.rotation.y, transform.rotation.z};
  // tf2 takes what is nearly of unit length; what is not, or not finite, stays so and is refused by the law.
  if (std::abs(pose.rotation.norm() - 1.0) <= kUnitTolerance) {
    pose.rotation.normalize();
  }
  return pose;
}

}  // namespace

OverlaySources::OverlaySources(ros::NodeHandle& handle, OverlaySourcesConfig config) : config_(std::move(config)) {
  listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_, handle, true, ros::TransportHints().tcpNoDelay());
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  state_ = handle.subscribe("/collision/state", 5, &OverlaySources::on_state, this, hints);
  distances_ = handle.subscribe("/collision/distances", 1, &OverlaySources::on_distances, this, hints);
}

void OverlaySources::on_state(const CollisionState::ConstPtr& message) {
  // Positions are in the world; in another frame they would be drawn where nothing is.
  const bool in_world = message->header.frame_id == kWorld || message->header.frame_id == std::string("/") + kWorld;
  heard_.change([&](Heard& heard) {
    heard.states.push_back(message);
    heard.state_at = in_world ? ros::SteadyTime::now() : ros::SteadyTime();
    while (heard.states.size() > kStates) {
      heard.states.pop_front();
    }
  });
}

void OverlaySources::on_distances(const std_msgs::Float64MultiArray::ConstPtr& message) {
  std::map<std::string, double> distances = distances_by_tool(*message);
  heard_.change([&](Heard& heard) {
    heard.distances = std::move(distances);
    heard.distances_at = ros::SteadyTime::now();
  });
}

void OverlaySources::fill(const std_msgs::Header& left_image, const Eigen::Matrix3d& rectified_R_raw,
                          saras::ToolOverlayInput& input) {
  const Heard heard = heard_.read();
  const CollisionState* newest = heard.states.empty() ? nullptr : heard.states.back().get();
  const CollisionState* places = nullptr;
  double nearest_s = config_.places_within_s;
  for (const CollisionState::ConstPtr& state : heard.states) {
    const double apart_s = std::abs((state->header.stamp - left_image.stamp).toSec());
    if (apart_s <= nearest_s) {
      nearest_s = apart_s;
      places = state.get();
    }
  }
  fill_tools(config_.tools, newest, places, heard.distances, input);
  input.tools_age_s = age(heard.state_at, newest == nullptr ? ros::Time() : newest->header.stamp);
  input.distances_age_s = age(heard.distances_at, ros::Time());
  input.camera_age_s = look_up(kWorld, left_image, rectified_R_raw, input.camera_T_world);
}

bool OverlaySources::left_T(const std::string& frame, const std_msgs::Header& left_image,
                            const Eigen::Matrix3d& rectified_R_raw, double within_s, saras::Pose& pose) const {
  return look_up(frame, left_image, rectified_R_raw, pose) <= within_s;
}

double OverlaySources::look_up(const std::string& of, const std_msgs::Header& image,
                               const Eigen::Matrix3d& rectified_R_raw, saras::Pose& pose) const {
  const std::string& frame = config_.optical_frame.empty() ? image.frame_id : config_.optical_frame;
  constexpr double kUnknown_s = std::numeric_limits<double>::infinity();
  double apart_s = 0.0;  // known for the time of the image
  geometry_msgs::TransformStamped found;
  try {
    found = buffer_.lookupTransform(frame, of, image.stamp);
  } catch (const tf2::ExtrapolationException&) {
    try {
      found = buffer_.lookupTransform(frame, of, ros::Time(0));
      apart_s = std::abs((image.stamp - found.header.stamp).toSec());
    } catch (const tf2::TransformException&) {
      return kUnknown_s;
    }
  } catch (const tf2::TransformException&) {
    return kUnknown_s;
  }
  pose = pose_of(found.transform);
  if (config_.frame_is_raw) {
    const saras::Pose rectified_T_raw{saras::Quaternion(rectified_R_raw).normalized(), saras::Vector3::Zero()};
    pose = rectified_T_raw * pose;
  }
  return apart_s;
}

}  // namespace saras_ros1
