// Poses, twists and wrenches: the values that every room exchanges.
//
// SI units. Linear part first (KDL order). A Twist or Wrench refers to the origin of its own body
// (handle, tool tip); between frames it is rotated only. KDL's Frame * Wrench would add p x f.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace saras {

using Seconds = double;  ///< a duration [s]

using Vector3 = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Quaternion = Eigen::Quaterniond;

/// Rigid transform a_T_b: maps coordinates in b to coordinates in a.
struct Pose {
  Quaternion rotation = Quaternion::Identity();  ///< unit quaternion of a_R_b
  Vector3 translation = Vector3::Zero();         ///< origin of b in a [m]

  Pose operator*(const Pose& b_T_c) const {
    return {rotation * b_T_c.rotation, rotation * b_T_c.translation + translation};
  }
  Vector3 operator*(const Vector3& point_in_b) const { return rotation * point_in_b + translation; }
  Pose inverse() const {
    const Quaternion b_R_a = rotation.conjugate();
    return {b_R_a, -(b_R_a * translation)};
  }
};

/// Velocity of a body's origin [m/s] and of its rotation [rad/s], both in one named frame.
struct Twist {
  Vector3 linear = Vector3::Zero();
  Vector3 angular = Vector3::Zero();
};

/// Force [N] and torque [N m] that the robot exerts on its surroundings, at the body's origin.
struct Wrench {
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();
};

inline Twist operator*(const Quaternion& a_R_b, const Twist& in_b) {
  return {a_R_b * in_b.linear, a_R_b * in_b.angular};
}
inline Wrench operator*(const Quaternion& a_R_b, const Wrench& in_b) {
  return {a_R_b * in_b.force, a_R_b * in_b.torque};
}

/// Power [W] that the robot delivers to its surroundings.
inline double dot(const Wrench& wrench, const Twist& twist) {
  return wrench.force.dot(twist.linear) + wrench.torque.dot(twist.angular);
}

inline Vector6 to_vector(const Twist& twist) {
  Vector6 v;
  v << twist.linear, twist.angular;
  return v;
}
inline Vector6 to_vector(const Wrench& wrench) {
  Vector6 v;
  v << wrench.force, wrench.torque;
  return v;
}
inline Twist to_twist(const Vector6& v) { return {v.head<3>(), v.tail<3>()}; }
inline Wrench to_wrench(const Vector6& v) { return {v.head<3>(), v.tail<3>()}; }

/// Largest deviation of a quaternion's norm from 1 that still counts as a rotation.
inline constexpr double kUnitQuaternionTolerance = 1e-6;

inline bool is_finite(const Vector3& v) { return v.allFinite(); }
inline bool is_finite(const Twist& v) { return v.linear.allFinite() && v.angular.allFinite(); }
inline bool is_finite(const Wrench& v) { return v.force.allFinite() && v.torque.allFinite(); }
/// Finite and with a unit quaternion.
inline bool is_valid(const Pose& pose) {
  return pose.translation.allFinite() && pose.rotation.coeffs().allFinite() &&
         std::abs(pose.rotation.norm() - 1.0) <= kUnitQuaternionTolerance;
}

}  // namespace saras
