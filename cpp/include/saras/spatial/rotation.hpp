// Logarithm and exponential of rotations, and displacement of poses (KDL::diff, KDL::addDelta).
#pragma once

#include "saras/spatial/types.hpp"

namespace saras {

/// Rotation vector [rad] of a unit quaternion, |v| <= pi, shortest arc; accurate near 0 and near pi.
Vector3 rotation_log(const Quaternion& rotation);

/// Unit quaternion of a rotation vector [rad].
Quaternion rotation_exp(const Vector3& rotation_vector);

/// Displacement from base_T_1 to base_T_2 in the base frame: translation [m], rotation vector [rad].
/// Divide by the interval for the mean twist. Same convention as KDL::diff(F_a_b1, F_a_b2).
Twist displacement(const Pose& base_T_1, const Pose& base_T_2);

/// Moves a pose by a base-frame twist for dt. Same convention as KDL::addDelta. Keeps the quaternion unit.
Pose add_delta(const Pose& base_T_body, const Twist& base_twist, Seconds dt);

}  // namespace saras
