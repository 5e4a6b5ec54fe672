// Inputs shared by the tests of velocity_integrator.hpp.
#pragma once

#include "saras/spatial/rotation.hpp"
#include "saras/teleop/velocity_integrator.hpp"

namespace saras::test {

inline constexpr Seconds kDt = 0.01;

/// Tip 0.1 m below a trocar at the origin, shaft along the tip's z.
inline Pose hanging_tip() { return {rotation_exp(Vector3(M_PI, 0, 0)), Vector3(0, 0, -0.1)}; }

inline VelocityIntegratorInput command(const Vector3& linear, const Vector3& angular = Vector3::Zero()) {
  VelocityIntegratorInput input;
  input.twist = {linear, angular};
  input.measured_pose = hanging_tip();
  return input;
}

/// Follows an ideal arm: measured = last set-point.
inline VelocityIntegratorOutput follow(VelocityIntegrator& law, VelocityIntegratorInput input, int ticks) {
  VelocityIntegratorOutput output;
  for (int i = 0; i < ticks; ++i) {
    if (law.state().started) {
      input.measured_pose = law.state().set_point;
    }
    output = law.step(input, kDt);
  }
  return output;
}

}  // namespace saras::test
