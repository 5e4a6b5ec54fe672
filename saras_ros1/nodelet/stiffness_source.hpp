// The stiffness map for the overlay: the newest /csa/modeler/stiffness with the triangles of /csa/modeler/mesh.
#pragma once

#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "saras/overlay/stiffness_overlay.hpp"
#include "saras/runtime/snapshot.hpp"

namespace saras_ros1 {

/// One map, in its own frame.
struct StiffnessMap {
  std::vector<saras::MapVertex> vertices;
  std::vector<saras::MapTriangle> triangles;
  std::string frame;
  ros::Time stamp;
};

/// Vertices of a cloud with float32 fields x, y, z [m], stiffness, std [N/m]. Throws ConfigError naming what is wrong.
std::vector<saras::MapVertex> map_vertices(const sensor_msgs::PointCloud2& cloud);

/// The vertex at each corner of a TRIANGLE_LIST. known: triangles of the map before, taken when they still fit. Empty:
/// a corner is at no vertex.
std::vector<saras::MapTriangle> map_triangles(const visualization_msgs::Marker& mesh,
                                              const std::vector<saras::MapVertex>& vertices,
                                              std::vector<saras::MapTriangle> known);

/// Subscribes in the handle's queue; map() may be called from any thread.
class StiffnessSource {
 public:
  StiffnessSource(ros::NodeHandle& handle, double timeout_s);
  /// Null: no map, or only one older than timeout_s; why: what to tell.
  std::shared_ptr<const StiffnessMap> map(std::string& why) const;

 private:
  void on_cloud(const sensor_msgs::PointCloud2::ConstPtr& cloud);
  void on_mesh(const visualization_msgs::Marker::ConstPtr& mesh);

  struct Heard {
    sensor_msgs::PointCloud2::ConstPtr cloud;
    visualization_msgs::Marker::ConstPtr mesh;
    std::shared_ptr<const StiffnessMap> map;
    ros::SteadyTime at;
    std::string refused = "no map yet";
  };
  void join();

  double timeout_s_;
  std::mutex joining_;
  saras::Snapshot<Heard> heard_;
  ros::Subscriber clouds_, meshes_;
};

}  // namespace saras_ros1
