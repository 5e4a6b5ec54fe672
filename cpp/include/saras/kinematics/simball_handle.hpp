// The console's hand piece: a shaft in a ball joint (Simball), carried by the Touch above the ball.
//
// simball_base: origin in the pivot, z up, x away from the operator. handle: origin where the Touch and the hand
// hold the shaft, +z along the shaft towards the pivot, as +z of tool_tip runs from the trocar to the tip. With
// q = [yaw, pitch, roll, insertion]
//
//   simball_R_handle = Rx(yaw) Ry(pitch) Rx(pi) Rz(roll),   n = its third column
//   p_handle = -(handle_distance - insertion) n
//
// so positive yaw moves the handle to -y, positive pitch to +x, positive insertion down to the pivot.
#pragma once

#include <array>
#include <optional>

#include "saras/spatial/types.hpp"

namespace saras {

using Vector4 = Eigen::Vector4d;

namespace simball {
inline constexpr std::array<const char*, 4> kJointNames = {"yaw", "pitch", "roll", "insertion"};
inline constexpr double kHandleDistance = 0.22;                             ///< pivot to handle at insertion = 0 [m]
inline constexpr std::array<double, 4> kLower = {-0.80, -0.80, -3.1, 0.0};  ///< [rad], insertion [m]
inline constexpr std::array<double, 4> kUpper = {0.80, 0.80, 3.1, 0.15};    ///< [rad], insertion [m]
}  // namespace simball

struct SimballHandleConfig {
  double handle_distance_m = simball::kHandleDistance;                ///< pivot to handle at insertion = 0 [m]
  Vector4 lower = Eigen::Map<const Vector4>(simball::kLower.data());  ///< [rad], insertion [m]
  Vector4 upper = Eigen::Map<const Vector4>(simball::kUpper.data());  ///< [rad], insertion [m]
  void validate() const;                                              ///< throws ConfigError
};

/// Everything noexcept allocates nothing.
class SimballHandle {
 public:
  explicit SimballHandle(SimballHandleConfig config = {});
  const SimballHandleConfig& config() const { return config_; }

  /// simball_T_handle.
  Pose forward(const Vector4& q) const noexcept;
  /// 6 x 4: twist of the handle in simball_base, linear first, from joint rates.
  Eigen::Matrix<double, 6, 4> jacobian(const Vector4& q) const noexcept;
  /// Joints for a handle at a point [m] with its roll [rad]; limits are not applied. Empty for input that is not
  /// finite and for points that are not above the pivot.
  std::optional<Vector4> inverse(const Vector3& handle, double roll) const noexcept;
  /// The same from a pose: its point decides the shaft, its turn about the shaft the roll in (-pi, pi].
  std::optional<Vector4> inverse(const Pose& simball_T_handle) const noexcept;
  /// Nearest joints inside the limits.
  Vector4 clamp(const Vector4& q) const noexcept { return q.cwiseMax(config_.lower).cwiseMin(config_.upper); }
  /// Throws KinematicsError naming the first joint that is not finite or beyond its limits, its value, the bounds.
  void check_limits(const Vector4& q) const;

 private:
  SimballHandleConfig config_;
};

}  // namespace saras
