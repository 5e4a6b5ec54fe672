// Draws tools, distances and what is not known into both eyes of the endoscope. In a nodelet manager images come and
// go without a copy but the one that is drawn on.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <image_transport/image_transport.h>
#include <nodelet/nodelet.h>

#include <array>
#include <memory>
#include <optional>

#include "age_statistics.hpp"
#include "awareness_source.hpp"
#include "overlay_sources.hpp"
#include "saras/overlay/image_watch.hpp"
#include "stiffness_source.hpp"

namespace saras_ros1 {

class VisualFeedback : public nodelet::Nodelet {
 private:
  struct Eye {
    const char* name = "";
    image_transport::Subscriber images;
    ros::Subscriber infos;
    image_transport::Publisher out;
    std::optional<saras::OverlayPainter> painter;        // empty: no usable camera_info
    std::optional<saras::AwarenessInset> inset;          // empty: not wanted, or no usable camera_info
    std::unique_ptr<saras::StiffnessOverlay> stiffness;  // null: as above
    Eigen::Matrix3d rectified_R_raw = Eigen::Matrix3d::Identity();
    sensor_msgs::CameraInfo info;
    std::string why_no_painter = "no camera_info yet";
    std::optional<saras::FrozenWatch> frozen_watch;
    bool frozen = false;
    sensor_msgs::ImageConstPtr waiting;  // for the other eye
    sensor_msgs::ImageConstPtr last;
    ros::SteadyTime last_at;
    ros::SteadyTime told_at;  // that nothing comes
    // Since the last report, and since the start.
    std::uint64_t received = 0, drawn = 0, alone = 0, frozen_images = 0, refused = 0, unknown_tools = 0;
    AgeStatistics ages;
    double draw_s = 0.0;
    const char* why_not = "";
  };

  void onInit() override;
  void start();
  void read_parameters();
  void on_info(std::size_t eye, const sensor_msgs::CameraInfoConstPtr& info);
  void on_image(std::size_t eye, const sensor_msgs::ImageConstPtr& image);
  void on_timer(const ros::SteadyTimerEvent&);
  void report(const ros::SteadyTimerEvent&);
  void release_alone(std::size_t eye, const sensor_msgs::ImageConstPtr& image);
  void release_pair(const std::array<sensor_msgs::ImageConstPtr, 2>& images);
  void publish(std::size_t eye, const sensor_msgs::ImageConstPtr& image, saras::OverlayNotice notice,
               const saras::ToolOverlayOutput* tools);
  void look_at_map(const std_msgs::Header& left_image);
  void draw_map(Eye& eye, const saras::ImageView& image);
  void draw_inset(const Eye& eye, const saras::ImageView& image);
  void follow_pairing(const saras::StereoPairingOutput& output);
  double since_last_step();

  std::array<Eye, 2> eyes_;
  std::unique_ptr<OverlaySources> sources_;
  std::unique_ptr<AwarenessSource> awareness_;  // null: no inset is wanted
  std::unique_ptr<StiffnessSource> stiffness_;  // null: no stiffness map is wanted
  saras::StiffnessOverlayStyle stiffness_style_;
  double map_timeout_s_ = 0.0, map_pose_within_s_ = 0.0;
  bool map_wanted_ = false;
  std::shared_ptr<const StiffnessMap> map_;  // of the pair that is drawn; null: not known, map_why_not_ says why
  saras::Pose left_T_map_;
  std::string map_why_not_ = "no map yet";
  saras::AwarenessInsetStyle inset_style_;
  bool inset_wanted_ = false;
  std::optional<saras::ToolOverlay> law_;
  std::optional<saras::StereoPairing> pairing_;
  saras::OverlayStyle style_;
  saras::NoticePainter notices_;
  OverlaySourcesConfig sources_config_;
  std::string camera_, image_topic_, info_topic_;
  bool rectified_ = false;
  double near_m_ = 0.0, silent_after_s_ = 0.0;
  ros::SteadyTime stepped_at_;  // pairing
  ros::SteadyTime drawn_at_;    // law
  ros::SteadyTimer timer_, reporter_;
  ros::Publisher diagnostics_;
};

}  // namespace saras_ros1
