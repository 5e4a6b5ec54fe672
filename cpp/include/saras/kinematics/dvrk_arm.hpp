// What PSM and ECM share: yaw and pitch about the remote centre, insertion along the shaft.
//
// Base frame (PSM1, PSM2, ECM): origin in the remote centre, at zero joints the shaft points down its -z. With modified
// DH (rows in docs/dvrk.md)
//
//   n = z_3 = (cos q2 sin q1, -sin q2, -cos q2 cos q1)   shaft, from the remote centre to the tip
//   x_3 = (-sin q1 sin q2, -cos q2, cos q1 sin q2),   y_3 = (-cos q1, 0, -sin q1), which is also the pitch axis
#pragma once

#include <optional>
#include <string>

#include "saras/spatial/types.hpp"

namespace saras::dvrk {

/// Rounding of a pose made at a limit [rad, m]; a solution within it is put on the limit.
inline constexpr double kLimitTolerance = 1e-9;

/// What keeps joints or a pose from being taken: quantity, value and the bounds that it leaves.
struct Refusal {
  const char* quantity = nullptr;  ///< with its unit; nullptr: nothing is in the way
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  explicit operator bool() const noexcept { return quantity != nullptr; }
};

/// "insertion [m] = 0.3: must be in [0, 0.24]"; empty when nothing is in the way.
std::string describe(const Refusal& refusal);

/// The answer to input that is not finite or no rotation.
Refusal invalid_input() noexcept;

/// Axes of the frame that yaw and pitch turn.
struct ShaftFrame {
  Vector3 x;      ///< x_3
  Vector3 y;      ///< y_3, the pitch axis
  Vector3 shaft;  ///< z_3
};

ShaftFrame shaft_frame(double yaw, double pitch) noexcept;

struct YawPitch {
  double yaw;
  double pitch;
};

/// Yaw in (-pi, pi], pitch in [-pi/2, pi/2] of a unit shaft direction.
YawPitch yaw_pitch(const Vector3& shaft) noexcept;

/// The angle plus whole turns: nearest to near, but inside [lower, upper] when some turn is.
double nearest_turn(double angle, double near, double lower, double upper) noexcept;

/// First joint that is not finite or outside its limits by more than kLimitTolerance.
Refusal limit_refusal(const double* q, const double* lower, const double* upper, const char* const* quantities,
                      int count) noexcept;

}  // namespace saras::dvrk
