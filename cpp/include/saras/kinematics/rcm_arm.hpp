// The SARAS endoscope robot: planar 2R (SCARA) -> universal joint -> linear axis -> roll -> tip.
//
// Base frame sbs_world: origin in the shoulder axis, z up (out of the patient); the universal joint moves in
// the plane z = 0 and the trocar lies below it. tool_tip: +z along the shaft from the trocar to the tip.
// With R(a) about the named axis and phi = scara_1 + scara_2
//
//   base_R_tip = Rz(phi) Rx(universal_1) Ry(universal_2) Rx(pi) Rz(roll),   n = its third column
//   p_universal = l1 (cos q1, sin q1, 0) + l2 (cos phi, sin phi, 0)
//   p_tip = p_universal + (tip_offset + insertion) n
//
// so every inverse is closed form: the shaft's line meets the plane z = 0 in the universal joint. The mechanism
// does not hold the trocar; keeping it is the controller's work (modes pivot and parallel).
// Everything marked noexcept allocates nothing.
#pragma once

#include <optional>
#include <string>

#include "saras/kinematics/chain.hpp"
#include "saras/kinematics/mesa_geometry.hpp"

namespace saras {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix64 = Eigen::Matrix<double, 6, 4>;

struct RcmArmConfig {
  double scara_link_1_m = mesa::kScaraLink1;     ///< shoulder to elbow [m]
  double scara_link_2_m = mesa::kScaraLink2;     ///< elbow to universal joint [m]
  double tip_offset_m = mesa::kTipOffset;        ///< universal joint to tip at insertion = 0 [m]
  double instrument_m = mesa::kInstrument;       ///< adapter flange to tip [m]; moves no frame but the flange's
  double minimum_depth_m = mesa::kMinimumDepth;  ///< least distance from trocar to tip [m]
  Vector6 lower = Eigen::Map<const Vector6>(mesa::kLower.data());  ///< joint limits [rad], insertion [m]
  Vector6 upper = Eigen::Map<const Vector6>(mesa::kUpper.data());  ///< joint limits [rad], insertion [m]
  Vector6 speed = Eigen::Map<const Vector6>(mesa::kSpeed.data());  ///< speed limits [rad/s], insertion [m/s]
  void validate() const;                                           ///< throws ConfigError
};

/// Why an inverse has no answer.
enum class Unreachable : std::uint8_t {
  kNone = 0,
  kInvalidInput,  ///< not finite, or no rotation
  kDepth,         ///< tip not far enough behind the trocar (value: depth)
  kDirection,     ///< shaft does not come down through the SCARA plane (value: z of the shaft's direction)
  kScaraReach,    ///< universal joint too far from or too near to the shoulder (value: its distance)
  kJointLimit,    ///< a joint leaves its limits (joint, value)
};

/// What stands in the way, with the value and the bounds it leaves. kNone: nothing.
struct Violation {
  Unreachable reason = Unreachable::kNone;
  int joint = -1;  ///< index into mesa::kJointNames, kJointLimit only
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  explicit operator bool() const noexcept { return reason != Unreachable::kNone; }
};

/// For operators: quantity, value, bounds. Empty for kNone.
std::string describe(const Violation& violation);

/// Joint values, good only without a violation. Under kJointLimit q holds the values that the pose would need.
struct RcmSolution {
  Vector6 q = Vector6::Zero();
  Violation violation;
  bool ok() const noexcept { return !violation; }
  /// q, or throws KinematicsError with describe(violation).
  const Vector6& value() const;
};

class RcmArm {
 public:
  explicit RcmArm(RcmArmConfig config = {});
  const RcmArmConfig& config() const { return config_; }

  /// base_T_tip. NaN in gives a pose that is_valid() refuses.
  Pose forward(const Vector6& q) const noexcept;
  /// Centre of the universal joint in the base frame [m].
  Vector3 universal_position(const Vector6& q) const noexcept;
  /// Twist of the tip in the base frame (linear first) from joint rates.
  Matrix6 jacobian(const Vector6& q) const noexcept;
  Violation check_limits(const Vector6& q) const noexcept;
  /// The same mechanism for KDL, with the links and joints of urdf/mesa_arm.urdf.xacro.
  Chain chain() const;

  /// Joints for a pose, wherever its shaft passes. The elbow stays on the side of q_near and roll takes the
  /// turn nearest to q_near: no jump between neighbouring poses.
  RcmSolution inverse(const Pose& base_T_tip, const Vector6& q_near) const noexcept;
  /// Mode pivot: joints that put the tip at a point [m] with the shaft through the trocar rcm [m] and the roll
  /// joint at roll [rad].
  RcmSolution inverse_pivot(const Vector3& tip, double roll, const Vector3& rcm, const Vector6& q_near) const noexcept;
  /// Mode parallel: the universal joint stays where q_near has it; SCARA and linear axis bring the tip to a point.
  RcmSolution inverse_parallel(const Vector3& tip, double roll, const Vector6& q_near) const noexcept;
  /// What keeps the tip from a point with the shaft through rcm, with either side of the elbow. Roll is free.
  Violation reachable(const Vector3& tip, const Vector3& rcm) const noexcept;

  /// The pose at the same point, turned by the least rotation that brings its shaft through the trocar.
  /// Empty when the tip is nearer to rcm than minimum_depth_m, or input is not finite.
  std::optional<Pose> pivot_pose(const Pose& base_T_tip, const Vector3& rcm) const noexcept;
  /// Joint rates from (tip velocity [m/s], angular velocity about the shaft [rad/s]), both in the base frame, that
  /// keep the shaft through rcm. Empty near a singularity (arm stretched or folded) and below minimum_depth_m.
  std::optional<Matrix64> pivot_jacobian(const Vector6& q, const Vector3& rcm) const noexcept;
  /// Distance of the shaft's line from a point [m].
  double rcm_deviation(const Vector6& q, const Vector3& rcm) const noexcept;

 private:
  RcmSolution finish(Vector6 q, const Vector6& q_near) const noexcept;
  RcmSolution solve(const Vector3& tip, const Vector3& shaft, const Vector6& q_near) const noexcept;

  RcmArmConfig config_;
};

}  // namespace saras
