#include "saras/model/registration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "saras/model/model_error.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix3d cross_matrix(const Vector3& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// One run, from matching to the settled pose.
class Run {
 public:
  Run(const MeshTree& tree, const std::vector<SurfacePoint>& points, const Pose& start,
      const RegistrationOptions& options)
      : tree_(tree), points_(points), options_(options), information_(points.size()), weights_(points.size(), 1.0) {
    result_.base_T_mesh = start;
    result_.matches.resize(points.size());
    result_.used.assign(points.size(), true);
    for (const SurfacePoint& point : points) {
      middle_ += point.position / static_cast<double>(points.size());
    }
    for (const SurfacePoint& point : points) {
      reach_m_ = std::max(reach_m_, (point.position - middle_).norm());
    }
  }

  Registration settle() {
    for (; result_.iterations < options_.max_iterations && !result_.converged; ++result_.iterations) {
      match();
      gate();
      const double moved_m = move();
      // The first rounds only find out how far off the pose is.
      result_.converged = result_.iterations > 3 && moved_m < options_.tolerance_m;
    }
    weigh_all();
    finish();
    return std::move(result_);
  }

 private:
  void match() {
    const Eigen::Matrix3d rotation = result_.base_T_mesh.rotation.toRotationMatrix();
    const Pose mesh_T_base = result_.base_T_mesh.inverse();
    // Before the first match nothing is known of the misalignment: closest points.
    const double known = result_.iterations > 0 && options_.most_likely ? 1.0 : 0.0;
    const double own = options_.mesh_noise_m * options_.mesh_noise_m + misalignment_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Eigen::Matrix3d covariance = known * points_[i].covariance;
      covariance.diagonal().array() += known > 0.0 ? own : 1.0;
      information_[i] = covariance.inverse();
      const Eigen::Matrix3d in_mesh = rotation.transpose() * information_[i] * rotation;
      result_.matches[i] = tree_.likely(mesh_T_base * points_[i].position, in_mesh, result_.matches[i].triangle);
    }
  }

  void gate() {
    // How far off the pose still is: what the points' own noise does not explain of their distances. By the median,
    // which gross errors do not move.
    squares_.clear();
    double noise = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector3 across = residual(i);
      squares_.push_back(across.squaredNorm());
      const Vector3 normal = normal_of(i);
      noise += normal.dot(points_[i].covariance * normal) / static_cast<double>(points_.size());
    }
    const auto middle = squares_.begin() + static_cast<std::ptrdiff_t>(squares_.size() / 2);
    std::nth_element(squares_.begin(), middle, squares_.end());
    constexpr double kMedianOfSquare = 0.4549;  // of a squared standard normal value
    misalignment_ = std::max(0.0, *middle / kMedianOfSquare - noise);
    if (!options_.most_likely || result_.iterations == 0) {
      return;
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      result_.used[i] = result_.matches[i].squared <= options_.gate;
      count += result_.used[i] ? 1 : 0;
    }
    if (count < 3) {  // nothing to hold on to: all of them then
      result_.used.assign(points_.size(), true);
    }
  }

  /// Where the gate left points out: each one counts by how probably it is no gross error, instead of all or not at
  /// all. Expectation and maximisation over noise and gross errors anywhere along the normal.
  void weigh_all() {
    const auto left_out = std::count(result_.used.begin(), result_.used.end(), false);
    if (!options_.most_likely || left_out == 0) {
      return;
    }
    misalignment_ = 0.0;  // it has settled: what is left is noise, or gross
    double gross_share = static_cast<double>(left_out) / static_cast<double>(points_.size());
    bool settled = false;
    for (int round = 0; round < kWeighedRounds && !settled; ++round, ++result_.iterations) {
      match();
      gross_share = weigh(gross_share);
      settled = move() < options_.tolerance_m;
    }
    match();
    weigh(gross_share);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      result_.used[i] = weights_[i] > 0.5;
    }
  }

  /// The points' weights from the share of gross errors; returns what that share is by them.
  double weigh(double gross_share) {
    constexpr double kRootTwoPi = 2.5066282746310002;
    double reach_m = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      reach_m = std::max(reach_m, std::abs(residual(i).dot(normal_of(i))));
    }
    double gross = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector3 normal = normal_of(i);
      const double deviation_m = std::sqrt(normal.dot(information_[i].inverse() * normal));
      const double noise = std::exp(-0.5 * result_.matches[i].squared) / (kRootTwoPi * deviation_m);
      const double good = (1.0 - gross_share) * noise;
      const double bad = gross_share / (2.0 * std::max(reach_m, deviation_m));
      weights_[i] = good / (good + bad);
      gross += (1.0 - weights_[i]) / static_cast<double>(points_.size());
      result_.used[i] = true;
    }
    return std::clamp(gross, kLeastGross, 0.5);
  }

  Vector3 normal_of(std::size_t i) const {
    return result_.base_T_mesh.rotation * tree_.normal(result_.matches[i].triangle);
  }

  Vector3 residual(std::size_t i) const { return points_[i].position - result_.base_T_mesh * result_.matches[i].point; }

  /// One Gauss-Newton step about the points' middle; returns how far the farthest of the points moves with it.
  double move() {
    Matrix6 hessian = Matrix6::Zero();
    Vector6 gradient = Vector6::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (result_.used[i]) {
        add(i, hessian, gradient);
      }
    }
    add_prior(hessian, gradient);
    hessian.diagonal().array() += 1e-12 * hessian.trace();
    const Vector6 step = hessian.ldlt().solve(gradient);
    const Quaternion turn = rotation_exp(step.tail<3>());
    Pose& pose = result_.base_T_mesh;
    pose.translation = middle_ + turn * (pose.translation - middle_) + step.head<3>();
    pose.rotation = (turn * pose.rotation).normalized();
    return step.head<3>().norm() + reach_m_ * step.tail<3>().norm();
  }

  void add(std::size_t i, Matrix6& hessian, Vector6& gradient) const {
    const Vector3 on_mesh = result_.base_T_mesh * result_.matches[i].point;
    Eigen::Matrix<double, 3, 6> jacobian;  // of on_mesh
    jacobian << Eigen::Matrix3d::Identity(), -cross_matrix(on_mesh - middle_);
    Eigen::Matrix3d curvature = information_[i];
    if (options_.most_likely) {
      // The match slides along the surface with the pose: only what lies across it resists. A share of the whole keeps
      // steps short where the surface bends. The pull is that of the whole, as a match's residual lies across the
      // surface in the metric; but at the border of an open mesh, where it would pull the mesh along.
      const Vector3 normal = normal_of(i);
      const double across = normal.dot(information_[i].inverse() * normal);
      const double sticking = sticking_share();
      curvature = sticking * information_[i] + (1.0 - sticking) / across * normal * normal.transpose();
    }
    gradient += weights_[i] * jacobian.transpose() * curvature * (points_[i].position - on_mesh);
    hessian += weights_[i] * jacobian.transpose() * curvature * jacobian;
  }

  void add_prior(Matrix6& hessian, Vector6& gradient) const {
    const PosePrior& prior = options_.prior;
    const Pose& pose = result_.base_T_mesh;
    Vector6 weight;  // zero for infinite deviations
    weight << Vector3::Constant(1.0 / (prior.shift_m * prior.shift_m)),
        Vector3::Constant(1.0 / (prior.turn_rad * prior.turn_rad));
    Vector6 back;  // from where it is to where it is believed to be, of the mesh's point in the points' middle
    back << prior.base_T_mesh * (pose.inverse() * middle_) - middle_,
        rotation_log(prior.base_T_mesh.rotation * pose.rotation.conjugate());
    hessian.diagonal() += weight;
    gradient += weight.cwiseProduct(back);
  }

  void finish() {
    Matrix6 hessian = Matrix6::Zero();
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!result_.used[i]) {
        continue;
      }
      // Along the surface a match follows its point: only the distance across it says where the mesh is.
      add_across(i, hessian);
      sum += residual(i).squaredNorm();
      count += 1.0;
    }
    result_.rms_m = count > 0.0 ? std::sqrt(sum / count) : 0.0;
    Vector6 unused = Vector6::Zero();
    add_prior(hessian, unused);
    hessian.diagonal().array() += 1e-12 * hessian.trace();
    result_.covariance = hessian.inverse();
  }

  void add_across(std::size_t i, Matrix6& hessian) const {
    const Vector3 normal = normal_of(i);
    const Vector3 on_mesh = result_.base_T_mesh * result_.matches[i].point;
    Vector6 row;
    row << normal, (on_mesh - middle_).cross(normal);
    const double variance = normal.dot(points_[i].covariance * normal) + options_.mesh_noise_m * options_.mesh_noise_m;
    hessian += weights_[i] / variance * row * row.transpose();
  }

  /// Where a prior holds what the points leave open, sticking would only make the way to it long.
  double sticking_share() const {
    constexpr double kSticking = 0.1;
    const bool held = std::isfinite(options_.prior.shift_m) && std::isfinite(options_.prior.turn_rad);
    return held ? kSticking * std::pow(0.6, result_.iterations) : kSticking;
  }

  static constexpr int kWeighedRounds = 30;
  static constexpr double kLeastGross = 1e-3;
  const MeshTree& tree_;
  const std::vector<SurfacePoint>& points_;
  const RegistrationOptions& options_;
  std::vector<Eigen::Matrix3d> information_;
  std::vector<double> weights_;  ///< probability of being no gross error
  Vector3 middle_ = Vector3::Zero();
  double reach_m_ = 0.0;
  double misalignment_ = 0.0;  ///< [m^2] each axis
  std::vector<double> squares_;
  Registration result_;
};

}  // namespace

void check_surface_points(const SurfaceMesh& mesh, const std::vector<SurfacePoint>& points, const Pose& base_T_mesh) {
  if (points.size() < 3) {
    throw ModelError("points: " + std::to_string(points.size()) + ": must be at least 3");
  }
  Vector3 low = mesh.vertices.front();
  Vector3 high = low;
  for (const Vector3& vertex : mesh.vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  const double extent_m = (high - low).norm();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& point = points[i];
    if (!point.position.allFinite() || !point.covariance.allFinite() ||
        Eigen::LLT<Eigen::Matrix3d>(point.covariance).info() != Eigen::Success) {
      throw ModelError("points: " + std::to_string(i) + ": must be finite, with a positive definite covariance");
    }
    const double away_m = (point.position - base_T_mesh * (0.5 * (low + high))).norm();
    if (away_m > 20.0 * extent_m) {
      throw ModelError("points: " + std::to_string(i) + " is " + std::to_string(away_m) + " m from a mesh of " +
                       std::to_string(extent_m) + " m: must be within 20 times its extent (another unit?)");
    }
  }
}

void RegistrationOptions::validate() const {
  validate::positive("gate", gate);
  validate::not_negative("mesh_noise_m", mesh_noise_m);
  validate::pose("prior.base_T_mesh", prior.base_T_mesh);
  if (!std::isinf(prior.shift_m)) {
    validate::positive("prior.shift_m", prior.shift_m);
  }
  if (!std::isinf(prior.turn_rad)) {
    validate::positive("prior.turn_rad", prior.turn_rad);
  }
  validate::in_range("max_iterations", max_iterations, 1, 100'000);
  validate::positive("tolerance_m", tolerance_m);
}

Registration register_rigid(const SurfaceMesh& mesh, const MeshTree& tree, const std::vector<SurfacePoint>& points,
                            const Pose& base_T_mesh, const RegistrationOptions& options) {
  options.validate();
  check_surface_points(mesh, points, base_T_mesh);
  return Run(tree, points, base_T_mesh, options).settle();
}

}  // namespace saras
