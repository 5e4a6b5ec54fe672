#include "saras/spatial/rotation.hpp"

#include <cmath>

namespace saras {

Vector3 rotation_log(const Quaternion& rotation) {
  // q and -q are the same rotation: take the one with w >= 0 for the shortest arc.
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const Vector3 v = sign * rotation.vec();
  const double w = sign * rotation.w();
  const double sin_half = v.norm();
  if (sin_half < 1e-9) {
    return v * (2.0 / w);  // next term of the series is O(sin_half^2) ~ 1e-18
  }
  return v * (2.0 * std::atan2(sin_half, w) / sin_half);
}

Quaternion rotation_exp(const Vector3& rotation_vector) {
  const double angle = rotation_vector.norm();
  // sin(a/2)/a, with its series where the quotient loses digits.
  const double scale = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Quaternion q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = scale * rotation_vector;
  return q.normalized();
}

Twist displacement(const Pose& base_T_1, const Pose& base_T_2) {
  return {base_T_2.translation - base_T_1.translation, rotation_log(base_T_2.rotation * base_T_1.rotation.conjugate())};
}

Pose add_delta(const Pose& base_T_body, const Twist& base_twist, Seconds dt) {
  return {(rotation_exp(base_twist.angular * dt) * base_T_body.rotation).normalized(),
          base_T_body.translation + base_twist.linear * dt};
}

}  // namespace saras
