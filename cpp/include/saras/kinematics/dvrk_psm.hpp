// The da Vinci's patient side manipulator with its instrument: six joints about a remote centre.
//
// q = [yaw, pitch, insertion, roll, wrist_pitch, wrist_yaw], base frame in the remote centre (see dvrk_arm.hpp). With
// r = q3 - insertion_offset + tool_length and n the shaft
//
//   p_wrist = r n,   p_tip = p_wrist + wrist_offset x_5
//   z_5 = -sin q4 x_3 + cos q4 y_3,   x_4 = cos q4 x_3 + sin q4 y_3
//   x_5 = sin q5 x_4 + cos q5 n,   z_6 = z_5 x x_5,   x_6 = sin q6 x_5 + cos q6 z_5
//   R_tip = [-z_6, -x_6, z_6 x x_6]                  tip: dVRK's rotation to the ISI convention
//
// Everything noexcept allocates nothing.
#pragma once

#include <array>

#include "saras/kinematics/dvrk_arm.hpp"
#include "saras/kinematics/dvrk_tools.hpp"

namespace saras::dvrk {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

inline constexpr std::array<const char*, 6> kPsmJointNames = {"yaw",  "pitch",       "insertion",
                                                              "roll", "wrist_pitch", "wrist_yaw"};

struct PsmConfig {
  double insertion_offset_m = 0.4318;  ///< instrument carriage at insertion 0, behind the remote centre [m]
  double tool_length_m = kClassicLength;
  double wrist_offset_m = 0.0091;  ///< wrist pitch axis to wrist yaw axis [m]
  Vector6 lower = (Vector6() << -1.588, -0.925025, 0.0, -4.53786, -1.39626, -1.39626).finished();  ///< [rad], [m]
  Vector6 upper = (Vector6() << 1.588, 0.925025, 0.240, 4.53786, 1.39626, 1.39626).finished();     ///< [rad], [m]
  void validate() const;                                                                           ///< ConfigError
};

/// Body and instrument together. Throws ConfigError for an Si body with a Classic instrument.
PsmConfig psm_config(const Tool& tool, Body body);

struct PsmSolution {
  Vector6 q = Vector6::Zero();  ///< under a joint's refusal the values that the pose would need
  Refusal refusal;
  bool ok() const noexcept { return !refusal; }
  /// q, or throws KinematicsError with describe(refusal).
  const Vector6& value() const;
};

class Psm {
 public:
  explicit Psm(PsmConfig config = {});
  const PsmConfig& config() const { return config_; }

  /// base_T_tip. NaN in gives a pose that is_valid() refuses.
  Pose forward(const Vector6& q) const noexcept;
  /// Twist of the tip in the base frame, linear first, from joint rates.
  Matrix6 jacobian(const Vector6& q) const noexcept;
  /// Unit vector from the remote centre along the shaft to the wrist.
  Vector3 shaft(const Vector6& q) const noexcept { return shaft_frame(q[0], q[1]).shaft; }
  /// Wrist pitch axis in the base frame [m]: the end of the straight shaft.
  Vector3 wrist_position(const Vector6& q) const noexcept { return reach(q) * shaft(q); }
  Refusal check_limits(const Vector6& q) const noexcept;
  /// Joints for a pose, closed form. Of the up to four solutions and their turns of roll the one inside the limits
  /// that is nearest to q_near. Where a direction is free (wrist in the remote centre; tip on the wrist's yaw axis
  /// through it) it is taken from q_near.
  PsmSolution inverse(const Pose& base_T_tip, const Vector6& q_near) const noexcept;

 private:
  /// Remote centre to wrist along the shaft [m]; negative while the wrist is behind it.
  double reach(const Vector6& q) const noexcept { return q[2] - config_.insertion_offset_m + config_.tool_length_m; }

  PsmConfig config_;
};

}  // namespace saras::dvrk
