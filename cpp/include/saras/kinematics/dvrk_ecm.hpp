// The da Vinci's endoscope manipulator: four joints about a remote centre.
//
// q = [yaw, pitch, insertion, roll], base frame in the remote centre (see dvrk_arm.hpp). The tip is the end of the
// endoscope: z out of the lens, x to the left and y up as the surgeon sees it; up and down look 30 degrees off the
// shaft.
//
//   p_tip = (q3 + 0.0007 m) n,   R_tip = [x_3, y_3, n] Rz(q4) Rz(-pi/2) Rx(0, -30 or +30 degrees)
//
// Everything noexcept allocates nothing.
#pragma once

#include <array>

#include "saras/kinematics/dvrk_arm.hpp"
#include "saras/kinematics/dvrk_tools.hpp"

namespace saras::dvrk {

using Vector4 = Eigen::Vector4d;

inline constexpr std::array<const char*, 4> kEcmJointNames = {"yaw", "pitch", "insertion", "roll"};

struct EcmConfig {
  double insertion_offset_m = 0.3822;                                        ///< as in PsmConfig [m]
  double endoscope_length_m = 0.3829;                                        ///< DH d of the roll row [m]
  double view_angle_rad = 0.0;                                               ///< lens about x, down positive
  Vector4 lower = (Vector4() << -1.5708, -0.76794, 0.0, -1.552).finished();  ///< [rad], [m]
  Vector4 upper = (Vector4() << 1.5708, 1.1344, 0.255, 1.552).finished();    ///< [rad], [m]
  void validate() const;                                                     ///< ConfigError
};

EcmConfig ecm_config(Endoscope endoscope, Body body);

struct EcmSolution {
  Vector4 q = Vector4::Zero();
  /// Angle between the asked and the reached rotation [rad]: four joints hold a point and the roll about the shaft.
  double rotation_error_rad = 0.0;
  Refusal refusal;
  bool ok() const noexcept { return !refusal; }
  /// q, or throws KinematicsError with describe(refusal).
  const Vector4& value() const;
};

class Ecm {
 public:
  explicit Ecm(EcmConfig config = {});
  const EcmConfig& config() const { return config_; }

  /// base_T_tip. NaN in gives a pose that is_valid() refuses.
  Pose forward(const Vector4& q) const noexcept;
  /// 6 x 4: twist of the tip in the base frame, linear first, from joint rates.
  Eigen::Matrix<double, 6, 4> jacobian(const Vector4& q) const noexcept;
  /// Unit vector from the remote centre along the endoscope.
  Vector3 shaft(const Vector4& q) const noexcept { return shaft_frame(q[0], q[1]).shaft; }
  Refusal check_limits(const Vector4& q) const noexcept;
  /// Joints that reach the pose's point, with the roll that comes nearest to its rotation. Refused when the rotation
  /// that remains exceeds rotation_tolerance_rad; pi takes any. A point in the remote centre keeps q_near's direction.
  EcmSolution inverse(const Pose& base_T_tip, const Vector4& q_near, double rotation_tolerance_rad) const noexcept;

 private:
  EcmConfig config_;
};

}  // namespace saras::dvrk
