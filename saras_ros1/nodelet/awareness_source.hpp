// What the inset of situational awareness shows: the newest of /csa/*, or that nothing is known.
#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PolygonStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>

#include <array>
#include <memory>
#include <vector>

#include "saras/overlay/awareness_inset.hpp"
#include "saras/runtime/snapshot.hpp"
#include "saras_ros1/Contact.h"
#include "saras_ros1/CsaAdmittance.h"
#include "saras_ros1/CsaTeleopState.h"

namespace saras_ros1 {

/// Subscribes in the handle's queue; fill() may be called from any thread.
class AwarenessSource {
 public:
  explicit AwarenessSource(ros::NodeHandle& handle);
  /// False: nobody has ever said anything, and no inset is wanted.
  bool fill(saras::AwarenessView& view);
  using Map = std::shared_ptr<const std::vector<saras::InsetDot>>;
  /// Of the newest stiffness map, for view.dots; null: none, or an old one. Keep it as long as the view is drawn.
  Map map() const;

 private:
  template <typename Message>
  struct Newest {
    typename Message::ConstPtr message;
    ros::SteadyTime at;
    /// Null when it is older than it may be.
    const Message* fresh(double within_s) const {
      return message && (ros::SteadyTime::now() - at).toSec() <= within_s ? message.get() : nullptr;
    }
  };
  struct Heard {
    Newest<CsaTeleopState> told;
    Newest<CsaAdmittance> did;
    Newest<geometry_msgs::PoseStamped> tip, proxy;
    Newest<geometry_msgs::PointStamped> closest;
    Newest<Contact> contact;
    Newest<geometry_msgs::WrenchStamped> force;
    Newest<geometry_msgs::PolygonStamped> picked, region;
    Map map;
    ros::SteadyTime map_at;
    bool has_center = false;
    saras::Vector3 center = saras::Vector3::Zero();
  };
  void on_map(const sensor_msgs::PointCloud2::ConstPtr& message);
  template <typename Message>
  void listen(ros::NodeHandle& handle, const std::string& topic, Newest<Message> Heard::*place);

  saras::Snapshot<Heard> heard_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace saras_ros1
