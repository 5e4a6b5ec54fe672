// A triangle mesh that a model may be made from, and the point on it that a measurement most likely came from.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "saras/spatial/types.hpp"

namespace saras {

/// Vertices and triangles that hang together: checked once, then trusted.
struct SurfaceMesh {
  std::vector<Vector3> vertices;                       ///< [m]
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise from outside

  /// Throws ModelError: empty, not finite, an index out of range, a triangle without area, an edge of more than two
  /// triangles or of two that turn against each other, an extent that is no organ in metres (1 mm .. 5 m).
  void validate() const;
  /// Every edge has two triangles.
  bool closed() const;
  /// Area-weighted unit normals, one a vertex; zero for a vertex without triangle.
  std::vector<Vector3> vertex_normals() const;
};

/// Where on a mesh.
struct MeshMatch {
  double squared = std::numeric_limits<double>::infinity();  ///< in the metric that was asked for
  Vector3 point = Vector3::Zero();
  Vector3 barycentric = Vector3::Zero();  ///< weights of the triangle's vertices
  std::int32_t triangle = -1;
};

/// A tree of axis-aligned boxes over the triangles. Queries allocate nothing and may run in parallel.
class MeshTree {
 public:
  /// The mesh must live as long as the tree, and be valid.
  explicit MeshTree(const SurfaceMesh& mesh);
  /// The same tree over another mesh with the same triangles; for other vertices refit() it.
  MeshTree(const MeshTree& tree, const SurfaceMesh& mesh) : mesh_(mesh), nodes_(tree.nodes_), order_(tree.order_) {}
  /// After the mesh's vertices have moved: boxes anew, the tree as it is. O(triangles).
  void refit();
  /// Least (y - x)^T information (y - x) over the surface: for the inverse covariance of a measurement the point that
  /// it most likely came from (Billings, Boctor and Taylor 2015); for the identity the closest point. hint: a triangle
  /// that may be near; the answer is the same with it.
  MeshMatch likely(const Vector3& point, const Eigen::Matrix3d& information, std::int32_t hint = -1) const noexcept;
  MeshMatch closest(const Vector3& point, std::int32_t hint = -1) const noexcept {
    return likely(point, Eigen::Matrix3d::Identity(), hint);
  }
  /// Outward unit normal of a triangle.
  Vector3 normal(std::int32_t triangle) const;

 private:
  struct Node {
    Vector3 low;
    Vector3 high;
    std::int32_t first;  ///< leaf: of its triangles in order_; else the second child (the first comes right behind)
    std::int32_t count;  ///< leaf: triangles; else 0
  };
  std::int32_t build(std::int32_t begin, std::int32_t end, const std::vector<Vector3>& centres);
  void bound(Node& node) const;

  const SurfaceMesh& mesh_;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
};

/// A valid mesh with what is derived from it. Nobody changes it: threads may share it.
struct IndexedMesh {
  explicit IndexedMesh(SurfaceMesh given);  ///< throws ModelError
  IndexedMesh(const IndexedMesh&) = delete;
  IndexedMesh& operator=(const IndexedMesh&) = delete;
  const SurfaceMesh mesh;
  const MeshTree tree;
  const std::vector<Vector3> normals;  ///< of the vertices
};
using IndexedMeshPointer = std::shared_ptr<const IndexedMesh>;

}  // namespace saras
