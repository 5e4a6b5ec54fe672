// The residual of one pair, its noise, and the least-squares problem in Ceres.
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Cholesky>

#include "hand_eye_parts.hpp"
#include "saras/spatial/rotation.hpp"

namespace saras::hand_eye_parts {
namespace {

template <typename T>
struct Rigid {
  Eigen::Matrix<T, 3, 3> rotation;
  Eigen::Matrix<T, 3, 1> translation;
};

/// pose moved by [m, rad] in its own parent's axes.
template <typename T>
Rigid<T> moved(const Pose& pose, const T* by) {
  Eigen::Matrix<T, 3, 3> turn;
  ceres::AngleAxisToRotationMatrix(by + 3, turn.data());
  Rigid<T> result;
  result.rotation = turn * pose.rotation.toRotationMatrix().cast<T>();
  for (int i = 0; i < 3; ++i) {
    result.translation[i] = T(pose.translation[i]) + by[i];
  }
  return result;
}

class PairCost {
 public:
  PairCost(const HandEyePair& pair, const Estimate& at, const Matrix6& whitening, bool eye_to_hand)
      : pair_(pair), at_(at), whitening_(whitening), eye_to_hand_(eye_to_hand) {}

  template <typename T>
  bool operator()(const T* camera, const T* target, const T* seconds, T* whitened) const {
    T motion[6];
    for (int i = 0; i < 3; ++i) {
      motion[i] = pair_.gripper_twist.linear[i] * (at_.time_offset_s + seconds[0]);
      motion[i + 3] = pair_.gripper_twist.angular[i] * (at_.time_offset_s + seconds[0]);
    }
    Rigid<T> moving = moved(pair_.base_T_gripper, motion);
    if (eye_to_hand_) {
      moving.rotation.transposeInPlace();
      moving.translation = (-(moving.rotation * moving.translation)).eval();
    }
    const Rigid<T> mounted = moved(at_.gripper_T_camera, camera);
    const Rigid<T> expected = moved(at_.base_T_target, target);
    const Eigen::Matrix<T, 3, 3> said_rotation =
        moving.rotation * mounted.rotation * pair_.camera_T_target.rotation.toRotationMatrix().cast<T>();
    const Eigen::Matrix<T, 3, 1> seen = pair_.camera_T_target.translation.cast<T>();
    const Eigen::Matrix<T, 3, 1> said =
        moving.rotation * (mounted.rotation * seen + mounted.translation) + moving.translation;
    Eigen::Matrix<T, 6, 1> residual;
    residual.template head<3>() = said - expected.translation;
    const Eigen::Matrix<T, 3, 3> difference = said_rotation * expected.rotation.transpose();
    ceres::RotationMatrixToAngleAxis(difference.data(), residual.data() + 3);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(whitened);
    out = whitening_.cast<T>() * residual;
    return true;
  }

  static ceres::CostFunction* make(const HandEyePair& pair, const Estimate& at, const Matrix6& whitening,
                                   bool eye_to_hand) {
    return new ceres::AutoDiffCostFunction<PairCost, 6, 6, 6, 1>(new PairCost(pair, at, whitening, eye_to_hand));
  }

 private:
  const HandEyePair& pair_;
  const Estimate& at_;
  Matrix6 whitening_;
  bool eye_to_hand_;
};

/// W with WᵀW = covariance⁻¹.
Matrix6 whitening_of(const Matrix6& covariance) {
  const Eigen::LLT<Matrix6> factor(covariance);
  return factor.matrixL().solve(Matrix6::Identity());
}

/// Beyond this whitened length a pair's pull falls: the 95 % point of six normal values.
constexpr double kCauchyScale = 3.55;

}  // namespace

Pose moving_pose(const HandEyePair& pair, double time_offset_s, bool eye_to_hand) {
  const Pose pose =
      time_offset_s == 0.0 ? pair.base_T_gripper : add_delta(pair.base_T_gripper, pair.gripper_twist, time_offset_s);
  return eye_to_hand ? pose.inverse() : pose;
}

Pose target_of(const HandEyePair& pair, const Estimate& estimate, bool eye_to_hand) {
  return moving_pose(pair, estimate.time_offset_s, eye_to_hand) * estimate.gripper_T_camera * pair.camera_T_target;
}

Vector6 residual_of(const HandEyePair& pair, const Estimate& estimate, bool eye_to_hand) {
  return to_vector(displacement(estimate.base_T_target, target_of(pair, estimate, eye_to_hand)));
}

NoiseParts noise_parts(const HandEyePair& pair, const Estimate& estimate, const HandEyeOptions& options) {
  const Pose moving = moving_pose(pair, estimate.time_offset_s, options.eye_to_hand);
  const Pose target = moving * estimate.gripper_T_camera * pair.camera_T_target;
  // Eye-to-hand: the residual is in the gripper's frame, and the gripper's own origin is where it turns about.
  const Vector3 lever = options.eye_to_hand ? target.translation : Vector3(target.translation - moving.translation);
  Eigen::Matrix<double, 6, 3> turn;  // of a rotation error of the gripper
  turn << 0.0, lever.z(), -lever.y(), -lever.z(), 0.0, lever.x(), lever.y(), -lever.x(), 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
      0.0, 0.0, 0.0, 1.0;
  const HandEyeNoise& noise = options.noise;
  NoiseParts parts{Matrix6::Zero(), Matrix6::Zero()};
  parts.rotation = noise.robot_rotation_rad * noise.robot_rotation_rad * turn * turn.transpose();
  parts.rotation.bottomRightCorner<3, 3>().diagonal().array() += noise.camera_rotation_rad * noise.camera_rotation_rad;
  parts.translation.topLeftCorner<3, 3>().diagonal().array() +=
      noise.robot_translation_m * noise.robot_translation_m + noise.camera_translation_m * noise.camera_translation_m;
  return parts;
}

Estimate solve(const std::vector<HandEyePair>& pairs, const std::vector<bool>& used, const Estimate& from,
               const std::vector<Matrix6>& covariances, const HandEyeOptions& options, bool robust) {
  std::array<double, 6> camera{};
  std::array<double, 6> target{};
  double seconds = 0.0;
  ceres::Problem problem;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (used[i]) {
      problem.AddResidualBlock(PairCost::make(pairs[i], from, whitening_of(covariances[i]), options.eye_to_hand),
                               robust ? new ceres::CauchyLoss(kCauchyScale) : nullptr, camera.data(), target.data(),
                               &seconds);
    }
  }
  if (!options.time_offset) {
    problem.SetParameterBlockConstant(&seconds);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = 50;
  solver.function_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  const auto apply = [](const Pose& pose, const std::array<double, 6>& by) {
    return add_delta(pose, to_twist(Eigen::Map<const Vector6>(by.data())), 1.0);
  };
  return {apply(from.gripper_T_camera, camera), apply(from.base_T_target, target), from.time_offset_s + seconds};
}

Jacobian jacobian_of(const HandEyePair& pair, const Estimate& estimate, const HandEyeOptions& options) {
  const std::unique_ptr<ceres::CostFunction> cost(
      PairCost::make(pair, estimate, Matrix6::Identity(), options.eye_to_hand));
  const std::array<double, 6> zero{};
  const double seconds = 0.0;
  const std::array<const double*, 3> at = {zero.data(), zero.data(), &seconds};
  Vector6 residual;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> by_camera;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> by_target;
  Vector6 by_seconds;
  std::array<double*, 3> jacobians = {by_camera.data(), by_target.data(), by_seconds.data()};
  cost->Evaluate(at.data(), residual.data(), jacobians.data());
  Jacobian jacobian;
  jacobian << by_camera, by_target, by_seconds;
  if (!options.time_offset) {
    jacobian.col(kParameters - 1).setZero();
  }
  return jacobian;
}

}  // namespace saras::hand_eye_parts
