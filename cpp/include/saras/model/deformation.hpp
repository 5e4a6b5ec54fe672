// How a mesh is bent, from points measured on it: displacements on a sparse grid around it.
//
// The mesh is enclosed in cubes; only those that hold a vertex have corners in the grid. A vertex moves by the
// trilinear mean of its cube's corners, so that a few hundred unknowns move ten thousand vertices. Points are matched
// to the bent mesh as in registration.hpp; neighbouring corners tend to move alike, all corners tend to stay. The most
// probable displacements are a sparse linear least-squares problem, solved anew after each matching.
#pragma once

#include <array>
#include <vector>

#include "saras/model/registration.hpp"

namespace saras {

struct DeformationOptions {
  double spacing_m = 0.02;    ///< edge of a cube [m]
  double strain = 0.1;        ///< standard deviation of the difference of neighbouring corners, per spacing
  double travel_m = 0.05;     ///< standard deviation of a corner's displacement [m]
  double gate = 7.81;         ///< squared deviation above which a point is left out
  int max_rounds = 20;        ///< of matching and solving
  double tolerance_m = 2e-5;  ///< settled: no vertex moves more than this, or the points are as near as before
  void validate() const;      ///< throws ConfigError
};

/// The grid around one mesh. Built once; displacements are values of their own.
class DeformationGrid {
 public:
  /// Throws ModelError when the spacing makes more than 200000 corners.
  DeformationGrid(const SurfaceMesh& mesh, double spacing_m);

  struct Place {
    std::array<std::int32_t, 8> corners;
    std::array<double, 8> weights;
  };
  std::size_t corners() const { return positions_.size(); }
  const std::vector<Vector3>& positions() const { return positions_; }
  /// Pairs of corners one spacing apart.
  const std::vector<std::array<std::int32_t, 2>>& neighbours() const { return neighbours_; }
  /// Of each corner: itself and those with a greater number that a point of the mesh may depend on together with it.
  const std::vector<std::vector<std::int32_t>>& coupled() const { return coupled_; }
  /// Of the mesh's vertices.
  const std::vector<Place>& vertices() const { return vertices_; }
  /// Of a point of a triangle, by the places of its vertices.
  std::vector<std::pair<std::int32_t, double>> weights(const std::array<std::int32_t, 3>& triangle,
                                                       const Vector3& barycentric) const;
  /// Vertices of the mesh moved by the corners' displacements.
  void apply(const SurfaceMesh& mesh, const std::vector<Vector3>& displacements, std::vector<Vector3>& moved) const;

 private:
  std::vector<Vector3> positions_;
  std::vector<std::array<std::int32_t, 2>> neighbours_;
  std::vector<Place> vertices_;
  std::vector<std::vector<std::int32_t>> coupled_;

  void couple(const SurfaceMesh& mesh);
};

struct Deformation {
  std::vector<Vector3> displacements;  ///< of the grid's corners, mesh frame [m]
  std::vector<Vector3> vertices;       ///< of the bent mesh, mesh frame [m]
  std::vector<bool> used;              ///< points; false: left out
  double rms_m = 0.0;                  ///< distance of the used points from the bent mesh
  int rounds = 0;
  bool converged = false;
};

/// tree: of the mesh. points: base frame. start: displacements to begin with (those of the last call), or empty. Throws
/// ModelError as register_rigid, and for a start of another size.
Deformation deform(const SurfaceMesh& mesh, const MeshTree& tree, const DeformationGrid& grid,
                   const std::vector<SurfacePoint>& points, const Pose& base_T_mesh,
                   const DeformationOptions& options = {}, const std::vector<Vector3>& start = {});

}  // namespace saras
