// Closest point on a triangle mesh, signed, in microseconds for millions of triangles.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "saras/spatial/types.hpp"

namespace saras::csa {

struct MeshPoint {
  double distance_m = std::numeric_limits<double>::quiet_NaN();  ///< signed: negative behind the surface
  Vector3 point = Vector3::Zero();                               ///< closest point on the surface
  Vector3 normal = Vector3::Zero();  ///< unit: outward; from the surface to the query where that is well defined
  int triangle = -1;                 ///< index as given; -1: none within reach
};

/// A tree of axis-aligned boxes over triangles, built once. Queries allocate nothing and are thread-safe.
class TriangleMesh {
 public:
  using Vertices = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  using Triangles = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;
  /// vertices (v, 3) [m]; triangles (t, 3), counter-clockwise seen from outside. Throws ConfigError naming the first
  /// vertex that is not finite, the first triangle whose index is out of range or whose area is zero.
  TriangleMesh(const Vertices& vertices, const Triangles& triangles);

  /// The closest point no further than within_m. The sign is that of the angle-weighted pseudo-normal of the closest
  /// feature (Baerentzen and Aanaes 2005): right everywhere on a closed mesh, on the border of an open one by the
  /// nearest face. hint: a triangle that may be near, e.g. that of the last query; any answer is the same with it.
  MeshPoint closest(const Vector3& point, double within_m = std::numeric_limits<double>::infinity(),
                    int hint = -1) const noexcept;
  /// Closest points of up to capacity triangles no further than within_m, nearest first, of which no two have normals
  /// within acos(0.98). Returns how many.
  int nearby(const Vector3& point, double within_m, MeshPoint* out, int capacity) const noexcept;

  int triangles() const { return static_cast<int>(faces_.size()); }
  int vertices() const { return static_cast<int>(vertices_.rows()); }
  /// As given.
  const Vertices& given_vertices() const { return vertices_; }
  Triangles given_triangles() const;

 private:
  enum class Feature : std::uint8_t { kFace, kEdge01, kEdge12, kEdge20, kVertex0, kVertex1, kVertex2 };
  struct Face {
    std::array<std::int32_t, 3> vertex;
    std::int32_t index;  ///< as given
  };
  struct Node {
    Eigen::Vector3f low, high;
    std::int32_t first;  ///< leaf: of its faces; else: the second child
    std::int32_t count;  ///< leaf: number of faces; else 0
  };
  struct Candidate {
    Vector3 point;
    double squared;
    Feature feature;
  };
  std::int32_t build(std::vector<Vector3>& centres, std::vector<std::int32_t>& order, std::int32_t begin,
                     std::int32_t end);
  void make_normals();
  Candidate closest_on(std::int32_t face, const Vector3& point) const noexcept;
  Vector3 pseudo_normal(std::int32_t face, Feature feature) const noexcept;
  MeshPoint finish(std::int32_t face, const Candidate& candidate, const Vector3& point) const noexcept;
  template <typename Visit>
  void visit(const Vector3& point, double& squared_bound, Visit visit_face) const noexcept;

  Vertices vertices_;
  std::vector<Face> faces_;          ///< in the order of the leaves
  std::vector<std::int32_t> place_;  ///< index as given -> place in faces_
  std::vector<Node> nodes_;
  std::vector<Eigen::Vector3f> vertex_normals_;
  std::vector<std::array<Eigen::Vector3f, 3>> edge_normals_;  ///< of each face: edges 01, 12, 20
};

}  // namespace saras::csa
