#include "saras/model/deformation.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>

#include "saras/model/model_error.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

/// whitening (target - sum of weights * displacements): linear, with as many blocks as the point has corners.
class PointCost : public ceres::CostFunction {
 public:
  PointCost(const Eigen::Matrix3d& whitening, const Vector3& target,
            std::vector<std::pair<std::int32_t, double>> weights)
      : whitening_(whitening), target_(target), weights_(std::move(weights)) {
    set_num_residuals(3);
    mutable_parameter_block_sizes()->assign(weights_.size(), 3);
  }

  bool Evaluate(double const* const* displacements, double* residuals, double** jacobians) const override {
    Vector3 left = target_;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      left -= weights_[i].second * Eigen::Map<const Vector3>(displacements[i]);
      if (jacobians != nullptr && jacobians[i] != nullptr) {
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[i]} = -weights_[i].second * whitening_;
      }
    }
    Eigen::Map<Vector3>{residuals} = whitening_ * left;
    return true;
  }

 private:
  Eigen::Matrix3d whitening_;
  Vector3 target_;
  std::vector<std::pair<std::int32_t, double>> weights_;
};

/// (a - b) / deviation, or a / deviation alone.
class PriorCost : public ceres::CostFunction {
 public:
  PriorCost(double deviation_m, bool pair) : inverse_(1.0 / deviation_m) {
    set_num_residuals(3);
    mutable_parameter_block_sizes()->assign(pair ? 2 : 1, 3);
  }

  bool Evaluate(double const* const* displacements, double* residuals, double** jacobians) const override {
    Eigen::Map<Vector3> left(residuals);
    left.setZero();
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i) {
      const double sign = i == 0 ? inverse_ : -inverse_;
      left += sign * Eigen::Map<const Vector3>(displacements[i]);
      if (jacobians != nullptr && jacobians[i] != nullptr) {
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[i]} = sign * Eigen::Matrix3d::Identity();
      }
    }
    return true;
  }

 private:
  double inverse_;
};

/// A share of a match's whole weight, so that it does not slide along the surface without bound.
constexpr double kSticking = 0.05;
/// Rounds in which the gate is open: the mesh is not bent yet.
constexpr int kOpenRounds = 2;

Eigen::Matrix3d whitening_of(const Eigen::Matrix3d& information, const Vector3& normal) {
  const double across = normal.dot(information.inverse() * normal);
  const Eigen::Matrix3d weight = kSticking * information + (1.0 - kSticking) / across * normal * normal.transpose();
  return weight.llt().matrixU();
}

class Bending {
 public:
  Bending(const SurfaceMesh& mesh, const DeformationGrid& grid, const std::vector<SurfacePoint>& points,
          const Pose& base_T_mesh, const DeformationOptions& options, std::vector<Vector3> start)
      : mesh_(mesh), grid_(grid), options_(options), bent_(mesh), tree_(bent_), matches_(points.size()) {
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
      match();
      solve();
      const double moved_m = move();
      ++result_.rounds;
      result_.converged = (warm_ || result_.rounds > kOpenRounds) && moved_m < options_.tolerance_m;
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
    for (std::size_t i = 0; i < points_.size(); ++i) {
      matches_[i] = tree_.likely(points_[i].position, points_[i].covariance.inverse(), matches_[i].triangle);
      result_.used[i] = open || matches_[i].squared <= options_.gate;
    }
  }

  void solve() {
    ceres::Problem::Options ownership;
    ownership.enable_fast_removal = false;
    ceres::Problem problem(ownership);
    const auto block = [&](std::int32_t corner) {
      return result_.displacements[static_cast<std::size_t>(corner)].data();
    };
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
      auto weights = grid_.weights(triangle, matches_[i].barycentric);
      std::vector<double*> blocks;
      blocks.reserve(weights.size());
      for (const auto& [corner, weight] : weights) {
        blocks.push_back(block(corner));
      }
      const Eigen::Matrix3d whitening =
          whitening_of(points_[i].covariance.inverse(), tree_.normal(matches_[i].triangle));
      problem.AddResidualBlock(new PointCost(whitening, points_[i].position - unbent, std::move(weights)), nullptr,
                               blocks);
    }
    for (const auto& pair : grid_.neighbours()) {
      problem.AddResidualBlock(new PriorCost(options_.strain * options_.spacing_m, true), nullptr, block(pair[0]),
                               block(pair[1]));
    }
    for (std::size_t corner = 0; corner < grid_.corners(); ++corner) {
      problem.AddResidualBlock(new PriorCost(options_.travel_m, false), nullptr,
                               block(static_cast<std::int32_t>(corner)));
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.max_num_iterations = 3;  // linear: the first one is the solution but for the trust region
    solver.initial_trust_region_radius = 1e12;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
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
  std::vector<SurfacePoint> points_;  ///< in the mesh's frame
  std::vector<MeshMatch> matches_;
  bool warm_ = false;
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

Deformation deform(const SurfaceMesh& mesh, const DeformationGrid& grid, const std::vector<SurfacePoint>& points,
                   const Pose& base_T_mesh, const DeformationOptions& options, const std::vector<Vector3>& start) {
  options.validate();
  check_surface_points(mesh, points, base_T_mesh);
  if (!start.empty() && start.size() != grid.corners()) {
    throw ModelError("start: " + std::to_string(start.size()) + " displacements: must be " +
                     std::to_string(grid.corners()) + ", one a corner");
  }
  return Bending(mesh, grid, points, base_T_mesh, options, start).settle();
}

}  // namespace saras
