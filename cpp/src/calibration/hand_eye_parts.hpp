// The steps of hand_eye: a start, one least-squares solution, levels of noise and covariance.
#pragma once

#include <vector>

#include "saras/calibration/hand_eye.hpp"

namespace saras::hand_eye_parts {

/// Unknowns: gripper_T_camera, base_T_target, seconds.
struct Estimate {
  Pose gripper_T_camera;
  Pose base_T_target;
  double time_offset_s = 0.0;
};

/// Parameters of the linearised problem: 6 of the camera, 6 of the target, the time offset.
inline constexpr int kParameters = 13;
using Jacobian = Eigen::Matrix<double, 6, kParameters>;
using Information = Eigen::Matrix<double, kParameters, kParameters>;

/// Squares of the factors on the expected noise.
struct Levels {
  double rotation = 1.0;
  double translation = 1.0;
};

/// Parts of a residual's covariance: rotation errors (with their lever) and translation errors.
struct NoiseParts {
  Matrix6 rotation;
  Matrix6 translation;
};

/// The gripper's pose at this time offset; its inverse for eye-to-hand.
Pose moving_pose(const HandEyePair& pair, double time_offset_s, bool eye_to_hand);
/// Where one pair says that the target is.
Pose target_of(const HandEyePair& pair, const Estimate& estimate, bool eye_to_hand);
Vector6 residual_of(const HandEyePair& pair, const Estimate& estimate, bool eye_to_hand);
NoiseParts noise_parts(const HandEyePair& pair, const Estimate& estimate, const HandEyeOptions& options);

/// From all pairs, or, when they contradict each other, from the three pairs that the median of all agrees with best.
Estimate start(const std::vector<HandEyePair>& pairs, const HandEyeOptions& options,
               const std::optional<Pose>& initial);

/// Sum of squares of the whitened residuals of the used pairs, made least with Ceres. robust: Cauchy's loss.
Estimate solve(const std::vector<HandEyePair>& pairs, const std::vector<bool>& used, const Estimate& from,
               const std::vector<Matrix6>& covariances, const HandEyeOptions& options, bool robust);

/// Jacobian of the residual at the estimate.
Jacobian jacobian_of(const HandEyePair& pair, const Estimate& estimate, const HandEyeOptions& options);

/// One step of restricted maximum likelihood on the levels, from the used pairs.
Levels next_levels(const std::vector<Vector6>& residuals, const std::vector<Jacobian>& jacobians,
                   const std::vector<NoiseParts>& parts, const std::vector<bool>& used, const Levels& levels,
                   bool time_offset);

/// Covariance of all parameters; between groups when they are given, else from the levels.
Information parameter_covariance(const std::vector<HandEyePair>& pairs, const std::vector<Vector6>& residuals,
                                 const std::vector<Jacobian>& jacobians, const std::vector<Matrix6>& covariances,
                                 const std::vector<bool>& used, const HandEyeOptions& options);

}  // namespace saras::hand_eye_parts
