// Inputs shared by the tests of frame_mapping.hpp.
#pragma once

#include <cmath>

#include "saras/spatial/rotation.hpp"
#include "saras/teleop/frame_mapping.hpp"
#include "support/random_values.hpp"

namespace saras::test {

inline constexpr Seconds kDt = 0.01;

inline FrameMappingConfig random_config(RandomValues& random) {
  FrameMappingConfig config;
  config.base_T_console = random.pose(1.0);
  config.touch_T_console = random.pose(1.0);
  return config;
}

inline double distance(const Pose& a, const Pose& b) {
  const Twist moved = displacement(a, b);
  return moved.linear.norm() + moved.angular.norm();
}

/// A handle that swings about the origin of the console.
inline Pose swing(double t) {
  Pose pose;
  pose.translation = Vector3(0.05 * std::sin(7 * t), 0.04 * std::cos(5 * t), 0.03 * std::sin(3 * t));
  pose.rotation = rotation_exp(Vector3(std::sin(2 * t), 0.5 * std::sin(3 * t), std::cos(t)));
  return pose;
}

}  // namespace saras::test
