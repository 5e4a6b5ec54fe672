// What the overlay shows and where it is: /collision/*, and the camera's pose through tf.
#pragma once

#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <tf2_ros/transform_listener.h>

#include <deque>
#include <memory>

#include "overlay_messages.hpp"
#include "saras/runtime/snapshot.hpp"

namespace saras_ros1 {

struct OverlaySourcesConfig {
  std::vector<std::string> tools;  ///< in the order of the list
  std::string optical_frame;       ///< of the left eye; empty: as its images say
  bool frame_is_raw = true;        ///< that frame is the raw camera's, as hand-eye calibration gives it
  double places_within_s = 0.15;   ///< positions are taken from a state that is no further from the image's time
};

/// Subscribes in a queue of its own threads; fill() may be called from any thread.
class OverlaySources {
 public:
  OverlaySources(ros::NodeHandle& handle, OverlaySourcesConfig config);
  /// Tools, ages and the camera's pose for an image. rectified_R_raw: of the left eye.
  void fill(const std_msgs::Header& left_image, const Eigen::Matrix3d& rectified_R_raw, saras::ToolOverlayInput& input);
  /// The pose of another frame in the rectified left optical frame at the image's time; false: tf does not know it, or
  /// only for a time further away than within_s.
  bool left_T(const std::string& frame, const std_msgs::Header& left_image, const Eigen::Matrix3d& rectified_R_raw,
              double within_s, saras::Pose& pose) const;

 private:
  struct Heard {
    std::deque<CollisionState::ConstPtr> states;  // newest last
    ros::SteadyTime state_at;
    std::map<std::string, double> distances;
    ros::SteadyTime distances_at;
  };

  void on_state(const CollisionState::ConstPtr& message);
  void on_distances(const std_msgs::Float64MultiArray::ConstPtr& message);
  /// How far from the image's time the pose is [s]; infinite: not known, and pose as it was.
  double look_up(const std::string& frame, const std_msgs::Header& image, const Eigen::Matrix3d& rectified_R_raw,
                 saras::Pose& pose) const;

  OverlaySourcesConfig config_;
  saras::Snapshot<Heard> heard_;
  tf2_ros::Buffer buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  ros::Subscriber state_, distances_;
};

}  // namespace saras_ros1
