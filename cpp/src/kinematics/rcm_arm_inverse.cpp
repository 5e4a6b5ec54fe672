// Closed-form inverses of the SARAS arm and what stands in their way.
#include <cmath>
#include <limits>
#include <sstream>

#include "saras/kinematics/rcm_arm.hpp"
#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTurn = 2.0 * M_PI;
constexpr double kLimitTolerance = 1e-9;  // rounding of a pose made at a limit; the solution is put on the limit
constexpr double kLeastDescent = 0.05;    // -z of the shaft's direction below which it counts as level

struct PlanarAngles {
  double first;
  double second;
};

/// Planar 2R arm with links l1, l2 to the point (x, y); elbow: sign of the second angle.
std::optional<PlanarAngles> planar_inverse(double x, double y, double l1, double l2, double elbow) noexcept {
  const double cosine = (x * x + y * y - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
  if (!(std::abs(cosine) <= 1.0 + 1e-12)) {
    return std::nullopt;
  }
  const double second = std::copysign(std::acos(std::fmax(-1.0, std::fmin(1.0, cosine))), elbow);
  return PlanarAngles{std::atan2(y, x) - std::atan2(l2 * std::sin(second), l1 + l2 * std::cos(second)), second};
}

/// The same angle plus whole turns: nearest to `near`, but inside the limits when some turn is.
double choose_turn(double angle, double near, double lower, double upper) noexcept {
  const double nearest = angle + kTurn * std::round((near - angle) / kTurn);
  if (nearest > upper + kLimitTolerance && nearest - kTurn >= lower) {
    return nearest - kTurn;
  }
  if (nearest < lower - kLimitTolerance && nearest + kTurn <= upper) {
    return nearest + kTurn;
  }
  return nearest;
}

RcmSolution refused(Unreachable reason, double value, double lower, double upper) noexcept {
  RcmSolution solution;
  solution.violation = {reason, -1, value, lower, upper};
  return solution;
}

RcmSolution invalid_input() noexcept {
  return refused(Unreachable::kInvalidInput, std::numeric_limits<double>::quiet_NaN(), -kInfinity, kInfinity);
}

}  // namespace

std::string describe(const Violation& violation) {
  std::ostringstream text;
  text.precision(6);
  switch (violation.reason) {
    case Unreachable::kNone:
      return "";
    case Unreachable::kInvalidInput:
      return "input: must be finite, with a unit quaternion";
    case Unreachable::kDepth:
      text << "depth behind the trocar [m]";
      break;
    case Unreachable::kDirection:
      text << "z of the shaft's direction (down through the SCARA plane)";
      break;
    case Unreachable::kScaraReach:
      text << "universal joint's distance from the shoulder [m]";
      break;
    case Unreachable::kJointLimit:
      text << mesa::kJointNames.at(static_cast<std::size_t>(violation.joint))
           << (violation.joint == 4 ? " [m]" : " [rad]");
      break;
  }
  text << " = " << violation.value << ": must be in [" << violation.lower << ", " << violation.upper << "]";
  return text.str();
}

const Vector6& RcmSolution::value() const {
  if (violation) {
    throw KinematicsError(describe(violation));
  }
  return q;
}

Violation RcmArm::check_limits(const Vector6& q) const noexcept {
  if (!q.allFinite()) {
    return invalid_input().violation;
  }
  for (int i = 0; i < mesa::kJoints; ++i) {
    if (q[i] < config_.lower[i] - kLimitTolerance || q[i] > config_.upper[i] + kLimitTolerance) {
      return {Unreachable::kJointLimit, i, q[i], config_.lower[i], config_.upper[i]};
    }
  }
  return {};
}

RcmSolution RcmArm::finish(Vector6 q, const Vector6& q_near) const noexcept {
  for (const int i : {0, 1, 5}) {
    q[i] = choose_turn(q[i], q_near[i], config_.lower[i], config_.upper[i]);
  }
  RcmSolution solution;
  solution.q = q;
  solution.violation = check_limits(q);
  if (solution.ok()) {
    solution.q = q.cwiseMax(config_.lower).cwiseMin(config_.upper);
  }
  return solution;
}

/// All joints but roll, which is taken from q_near.
RcmSolution RcmArm::solve(const Vector3& tip, const Vector3& shaft, const Vector6& q_near) const noexcept {
  if (shaft.z() > -kLeastDescent) {
    return refused(Unreachable::kDirection, shaft.z(), -1.0, -kLeastDescent);
  }
  const double distance = tip.z() / shaft.z();  // universal joint to tip
  const Vector3 universal = tip - distance * shaft;
  const auto scara =
      planar_inverse(universal.x(), universal.y(), config_.scara_link_1_m, config_.scara_link_2_m, q_near[1]);
  if (!scara) {
    return refused(Unreachable::kScaraReach, universal.head<2>().norm(),
                   std::abs(config_.scara_link_1_m - config_.scara_link_2_m),
                   config_.scara_link_1_m + config_.scara_link_2_m);
  }
  const double phi = scara->first + scara->second;
  const Vector3 local = Eigen::AngleAxisd(-phi, Vector3::UnitZ()) * shaft;
  Vector6 q;
  q << scara->first, scara->second, std::atan2(local.y(), -local.z()),
      std::asin(std::fmax(-1.0, std::fmin(1.0, -local.x()))), distance - config_.tip_offset_m, q_near[5];
  return finish(q, q_near);
}

RcmSolution RcmArm::inverse(const Pose& base_T_tip, const Vector6& q_near) const noexcept {
  if (!is_valid(base_T_tip) || !q_near.allFinite()) {
    return invalid_input();
  }
  RcmSolution solution = solve(base_T_tip.translation, base_T_tip.rotation * Vector3::UnitZ(), q_near);
  const bool has_joints = solution.ok() || solution.violation.reason == Unreachable::kJointLimit;
  if (!has_joints) {
    return solution;
  }
  // What is left to turn about the shaft once the other joints stand.
  Vector6 q = solution.q;
  q[5] = 0.0;
  const Quaternion rest = forward(q).rotation.conjugate() * base_T_tip.rotation;
  q[5] = 2.0 * std::atan2(rest.z(), rest.w());
  return finish(q, q_near);
}

RcmSolution RcmArm::inverse_pivot(const Vector3& tip, double roll, const Vector3& rcm,
                                  const Vector6& q_near) const noexcept {
  if (!tip.allFinite() || !std::isfinite(roll) || !rcm.allFinite() || !q_near.allFinite()) {
    return invalid_input();
  }
  const Vector3 shaft = tip - rcm;
  const double depth = shaft.norm();
  if (depth < config_.minimum_depth_m) {
    return refused(Unreachable::kDepth, depth, config_.minimum_depth_m, kInfinity);
  }
  Vector6 near = q_near;
  near[5] = roll;
  return solve(tip, shaft / depth, near);
}

RcmSolution RcmArm::inverse_parallel(const Vector3& tip, double roll, const Vector6& q_near) const noexcept {
  if (!tip.allFinite() || !std::isfinite(roll) || !q_near.allFinite()) {
    return invalid_input();
  }
  // The shaft is fixed in the second link: with the tip's height the linear axis follows, and the second link
  // acts as one straight to the tip's projection.
  const Vector3 local = Eigen::AngleAxisd(q_near[2], Vector3::UnitX()) *
                        (Eigen::AngleAxisd(q_near[3], Vector3::UnitY()) * Vector3(-Vector3::UnitZ()));
  if (local.z() > -kLeastDescent) {
    return refused(Unreachable::kDirection, local.z(), -1.0, -kLeastDescent);
  }
  const double distance = tip.z() / local.z();
  const double x = config_.scara_link_2_m + distance * local.x();
  const double y = distance * local.y();
  const double length = std::hypot(x, y);
  const double bend = std::atan2(y, x);
  const auto scara =
      planar_inverse(tip.x(), tip.y(), config_.scara_link_1_m, length, std::remainder(q_near[1] + bend, kTurn));
  if (!scara) {
    return refused(Unreachable::kScaraReach, tip.head<2>().norm(), std::abs(config_.scara_link_1_m - length),
                   config_.scara_link_1_m + length);
  }
  Vector6 q = q_near;
  q[0] = scara->first;
  q[1] = scara->second - bend;
  q[4] = distance - config_.tip_offset_m;
  q[5] = roll;
  Vector6 near = q_near;
  near[5] = roll;
  return finish(q, near);
}

Violation RcmArm::reachable(const Vector3& tip, const Vector3& rcm) const noexcept {
  Vector6 near = Vector6::Zero();
  Violation first;
  for (const double elbow : {1.0, -1.0}) {
    near[1] = elbow;
    const Violation violation = inverse_pivot(tip, 0.0, rcm, near).violation;
    if (!violation) {
      return {};
    }
    if (!first) {
      first = violation;
    }
  }
  return first;
}

}  // namespace saras
