#include "saras/kinematics/dvrk_arm.hpp"

#include <cmath>
#include <limits>
#include <sstream>

namespace saras::dvrk {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTurn = 2.0 * M_PI;

}  // namespace

std::string describe(const Refusal& refusal) {
  if (!refusal) {
    return "";
  }
  std::ostringstream text;
  text.precision(6);
  if (refusal.lower == -kInfinity && refusal.upper == kInfinity) {
    text << refusal.quantity << ": must be finite, a pose with a unit quaternion";
  } else {
    text << refusal.quantity << " = " << refusal.value << ": must be in [" << refusal.lower << ", " << refusal.upper
         << "]";
  }
  return text.str();
}

Refusal invalid_input() noexcept { return {"input", std::numeric_limits<double>::quiet_NaN(), -kInfinity, kInfinity}; }

ShaftFrame shaft_frame(double yaw, double pitch) noexcept {
  const double s1 = std::sin(yaw);
  const double c1 = std::cos(yaw);
  const double s2 = std::sin(pitch);
  const double c2 = std::cos(pitch);
  return {Vector3(-s1 * s2, -c2, c1 * s2), Vector3(-c1, 0.0, -s1), Vector3(c2 * s1, -s2, -c2 * c1)};
}

YawPitch yaw_pitch(const Vector3& shaft) noexcept {
  return {std::atan2(shaft.x(), -shaft.z()), std::atan2(-shaft.y(), std::hypot(shaft.x(), shaft.z()))};
}

double nearest_turn(double angle, double near, double lower, double upper) noexcept {
  const double nearest = angle + kTurn * std::round((near - angle) / kTurn);
  if (nearest > upper + kLimitTolerance && nearest - kTurn >= lower - kLimitTolerance) {
    return nearest - kTurn;
  }
  if (nearest < lower - kLimitTolerance && nearest + kTurn <= upper + kLimitTolerance) {
    return nearest + kTurn;
  }
  return nearest;
}

Refusal limit_refusal(const double* q, const double* lower, const double* upper, const char* const* quantities,
                      int count) noexcept {
  for (int i = 0; i < count; ++i) {
    if (!(q[i] >= lower[i] - kLimitTolerance && q[i] <= upper[i] + kLimitTolerance)) {
      return {quantities[i], q[i], lower[i], upper[i]};
    }
  }
  return {};
}

}  // namespace saras::dvrk
