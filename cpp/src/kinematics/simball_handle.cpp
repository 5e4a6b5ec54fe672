#include "saras/kinematics/simball_handle.hpp"

#include <cmath>
#include <sstream>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr double kLeastDistance = 1e-3;  // from the pivot [m]: nearer, the shaft's direction is noise

Quaternion about(double angle, const Vector3& axis) noexcept { return Quaternion(Eigen::AngleAxisd(angle, axis)); }

const Quaternion kDown(0.0, 1.0, 0.0, 0.0);  // Rx(pi)

}  // namespace

void SimballHandleConfig::validate() const {
  validate::positive("handle_distance_m", handle_distance_m);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const std::string element = "[" + std::to_string(i) + "]";
    validate::finite(("lower" + element).c_str(), lower[i]);
    validate::finite(("upper" + element).c_str(), upper[i]);
    validate::less(("lower" + element).c_str(), lower[i], ("upper" + element).c_str(), upper[i]);
  }
  validate::less("upper[3]", upper[3], "handle_distance_m", handle_distance_m);
}

SimballHandle::SimballHandle(SimballHandleConfig config) : config_(std::move(config)) { config_.validate(); }

Pose SimballHandle::forward(const Vector4& q) const noexcept {
  Pose pose;
  pose.rotation = about(q[0], Vector3::UnitX()) * about(q[1], Vector3::UnitY()) * kDown * about(q[2], Vector3::UnitZ());
  pose.rotation.normalize();
  pose.translation = (q[3] - config_.handle_distance_m) * (pose.rotation * Vector3::UnitZ());
  return pose;
}

Eigen::Matrix<double, 6, 4> SimballHandle::jacobian(const Vector4& q) const noexcept {
  const Pose pose = forward(q);
  const Vector3 shaft = pose.rotation * Vector3::UnitZ();
  const Vector3 yaw = Vector3::UnitX();
  const Vector3 pitch = about(q[0], Vector3::UnitX()) * Vector3::UnitY();
  Eigen::Matrix<double, 6, 4> jacobian;
  jacobian.col(0) << yaw.cross(pose.translation), yaw;
  jacobian.col(1) << pitch.cross(pose.translation), pitch;
  jacobian.col(2) << Vector3::Zero(), shaft;
  jacobian.col(3) << shaft, Vector3::Zero();
  return jacobian;
}

std::optional<Vector4> SimballHandle::inverse(const Vector3& handle, double roll) const noexcept {
  const double distance = handle.norm();
  if (!std::isfinite(distance) || !std::isfinite(roll) || distance < kLeastDistance || handle.z() <= 0.0) {
    return std::nullopt;
  }
  const Vector3 up = handle / distance;  // Rx(yaw) Ry(pitch) e_z = (sin p, -sin y cos p, cos y cos p)
  return Vector4(std::atan2(-up.y(), up.z()), std::asin(std::fmax(-1.0, std::fmin(1.0, up.x()))), roll,
                 config_.handle_distance_m - distance);
}

std::optional<Vector4> SimballHandle::inverse(const Pose& simball_T_handle) const noexcept {
  if (!is_valid(simball_T_handle)) {
    return std::nullopt;
  }
  auto q = inverse(simball_T_handle.translation, 0.0);
  if (q) {
    const Quaternion rest = forward(*q).rotation.conjugate() * simball_T_handle.rotation;
    (*q)[2] = std::remainder(2.0 * std::atan2(rest.z(), rest.w()), 2.0 * M_PI);
  }
  return q;
}

void SimballHandle::check_limits(const Vector4& q) const {
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (!(q[i] >= config_.lower[i] && q[i] <= config_.upper[i])) {
      std::ostringstream message;
      message << simball::kJointNames.at(static_cast<std::size_t>(i)) << " = " << q[i] << ": must be in ["
              << config_.lower[i] << ", " << config_.upper[i] << "]";
      throw KinematicsError(message.str());
    }
  }
}

}  // namespace saras
