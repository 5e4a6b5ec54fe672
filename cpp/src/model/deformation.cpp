#include "saras/model/deformation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "deformation_equations.hpp"
#include "saras/model/model_error.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

/// A share of a match's whole weight, so that it does not slide along the surface without bound. It shrinks from round
/// to round: then the smoothness alone says how the surface slid, and the way there is short.
constexpr double kSticking = 0.05;
constexpr double kStickingShrinks = 0.6;
constexpr double kLeastSticking = 1e-3;
/// Share by which the mean squared deviation may still change.
constexpr double kSettled = 5e-3;
/// Rounds in which the gate is open: the mesh is not bent yet.
constexpr int kOpenRounds = 2;

/// What a match says of its point: all of it across the surface, little along it.
Eigen::Matrix3d information_of(const Eigen::Matrix3d& covariance, const Vector3& normal, double sticking) {
  const double across = normal.dot(covariance * normal);
  return sticking * covariance.inverse() + (1.0 - sticking) / across * normal * normal.transpose();
}

class Bending {
 public:
  Bending(const SurfaceMesh& mesh, const MeshTree& tree, const DeformationGrid& grid,
          const std::vector<SurfacePoint>& points, const Pose& base_T_mesh, const DeformationOptions& options,
          std::vector<Vector3> start)
      : mesh_(mesh),
        grid_(grid),
        options_(options),
        bent_(mesh),
        tree_(tree, bent_),
        equations_(grid, options.strain * options.spacing_m, options.travel_m),
        matches_(points.size()) {
    const Pose mesh_T_base = base_T_mesh.inverse();
    const Eigen::Matrix3d rotation = mesh_T_base.rotation.toRotationMatrix();
    for (const SurfacePoint& point : points) {
      points_.push_back({mesh_T_base * point.position, rotation * point.covariance * rotation.transpose()});
    }
    result_.displacements = std::move(start);
    result_.used.assign(points.size(), true);
    warm_ = !result_.displacements.empty();
    result_.displacements.resize(grid.corners(), Vector3::Zero());
    move();
  }

  Deformation settle() {
    while (result_.rounds < options_.max_rounds && !result_.converged) {
      const double before = deviation_;
      match();
      solve();
      const double moved_m = move();
      ++result_.rounds;
      // Matches may change triangles for ever: it is the surface that must settle, not each vertex on it.
      const bool as_near = std::abs(deviation_ - before) <= kSettled * before;
      result_.converged = (warm_ || result_.rounds > kOpenRounds) && (as_near || moved_m < options_.tolerance_m);
    }
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const MeshMatch match = tree_.closest(points_[i].position, matches_[i].triangle);
      sum += result_.used[i] ? match.squared : 0.0;
      count += result_.used[i] ? 1.0 : 0.0;
    }
    result_.rms_m = count > 0.0 ? std::sqrt(sum / count) : 0.0;
    result_.vertices = bent_.vertices;
    return std::move(result_);
  }

 private:
  void match() {
    const bool open = !warm_ && result_.rounds < kOpenRounds;
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      matches_[i] = tree_.likely(points_[i].position, points_[i].covariance.inverse(), matches_[i].triangle);
      result_.used[i] = open || matches_[i].squared <= options_.gate;
      sum += result_.used[i] ? matches_[i].squared : 0.0;
      count += result_.used[i] ? 1.0 : 0.0;
    }
    deviation_ = sum / std::max(1.0, count);
  }

  void solve() {
    equations_.restart();
    const double sticking =
        warm_ ? kLeastSticking : std::max(kLeastSticking, kSticking * std::pow(kStickingShrinks, result_.rounds));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!result_.used[i]) {
        continue;
      }
      const auto& triangle = mesh_.triangles[static_cast<std::size_t>(matches_[i].triangle)];
      Vector3 unbent = Vector3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        unbent += matches_[i].barycentric[static_cast<Eigen::Index>(k)] *
                  mesh_.vertices[static_cast<std::size_t>(triangle[k])];
      }
      equations_.add(grid_.weights(triangle, matches_[i].barycentric),
                     information_of(points_[i].covariance, tree_.normal(matches_[i].triangle), sticking),
                     points_[i].position - unbent);
    }
    if (!equations_.solve(result_.displacements)) {
      throw ModelError("points: their covariances and travel_m, strain are too far apart to be weighed together");
    }
  }

  /// Takes the displacements over; returns how far the farthest vertex moves.
  double move() {
    std::vector<Vector3> moved;
    grid_.apply(mesh_, result_.displacements, moved);
    double farthest = 0.0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      farthest = std::max(farthest, (moved[i] - bent_.vertices[i]).norm());
    }
    bent_.vertices = std::move(moved);
    tree_.refit();
    return farthest;
  }

  const SurfaceMesh& mesh_;
  const DeformationGrid& grid_;
  const DeformationOptions& options_;
  SurfaceMesh bent_;
  MeshTree tree_;
  DeformationEquations equations_;
  std::vector<SurfacePoint> points_;  ///< in the mesh's frame
  std::vector<MeshMatch> matches_;
  bool warm_ = false;
  double deviation_ = 0.0;  ///< mean squared deviation of the used points from the mesh, before the last step
  Deformation result_;
};

}  // namespace

void DeformationOptions::validate() const {
  validate::positive("spacing_m", spacing_m);
  validate::positive("strain", strain);
  validate::positive("travel_m", travel_m);
  validate::positive("gate", gate);
  validate::in_range("max_rounds", max_rounds, 1, 10'000);
  validate::positive("tolerance_m", tolerance_m);
}

Deformation deform(const SurfaceMesh& mesh, const MeshTree& tree, const DeformationGrid& grid,
                   const std::vector<SurfacePoint>& points, const Pose& base_T_mesh, const DeformationOptions& options,
                   const std::vector<Vector3>& start) {
  options.validate();
  check_surface_points(mesh, points, base_T_mesh);
  if (!start.empty() && start.size() != grid.corners()) {
    throw ModelError("start: " + std::to_string(start.size()) + " displacements: must be " +
                     std::to_string(grid.corners()) + ", one a corner");
  }
  return Bending(mesh, tree, grid, points, base_T_mesh, options, start).settle();
}

}  // namespace saras
