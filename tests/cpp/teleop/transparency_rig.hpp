// Inputs shared by the tests of transparency.hpp.
#pragma once

#include "saras/spatial/rotation.hpp"
#include "saras/teleop/transparency.hpp"

namespace saras::test {

inline constexpr Seconds kDt = 0.01;

/// Tip 0.1 m below a trocar at the origin, shaft along the tip's z.
inline Pose hanging_tip() { return {rotation_exp(Vector3(M_PI, 0, 0)), Vector3(0, 0, -0.1)}; }

inline TransparencyInput at_rest() {
  TransparencyInput input;
  input.slave_pose = hanging_tip();
  return input;
}

/// Referenced at rest and with the ramp complete.
inline Transparency engaged(const TransparencyConfig& config) {
  Transparency law(config);
  for (int i = 0; i < 15; ++i) {
    law.step(at_rest(), kDt);
  }
  return law;
}

inline TransparencyConfig without_limits() {
  TransparencyConfig config;
  config.force_limit_N = 1e6;
  config.torque_limit_Nm = 1e6;
  config.drift_limit_m_s = 1e6;
  config.pivoted = false;
  return config;
}

}  // namespace saras::test
