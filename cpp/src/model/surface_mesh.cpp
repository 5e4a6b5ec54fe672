#include "saras/model/surface_mesh.hpp"

#include <algorithm>
#include <string>
#include <unordered_map>

#include "saras/model/model_error.hpp"

namespace saras {
namespace {

/// Directed edges packed into one number, with how often each stands in a triangle.
std::unordered_map<std::uint64_t, int> directed_edges(const SurfaceMesh& mesh) {
  std::unordered_map<std::uint64_t, int> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto from = static_cast<std::uint64_t>(triangle[i]);
      const auto to = static_cast<std::uint64_t>(triangle[(i + 1) % 3]);
      ++edges[from << 32U | to];
    }
  }
  return edges;
}

std::string number(std::size_t i) { return std::to_string(i); }

}  // namespace

void SurfaceMesh::validate() const {
  if (vertices.empty() || triangles.empty()) {
    throw ModelError("mesh: " + number(vertices.size()) + " vertices, " + number(triangles.size()) +
                     " triangles: must not be empty");
  }
  Vector3 low = vertices.front();
  Vector3 high = low;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].allFinite()) {
      throw ModelError("mesh: vertex " + number(i) + ": must be finite");
    }
    low = low.cwiseMin(vertices[i]);
    high = high.cwiseMax(vertices[i]);
  }
  const double extent_m = (high - low).norm();
  if (!(extent_m >= 1e-3 && extent_m <= 5.0)) {
    throw ModelError("mesh: extent = " + std::to_string(extent_m) +
                     " m: must be in [0.001, 5] (millimetres for metres?)");
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::int32_t vertex : triangles[i]) {
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertices.size()) {
        throw ModelError("mesh: triangle " + number(i) + ": vertex " + std::to_string(vertex) + ": must be in 0.." +
                         number(vertices.size() - 1));
      }
    }
    const Vector3& a = vertices[static_cast<std::size_t>(triangles[i][0])];
    const Vector3 ab = vertices[static_cast<std::size_t>(triangles[i][1])] - a;
    const Vector3 ac = vertices[static_cast<std::size_t>(triangles[i][2])] - a;
    if (!(ab.cross(ac).norm() > 1e-12 * (ab.squaredNorm() + ac.squaredNorm()))) {
      throw ModelError("mesh: triangle " + number(i) + ": must have an area");
    }
  }
  for (const auto& [edge, count] : directed_edges(*this)) {
    if (count > 1) {
      throw ModelError("mesh: edge " + std::to_string(edge >> 32U) + "-" + std::to_string(edge & 0xFFFFFFFFU) +
                       ": must belong to two triangles that turn the same way (non-manifold)");
    }
  }
}

bool SurfaceMesh::closed() const {
  const auto edges = directed_edges(*this);
  return std::all_of(edges.begin(), edges.end(),
                     [&](const auto& edge) { return edges.count(edge.first << 32U | edge.first >> 32U) > 0; });
}

std::vector<Vector3> SurfaceMesh::vertex_normals() const {
  std::vector<Vector3> normals(vertices.size(), Vector3::Zero());
  for (const auto& triangle : triangles) {
    const Vector3& a = vertices[static_cast<std::size_t>(triangle[0])];
    const Vector3 area = (vertices[static_cast<std::size_t>(triangle[1])] - a)
                             .cross(vertices[static_cast<std::size_t>(triangle[2])] - a);
    for (const std::int32_t vertex : triangle) {
      normals[static_cast<std::size_t>(vertex)] += area;
    }
  }
  for (Vector3& normal : normals) {
    normal.stableNormalize();
  }
  return normals;
}

}  // namespace saras
