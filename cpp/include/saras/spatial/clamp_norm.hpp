// Bounds on length that keep the direction.
#pragma once

#include "saras/spatial/rotation.hpp"
#include "saras/spatial/types.hpp"

namespace saras {

/// v, shortened to the limit where it is longer.
inline Vector3 clamp_norm(const Vector3& v, double limit) {
  const double norm = v.norm();
  return norm > limit ? Vector3(v * (limit / norm)) : v;
}

/// The rotation on the shortest arc from one to the other, at most angle_limit [rad] away from the first.
inline Quaternion rotate_toward(const Quaternion& from, const Quaternion& to, double angle_limit) {
  const Vector3 arc = rotation_log(to * from.conjugate());
  return arc.norm() > angle_limit ? (rotation_exp(clamp_norm(arc, angle_limit)) * from).normalized() : to;
}

}  // namespace saras
