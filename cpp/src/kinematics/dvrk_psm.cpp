#include "saras/kinematics/dvrk_psm.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::dvrk {
namespace {

// Below this length [m] a direction is rounding noise and comes from q_near instead.
constexpr double kFree = 1e-9;
// Weighs metres against radians when solutions are compared.
constexpr double kRadiansPerMetre = 10.0;
constexpr double kSiInsertionOffset = 0.4826;

constexpr std::array<const char*, 6> kQuantities = {"yaw [rad]",  "pitch [rad]",       "insertion [m]",
                                                    "roll [rad]", "wrist_pitch [rad]", "wrist_yaw [rad]"};

struct WristFrame {
  ShaftFrame arm;
  Vector3 x4, x5, z5, z6, x6;
};

WristFrame wrist_frame(const Vector6& q) noexcept {
  WristFrame f;
  f.arm = shaft_frame(q[0], q[1]);
  f.x4 = std::cos(q[3]) * f.arm.x + std::sin(q[3]) * f.arm.y;
  f.z5 = -std::sin(q[3]) * f.arm.x + std::cos(q[3]) * f.arm.y;
  f.x5 = std::sin(q[4]) * f.x4 + std::cos(q[4]) * f.arm.shaft;
  f.z6 = f.z5.cross(f.x5);
  f.x6 = std::sin(q[5]) * f.x5 + std::cos(q[5]) * f.z5;
  return f;
}

/// Unit vector along v without its part along the unit axis; any one when nothing is left.
Vector3 perpendicular(const Vector3& v, const Vector3& axis) noexcept {
  const Vector3 rest = v - v.dot(axis) * axis;
  const double length = rest.norm();
  return length > 1e-6 ? Vector3(rest / length) : axis.unitOrthogonal();
}

}  // namespace

void PsmConfig::validate() const {
  validate::positive("insertion_offset_m", insertion_offset_m);
  validate::positive("tool_length_m", tool_length_m);
  validate::positive("wrist_offset_m", wrist_offset_m);
  validate::finite("lower", lower);
  validate::finite("upper", upper);
  validate::not_above("lower", lower, "upper", upper);
  // Beyond a level shaft yaw and pitch would have a second solution.
  validate::in_range("lower[1]", lower[1], -M_PI / 2.0, M_PI / 2.0);
  validate::in_range("upper[1]", upper[1], -M_PI / 2.0, M_PI / 2.0);
}

PsmConfig psm_config(const Tool& tool, Body body) {
  PsmConfig config;
  config.tool_length_m = tool.length_m;
  config.wrist_offset_m = tool.wrist_offset_m;
  if (body == Body::kSi) {
    if (tool.length_m != kSiLength) {
      throw ConfigError("tool = '" + tool.name + ":" + tool.model +
                        "': an Si body takes S and Si instruments (420xxx); the tip would be 50.8 mm off");
    }
    config.insertion_offset_m = kSiInsertionOffset;
    config.lower.head<3>() << -2.964, -1.265, 0.0;
    config.upper.head<3>() << 2.964, 1.301, 0.290;
  }
  config.upper.tail<3>() << tool.roll_limit_rad, tool.wrist_pitch_limit_rad, tool.wrist_yaw_limit_rad;
  config.lower.tail<3>() = -config.upper.tail<3>();
  return config;
}

const Vector6& PsmSolution::value() const {
  if (refusal) {
    throw KinematicsError(describe(refusal));
  }
  return q;
}

Psm::Psm(PsmConfig config) : config_(std::move(config)) { config_.validate(); }

Pose Psm::forward(const Vector6& q) const noexcept {
  const WristFrame f = wrist_frame(q);
  Eigen::Matrix3d rotation;
  rotation << -f.z6, -f.x6, f.z6.cross(f.x6);
  Pose pose;
  pose.rotation = Quaternion(rotation).normalized();
  pose.translation = reach(q) * f.arm.shaft + config_.wrist_offset_m * f.x5;
  return pose;
}

Matrix6 Psm::jacobian(const Vector6& q) const noexcept {
  const WristFrame f = wrist_frame(q);
  const Vector3 from_wrist = config_.wrist_offset_m * f.x5;
  const Vector3 tip = reach(q) * f.arm.shaft + from_wrist;
  const Vector3 yaw = -Vector3::UnitY();
  Matrix6 jacobian;
  jacobian.col(0) << yaw.cross(tip), yaw;
  jacobian.col(1) << f.arm.y.cross(tip), f.arm.y;
  jacobian.col(2) << f.arm.shaft, Vector3::Zero();
  jacobian.col(3) << f.arm.shaft.cross(from_wrist), f.arm.shaft;
  jacobian.col(4) << f.z5.cross(from_wrist), f.z5;
  jacobian.col(5) << Vector3::Zero(), f.z6;
  return jacobian;
}

Refusal Psm::check_limits(const Vector6& q) const noexcept {
  if (!q.allFinite()) {
    return invalid_input();
  }
  return limit_refusal(q.data(), config_.lower.data(), config_.upper.data(), kQuantities.data(), 6);
}

PsmSolution Psm::inverse(const Pose& base_T_tip, const Vector6& q_near) const noexcept {
  PsmSolution best;
  if (!is_valid(base_T_tip) || !q_near.allFinite()) {
    best.refusal = invalid_input();
    return best;
  }
  const Eigen::Matrix3d rotation = base_T_tip.rotation.normalized().toRotationMatrix();
  const Vector3& tip = base_T_tip.translation;
  const Vector3 z6 = -rotation.col(0);
  const Vector3 x6 = -rotation.col(1);
  const WristFrame near = wrist_frame(q_near);

  // Remote centre, wrist and tip lie in one plane with z_6, and the wrist's pitch axis is its normal.
  const Vector3 normal = tip.cross(z6);
  const double length = normal.norm();
  const Vector3 pitch_axis = length > kFree ? Vector3(normal / length) : perpendicular(near.z5, z6);

  double best_beyond = std::numeric_limits<double>::infinity();
  double best_distance = best_beyond;
  for (const double side : {1.0, -1.0}) {
    const Vector3 z5 = side * pitch_axis;
    const Vector3 x5 = z6.cross(z5);
    const Vector3 wrist = tip - config_.wrist_offset_m * x5;
    const double distance = wrist.norm();
    const Vector3 towards = distance > kFree ? Vector3(wrist / distance) : perpendicular(near.arm.shaft, z5);
    for (const double sense : {1.0, -1.0}) {  // wrist beyond the remote centre, or still behind it
      const Vector3 shaft = sense * towards;
      const YawPitch angles = yaw_pitch(shaft);
      const ShaftFrame arm = shaft_frame(angles.yaw, angles.pitch);
      const double roll = std::atan2(-z5.dot(arm.x), z5.dot(arm.y));
      const Vector3 x4 = std::cos(roll) * arm.x + std::sin(roll) * arm.y;
      Vector6 q;
      q << nearest_turn(angles.yaw, q_near[0], config_.lower[0], config_.upper[0]), angles.pitch,
          wrist.dot(shaft) + config_.insertion_offset_m - config_.tool_length_m,
          nearest_turn(roll, q_near[3], config_.lower[3], config_.upper[3]), std::atan2(x5.dot(x4), x5.dot(shaft)),
          std::atan2(x6.dot(x5), x6.dot(z5));
      Vector6 scaled = q - q_near;
      scaled[2] *= kRadiansPerMetre;
      Vector6 outside = (q - config_.upper).cwiseMax(config_.lower - q).cwiseMax(0.0);
      outside[2] *= kRadiansPerMetre;
      const Refusal refusal = check_limits(q);
      const double beyond = refusal ? outside.sum() : 0.0;
      if (beyond < best_beyond || (beyond == best_beyond && scaled.norm() < best_distance)) {
        best_beyond = beyond;
        best_distance = scaled.norm();
        best = {q, refusal};
      }
    }
  }
  if (best.ok()) {
    best.q = best.q.cwiseMax(config_.lower).cwiseMin(config_.upper);
  }
  return best;
}

}  // namespace saras::dvrk
