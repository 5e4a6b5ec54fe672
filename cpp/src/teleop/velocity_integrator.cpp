#include "saras/teleop/velocity_integrator.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/clamp_norm.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr int kTurns = 8;
constexpr double kSame_m = 1e-9;

double angle_between(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

bool command_is_finite(const VelocityIntegratorInput& input) {
  return is_finite(input.twist) && std::isfinite(input.max_speed_scale) && is_finite(input.approach_direction) &&
         !std::isnan(input.approach_speed_limit_m_s);
}

}  // namespace

void VelocityIntegratorConfig::validate() const {
  validate::positive("speed_limit_m_s", speed_limit_m_s);
  validate::positive("speed_limit_rad_s", speed_limit_rad_s);
  validate::positive("lead_limit_m", lead_limit_m);
  validate::positive("lead_limit_rad", lead_limit_rad);
  validate::in_range("lead_limit_rad", lead_limit_rad, 0.0, M_PI);
  validate::unit("cone_axis", cone_axis);
  validate::positive("cone_half_angle_rad", cone_half_angle_rad);
  validate::less("cone_half_angle_rad", cone_half_angle_rad, "pi/2", M_PI_2);
  validate::not_negative("insertion_min_m", insertion_min_m);
  validate::less("insertion_min_m", insertion_min_m, "insertion_max_m", insertion_max_m);
  validate::positive("measured_jump_m", measured_jump_m);
  validate::positive("nominal_dt_s", nominal_dt_s);
  validate::positive("dt_max_s", dt_max_s);
  validate::in_range("nominal_dt_s", nominal_dt_s, 0.0, dt_max_s);
}

VelocityIntegrator::VelocityIntegrator(VelocityIntegratorConfig config) : config_(config) { config_.validate(); }

VelocityIntegratorOutput VelocityIntegrator::step(const VelocityIntegratorInput& input, Seconds dt,
                                                  PositionBound* further) noexcept {
  VelocityIntegratorOutput output;
  output.has_set_point = state_.started;
  output.set_point = state_.set_point;
  if (!is_valid(input.measured_pose) || !is_finite(input.rcm)) {
    output.status = state_.started ? Status::kInvalidInput : Status::kWaiting;
    return output;
  }
  const Vector3 measured = input.measured_pose.translation;
  if (!state_.started) {
    state_.started = true;
    state_.set_point = {input.measured_pose.rotation.normalized(), measured};
    dt = config_.nominal_dt_s;
  } else if ((measured - state_.measured_position).norm() > config_.measured_jump_m) {
    output.measured_jumped = true;
    output.status = Status::kInvalidInput;
    return output;
  }
  state_.measured_position = measured;
  output.has_set_point = true;
  output.set_point = state_.set_point;
  if (!std::isfinite(dt) || dt <= 0.0) {
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  if (dt > config_.dt_max_s) {
    output.status = Status::kInvalidTimeStep;
    dt = config_.nominal_dt_s;
  }

  Twist twist;
  if (!command_is_finite(input)) {
    output.status = Status::kInvalidInput;
  } else if (input.stale) {
    output.status = Status::kStale;
  } else {
    twist = limit_command(input, output);
  }
  Pose next;
  next.translation = bound_position(state_.set_point.translation + twist.linear * dt, input, dt, output);
  if (further != nullptr) {
    next.translation = within_further(next.translation, input, dt, *further, output);
  }
  next.rotation =
      bound_rotation(wanted_rotation(twist, next.translation, input.rcm, dt), input.measured_pose, dt, output);
  // Finite inputs of absurd size can still overflow.
  if (!is_valid(next)) {
    output.status = Status::kInvalidInput;
    return output;
  }
  state_.set_point = output.set_point = next;
  output.lead_m = (next.translation - measured).norm();
  const bool limited = output.speed_limited || output.approach_limited || output.lead_limited || output.cone_limited ||
                       output.insertion_limited || output.fixture_limited;
  if (output.status == Status::kOk && limited) {
    output.status = Status::kLimited;
  }
  return output;
}

Twist VelocityIntegrator::limit_command(const VelocityIntegratorInput& input, VelocityIntegratorOutput& output) const {
  const double scale = std::clamp(input.max_speed_scale, 0.0, 1.0);
  const double speed_limit = scale * config_.speed_limit_m_s;
  const double rate_limit = scale * config_.speed_limit_rad_s;
  output.speed_limited = input.twist.linear.norm() > speed_limit || input.twist.angular.norm() > rate_limit;
  Twist twist{clamp_norm(input.twist.linear, speed_limit), clamp_norm(input.twist.angular, rate_limit)};

  const double approach_limit = std::max(0.0, input.approach_speed_limit_m_s);
  const double length = input.approach_direction.norm();
  if (length == 0.0) {
    output.approach_limited = twist.linear.norm() > approach_limit;
    twist.linear = clamp_norm(twist.linear, approach_limit);
    return twist;
  }
  const Vector3 towards = input.approach_direction / length;
  const double excess = twist.linear.dot(towards) - approach_limit;
  if (excess > 0.0) {
    output.approach_limited = true;
    twist.linear -= excess * towards;
  }
  return twist;
}

Vector3 VelocityIntegrator::bound_position(const Vector3& wanted, const VelocityIntegratorInput& input, Seconds dt,
                                           VelocityIntegratorOutput& output) const {
  const Vector3 measured = input.measured_pose.translation;
  const auto within_lead = [&](const Vector3& position) -> Vector3 {
    output.lead_limited = output.lead_limited || (position - measured).norm() > config_.lead_limit_m;
    return measured + clamp_norm(position - measured, config_.lead_limit_m);
  };
  const Vector3 previous = state_.set_point.translation;
  const Vector3 bounded = within_lead(within_workspace(within_lead(wanted), input.rcm, output));
  return previous + clamp_norm(bounded - previous, config_.speed_limit_m_s * dt);
}

Vector3 VelocityIntegrator::within_further(const Vector3& wanted, const VelocityIntegratorInput& input, Seconds dt,
                                           PositionBound& further, VelocityIntegratorOutput& output) const {
  const Vector3 previous = state_.set_point.translation;
  const Vector3 measured = input.measured_pose.translation;
  const Vector3 towards = input.approach_direction.normalized();  // zero stays zero
  const double lead_limit = std::max(config_.lead_limit_m, (previous - measured).norm());
  const double approach_limit = std::max({0.0, input.approach_speed_limit_m_s * dt, towards.dot(wanted - previous)});
  Vector3 next = further.bound(previous, wanted);
  output.fixture_limited = next != wanted;
  // To slide along a wall must lead neither out of the workspace nor on what is near: to a place that all allow, where
  // turns find one.
  for (int turn = 0; output.fixture_limited; ++turn) {
    VelocityIntegratorOutput ignored;
    Vector3 inside = within_workspace(next, input.rcm, ignored);
    const double approach = towards.dot(inside - previous);
    if (approach > approach_limit) {
      inside = previous + approach_limit / approach * (inside - previous);
    }
    if ((inside - next).norm() <= kSame_m) {
      const bool keeps = (next - measured).norm() <= lead_limit + kSame_m &&
                         (next - previous).norm() <= config_.speed_limit_m_s * dt + kSame_m;
      return keeps ? next : previous;
    }
    if (turn == kTurns) {
      next = previous;
      break;
    }
    next = further.bound(previous, inside);
  }
  return next;
}

Vector3 VelocityIntegrator::within_workspace(const Vector3& wanted, const Vector3& rcm,
                                             VelocityIntegratorOutput& output) const {
  const Vector3 axis = config_.cone_axis.normalized();
  const Vector3 previous = state_.set_point.translation - rcm;
  // Where the set-point is outside already, its own place is the bound.
  const double half_angle = std::max(config_.cone_half_angle_rad, angle_between(axis, previous));
  const double insertion_min = std::min(config_.insertion_min_m, previous.norm());
  const double insertion_max = std::max(config_.insertion_max_m, previous.norm());

  Vector3 shaft = wanted - rcm;
  if (angle_between(axis, shaft) > half_angle) {
    output.cone_limited = true;
    const Vector3 across = shaft - axis * axis.dot(shaft);
    const Vector3 outward = across.norm() > 1e-9 ? Vector3(across.normalized()) : axis.unitOrthogonal();
    const Vector3 edge = std::cos(half_angle) * axis + std::sin(half_angle) * outward;
    shaft = edge * std::max(edge.dot(shaft), 0.0);
  }
  const double insertion = shaft.norm();
  if (insertion < insertion_min || insertion > insertion_max) {
    output.insertion_limited = true;
    const Vector3 direction = insertion > 1e-9 ? Vector3(shaft / insertion) : axis;
    shaft = direction * std::clamp(insertion, insertion_min, insertion_max);
  }
  return rcm + shaft;
}

Quaternion VelocityIntegrator::wanted_rotation(const Twist& twist, const Vector3& position, const Vector3& rcm,
                                               Seconds dt) const {
  const Quaternion previous = state_.set_point.rotation;
  const Vector3 shaft = position - rcm;
  if (!config_.shaft_through_rcm || shaft.norm() < 1e-6) {
    return (rotation_exp(twist.angular * dt) * previous).normalized();
  }
  // Pivoting goes first, because position prescribes it; roll gets what the rate limit leaves.
  const Vector3 z = previous * Vector3::UnitZ();
  const double pivot = angle_between(z, shaft);
  const double budget = config_.speed_limit_rad_s * dt;
  const double roll_limit = std::sqrt(std::max(0.0, budget * budget - pivot * pivot));
  const double roll = std::clamp(z.dot(twist.angular) * dt, -roll_limit, roll_limit);
  const Vector3 pivot_axis = z.cross(shaft);
  const Quaternion pivoting =
      pivot_axis.norm() > 1e-12 ? rotation_exp(pivot_axis.normalized() * pivot) : Quaternion::Identity();
  return (pivoting * rotation_exp(z * roll) * previous).normalized();
}

Quaternion VelocityIntegrator::bound_rotation(const Quaternion& wanted, const Pose& measured, Seconds dt,
                                              VelocityIntegratorOutput& output) const {
  const Quaternion bounded = rotate_toward(measured.rotation, wanted, config_.lead_limit_rad);
  output.lead_limited = output.lead_limited || bounded.coeffs() != wanted.coeffs();
  return rotate_toward(state_.set_point.rotation, bounded, config_.speed_limit_rad_s * dt).normalized();
}

}  // namespace saras
