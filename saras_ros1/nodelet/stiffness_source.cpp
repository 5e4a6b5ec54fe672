#include "stiffness_source.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

using Key = std::array<float, 3>;  // the cloud has floats, the mesh doubles of the same numbers

bool is_at(const saras::MapVertex& vertex, const geometry_msgs::Point& point) {
  return static_cast<float>(vertex.at.x()) == static_cast<float>(point.x) &&
         static_cast<float>(vertex.at.y()) == static_cast<float>(point.y) &&
         static_cast<float>(vertex.at.z()) == static_cast<float>(point.z);
}

bool still_fit(const visualization_msgs::Marker& mesh, const std::vector<saras::MapVertex>& vertices,
               const std::vector<saras::MapTriangle>& triangles) {
  if (triangles.empty() || 3 * triangles.size() != mesh.points.size()) {
    return false;
  }
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const auto vertex = static_cast<std::size_t>(triangles[i / 3][i % 3]);
    if (vertex >= vertices.size() || !is_at(vertices[vertex], mesh.points[i])) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<saras::MapVertex> map_vertices(const sensor_msgs::PointCloud2& cloud) {
  const std::array<const char*, 5> names = {"x", "y", "z", "stiffness", "std"};
  std::array<std::size_t, 5> offsets = {};
  for (std::size_t k = 0; k < names.size(); ++k) {
    bool found = false;
    for (const sensor_msgs::PointField& field : cloud.fields) {
      if (field.name == names[k] && field.datatype == sensor_msgs::PointField::FLOAT32 &&
          static_cast<std::size_t>(field.offset) + sizeof(float) <= cloud.point_step) {
        offsets[k] = field.offset;
        found = true;
      }
    }
    if (!found) {
      throw saras::ConfigError(std::string("stiffness map: no float32 field ") + names[k]);
    }
  }
  const std::size_t count = static_cast<std::size_t>(cloud.width) * cloud.height;
  if (cloud.is_bigendian || cloud.data.size() / cloud.point_step < count) {
    throw saras::ConfigError("stiffness map: big-endian, or less data than it says");
  }
  if (count > static_cast<std::size_t>(saras::kMaxMapVertices)) {
    throw saras::ConfigError("stiffness map: " + std::to_string(count) + " vertices: at most " +
                             std::to_string(saras::kMaxMapVertices));
  }
  std::vector<saras::MapVertex> vertices(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 5> values = {};
    for (std::size_t k = 0; k < values.size(); ++k) {
      std::memcpy(&values[k], cloud.data.data() + i * cloud.point_step + offsets[k], sizeof(float));
    }
    vertices[i] = {{values[0], values[1], values[2]}, values[3], values[4]};
  }
  return vertices;
}

std::vector<saras::MapTriangle> map_triangles(const visualization_msgs::Marker& mesh,
                                              const std::vector<saras::MapVertex>& vertices,
                                              std::vector<saras::MapTriangle> known) {
  if (still_fit(mesh, vertices, known)) {
    return known;
  }
  std::map<Key, int> vertex_at;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const saras::Vector3& at = vertices[i].at;
    if (at.allFinite()) {
      vertex_at[{static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())}] =
          static_cast<int>(i);
    }
  }
  std::vector<saras::MapTriangle> triangles(mesh.points.size() / 3);
  for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
    const geometry_msgs::Point& p = mesh.points[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return {};
    }
    const auto found = vertex_at.find({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    if (found == vertex_at.end()) {
      return {};
    }
    triangles[i / 3][i % 3] = found->second;
  }
  return triangles;
}

StiffnessSource::StiffnessSource(ros::NodeHandle& handle, double timeout_s) : timeout_s_(timeout_s) {
  clouds_ = handle.subscribe("/csa/modeler/stiffness", 1, &StiffnessSource::on_cloud, this);
  meshes_ = handle.subscribe("/csa/modeler/mesh", 1, &StiffnessSource::on_mesh, this);
}

void StiffnessSource::on_cloud(const sensor_msgs::PointCloud2::ConstPtr& cloud) {
  heard_.change([&](Heard& heard) { heard.cloud = cloud; });
  join();
}

void StiffnessSource::on_mesh(const visualization_msgs::Marker::ConstPtr& mesh) {
  if (mesh->type == visualization_msgs::Marker::TRIANGLE_LIST && mesh->action == visualization_msgs::Marker::ADD) {
    heard_.change([&](Heard& heard) { heard.mesh = mesh; });
    join();
  }
}

// Cloud and mesh of one moment come as two messages, in any order; the map changes when both are there. The work is
// done outside of the lock: a picture does not wait for it.
void StiffnessSource::join() {
  const std::lock_guard<std::mutex> one(joining_);
  const Heard heard = heard_.read();
  const bool joined = heard.map && heard.cloud && heard.map->stamp == heard.cloud->header.stamp;
  if (!heard.cloud || !heard.mesh || heard.cloud->header.stamp != heard.mesh->header.stamp || joined) {
    return;
  }
  auto map = std::make_shared<StiffnessMap>();
  std::string refused;
  try {
    map->vertices = map_vertices(*heard.cloud);
    map->triangles =
        map_triangles(*heard.mesh, map->vertices, heard.map ? heard.map->triangles : std::vector<saras::MapTriangle>());
    map->frame = heard.cloud->header.frame_id;
    map->stamp = heard.cloud->header.stamp;
    if (map->triangles.empty() || heard.mesh->header.frame_id != map->frame) {
      refused = "stiffness map: the mesh is not of its vertices";
    }
  } catch (const saras::ConfigError& error) {
    refused = error.what();
  }
  heard_.change([&](Heard& kept) {
    kept.refused = refused;
    kept.map = refused.empty() ? map : nullptr;
    kept.at = ros::SteadyTime::now();
  });
}

std::shared_ptr<const StiffnessMap> StiffnessSource::map(std::string& why) const {
  const Heard heard = heard_.read();
  if (!heard.map) {
    why = heard.refused;
    return nullptr;
  }
  // As old as it is, or as it was made, whichever is more: a late or a replayed map is not what is known now.
  const double made_s = heard.map->stamp.isZero() ? 0.0 : (ros::Time::now() - heard.map->stamp).toSec();
  const double age_s = std::max((ros::SteadyTime::now() - heard.at).toSec(), std::abs(made_s));
  if (age_s > timeout_s_) {
    why = "stiffness map: too old, or of another clock";
    return nullptr;
  }
  why.clear();
  return heard.map;
}

}  // namespace saras_ros1
