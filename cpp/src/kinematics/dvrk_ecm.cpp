#include "saras/kinematics/dvrk_ecm.hpp"

#include <cmath>
#include <utility>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::dvrk {
namespace {

constexpr double kFree = 1e-9;  // nearer to the remote centre [m] the direction comes from q_near
constexpr double kViewAngle = M_PI / 6.0;

constexpr std::array<const char*, 4> kQuantities = {"yaw [rad]", "pitch [rad]", "insertion [m]", "roll [rad]"};

Eigen::Matrix3d matrix(const ShaftFrame& frame) noexcept {
  Eigen::Matrix3d m;
  m << frame.x, frame.y, frame.shaft;
  return m;
}

/// From the frame that roll turns to the tip: Rz(-pi/2) Rx(view angle).
Quaternion tip_offset(double view_angle_rad) noexcept {
  return Quaternion(Eigen::AngleAxisd(-M_PI / 2.0, Vector3::UnitZ()) *
                    Eigen::AngleAxisd(view_angle_rad, Vector3::UnitX()));
}

}  // namespace

void EcmConfig::validate() const {
  validate::positive("insertion_offset_m", insertion_offset_m);
  validate::positive("endoscope_length_m", endoscope_length_m);
  validate::in_range("view_angle_rad", view_angle_rad, -M_PI / 2.0, M_PI / 2.0);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const std::string element = "[" + std::to_string(i) + "]";
    validate::finite(("lower" + element).c_str(), lower[i]);
    validate::finite(("upper" + element).c_str(), upper[i]);
    validate::less(("lower" + element).c_str(), lower[i], ("upper" + element).c_str(), upper[i]);
  }
  validate::in_range("lower[1]", lower[1], -M_PI / 2.0, M_PI / 2.0);
  validate::in_range("upper[1]", upper[1], -M_PI / 2.0, M_PI / 2.0);
}

EcmConfig ecm_config(Endoscope endoscope, Body body) {
  EcmConfig config;
  if (endoscope == Endoscope::kUp) {
    config.view_angle_rad = -kViewAngle;
  } else if (endoscope == Endoscope::kDown) {
    config.view_angle_rad = kViewAngle;
  }
  if (body == Body::kSi) {
    config.lower << -2.964, -1.10, 0.001, -1.54;
    config.upper << 2.964, 1.04, 0.259, 1.54;
  }
  return config;
}

const Vector4& EcmSolution::value() const {
  if (refusal) {
    throw KinematicsError(describe(refusal));
  }
  return q;
}

Ecm::Ecm(EcmConfig config) : config_(std::move(config)) { config_.validate(); }

Pose Ecm::forward(const Vector4& q) const noexcept {
  const ShaftFrame frame = shaft_frame(q[0], q[1]);
  Pose pose;
  pose.rotation = Quaternion(matrix(frame)) * Quaternion(Eigen::AngleAxisd(q[3], Vector3::UnitZ())) *
                  tip_offset(config_.view_angle_rad);
  pose.rotation.normalize();
  pose.translation = (q[2] - config_.insertion_offset_m + config_.endoscope_length_m) * frame.shaft;
  return pose;
}

Eigen::Matrix<double, 6, 4> Ecm::jacobian(const Vector4& q) const noexcept {
  const ShaftFrame frame = shaft_frame(q[0], q[1]);
  const Vector3 tip = (q[2] - config_.insertion_offset_m + config_.endoscope_length_m) * frame.shaft;
  const Vector3 yaw = -Vector3::UnitY();
  Eigen::Matrix<double, 6, 4> jacobian;
  jacobian.col(0) << yaw.cross(tip), yaw;
  jacobian.col(1) << frame.y.cross(tip), frame.y;
  jacobian.col(2) << frame.shaft, Vector3::Zero();
  jacobian.col(3) << Vector3::Zero(), frame.shaft;
  return jacobian;
}

Refusal Ecm::check_limits(const Vector4& q) const noexcept {
  if (!q.allFinite()) {
    return invalid_input();
  }
  return limit_refusal(q.data(), config_.lower.data(), config_.upper.data(), kQuantities.data(), 4);
}

EcmSolution Ecm::inverse(const Pose& base_T_tip, const Vector4& q_near, double rotation_tolerance_rad) const noexcept {
  EcmSolution solution;
  if (!is_valid(base_T_tip) || !q_near.allFinite() || !(rotation_tolerance_rad >= 0.0)) {
    solution.refusal = invalid_input();
    return solution;
  }
  const double depth = base_T_tip.translation.norm();
  const Vector3 shaft = depth > kFree ? Vector3(base_T_tip.translation / depth) : this->shaft(q_near);
  const YawPitch angles = yaw_pitch(shaft);
  const Quaternion frame(matrix(shaft_frame(angles.yaw, angles.pitch)));
  // The twist about z of what remains is the roll that leaves the least rotation.
  const Quaternion rest =
      frame.conjugate() * base_T_tip.rotation.normalized() * tip_offset(config_.view_angle_rad).conjugate();
  const double roll = std::remainder(2.0 * std::atan2(rest.z(), rest.w()), 2.0 * M_PI);
  solution.q << nearest_turn(angles.yaw, q_near[0], config_.lower[0], config_.upper[0]), angles.pitch,
      depth + config_.insertion_offset_m - config_.endoscope_length_m,
      nearest_turn(roll, q_near[3], config_.lower[3], config_.upper[3]);
  solution.rotation_error_rad = rotation_log(forward(solution.q).rotation.conjugate() * base_T_tip.rotation).norm();
  solution.refusal = check_limits(solution.q);
  if (solution.ok()) {
    solution.q = solution.q.cwiseMax(config_.lower).cwiseMin(config_.upper);
    if (solution.rotation_error_rad > rotation_tolerance_rad) {
      solution.refusal = {"rotation beyond what four joints reach [rad]", solution.rotation_error_rad, 0.0,
                          rotation_tolerance_rad};
    }
  }
  return solution;
}

}  // namespace saras::dvrk
