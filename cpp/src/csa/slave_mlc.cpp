#include "saras/csa/slave_mlc.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/clamp_norm.hpp"
#include "saras/spatial/low_pass.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::csa {
namespace {

SlaveMlcConfig validated(SlaveMlcConfig config) {
  config.validate();
  return config;
}

/// Turns a unit vector towards another one by at most an angle; opposite ones about any perpendicular axis.
Vector3 turn_toward(const Vector3& from, const Vector3& to, double angle_limit) {
  const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
  if (angle <= angle_limit) {
    return to;
  }
  Vector3 axis = from.cross(to);
  axis = axis.norm() > 1e-9 ? axis.normalized() : from.unitOrthogonal();
  return (Eigen::AngleAxisd(angle_limit, axis) * from).normalized();
}

constexpr double kLargestAmplitude = 0.95;  // of F_d: palpation never lets go

}  // namespace

void SlaveMlcConfig::validate() const {
  motion.validate();
  validate::positive("admittance_m_Ns", admittance_m_Ns);
  validate::positive("stiffness_min_N_m", stiffness_min_N_m);
  validate::less("stiffness_min_N_m", stiffness_min_N_m, "stiffness_max_N_m", stiffness_max_N_m);
  validate::positive("period_s", period_s);
  validate::not_negative("arm_lag_s", arm_lag_s);
  validate::not_negative("sensor_lag_s", sensor_lag_s);
  validate::in_range("stability_margin", stability_margin, 0.01, 0.5);
  if (!scheduled) {
    const double lag = period_s + arm_lag_s + sensor_lag_s;
    validate::in_range("admittance_m_Ns", admittance_m_Ns, 0.0, stability_margin / (stiffness_max_N_m * lag));
  }
  validate::positive("approach_speed_m_s", approach_speed_m_s);
  validate::positive("speed_limit_m_s", speed_limit_m_s);
  validate::positive("rotation_speed_limit_rad_s", rotation_speed_limit_rad_s);
  validate::positive("force_cutoff_hz", force_cutoff_hz);
  validate::positive("normal_cutoff_hz", normal_cutoff_hz);
  validate::positive("normal_force_min_N", normal_force_min_N);
  validate::positive("normal_rate_rad_s", normal_rate_rad_s);
  validate::positive("force_cap_N", force_cap_N);
  validate::less("force_cap_N", force_cap_N, "force_range_N", force_range_N);
}

SlaveMlc::SlaveMlc(SlaveMlcConfig config) : config_(validated(std::move(config))), motion_(config_.motion) {}

double SlaveMlc::admittance(double stiffness_N_m) const noexcept {
  if (!config_.scheduled) {
    return config_.admittance_m_Ns;
  }
  const double known = std::isfinite(stiffness_N_m) ? stiffness_N_m : config_.stiffness_max_N_m;
  const double stiffness = std::clamp(known, config_.stiffness_min_N_m, config_.stiffness_max_N_m);
  const double lag = config_.period_s + config_.arm_lag_s + config_.sensor_lag_s;
  return std::min(config_.admittance_m_Ns, config_.stability_margin / (stiffness * lag));
}

bool SlaveMlc::saturated(const SlaveMlcInput& input) const noexcept {
  return (input.tissue_wrench.force.array().abs() >= config_.force_range_N).any();
}

bool SlaveMlc::take_force(const SlaveMlcInput& input, Seconds dt) noexcept {
  if (!input.force_known || !is_finite(input.tissue_wrench) || saturated(input)) {
    state_.has_force = false;  // a force that comes back begins anew
    return false;
  }
  const Vector3 reaction = -input.tissue_wrench.force;
  if (!state_.has_force) {
    state_.has_force = true;
    state_.force = reaction;
    state_.normal_force = reaction;
  }
  state_.force += low_pass_gain(config_.force_cutoff_hz, dt) * (reaction - state_.force);
  state_.normal_force += low_pass_gain(config_.normal_cutoff_hz, dt) * (reaction - state_.normal_force);
  return true;
}

bool SlaveMlc::take_normal(const SlaveMlcInput& input, Seconds dt) noexcept {
  Vector3 wanted = state_.normal;
  bool known = state_.has_normal;
  if (input.normal.norm() > 0.5) {
    wanted = input.normal.normalized();
    known = true;
  } else if (state_.normal_force.norm() >= config_.normal_force_min_N) {
    wanted = state_.normal_force.normalized();
    known = true;
  }
  state_.normal = state_.has_normal ? turn_toward(state_.normal, wanted, config_.normal_rate_rad_s * dt) : wanted;
  state_.has_normal = known;
  return known;
}

Twist pursuit(const Pose& pose, const Pose& desired, double speed_limit_m_s, double rotation_speed_limit_rad_s,
              Seconds dt) noexcept {
  const Twist moved = displacement(pose, desired);
  return {clamp_norm(moved.linear / dt, speed_limit_m_s), clamp_norm(moved.angular / dt, rotation_speed_limit_rad_s)};
}

Twist SlaveMlc::position_twist(const SlaveMlcInput& input, Seconds dt) const noexcept {
  const double speed = config_.speed_limit_m_s;
  const double rotation_speed = config_.rotation_speed_limit_rad_s;
  if (input.mode != SlaveMode::kHybrid) {
    return pursuit(input.pose, input.desired, speed, rotation_speed, dt);
  }
  // Project first: what is wanted along the normal must not use up the speed across it.
  const Vector3& n = state_.normal;
  Pose across = input.desired;
  across.translation -= n * n.dot(input.desired.translation - input.pose.translation);
  return pursuit(input.pose, across, speed, rotation_speed, dt);
}

double SlaveMlc::normal_speed(const SlaveMlcInput& input, Seconds dt, SlaveMlcOutput& output) noexcept {
  const double approach = config_.approach_speed_m_s;
  const double frequency = std::clamp(input.palpation.frequency_hz, 0.0, 0.25 / config_.period_s);
  const bool palpates = input.palpation.kind != PalpationKind::kNone && input.palpation.amplitude > 0.0;
  const double phase = palpates ? std::fmod(state_.phase_rad + 2.0 * M_PI * frequency * dt, 2.0 * M_PI) : 0.0;
  const double wave = std::sin(phase);
  const double wave_before = std::sin(state_.phase_rad);
  state_.phase_rad = phase;
  if (palpates && input.palpation.kind == PalpationKind::kMotion) {
    if (!state_.palpating_motion) {
      state_.palpating_motion = true;
      state_.anchor_m = 0.0;
    }
    // Still to go along n. Kept as a remainder, so that the surface's turning does not move the mean.
    state_.anchor_m += input.palpation.amplitude * (wave - wave_before);
    double speed = std::clamp(state_.anchor_m / dt, -approach, approach);
    if (output.normal_force_N >= config_.force_cap_N) {
      speed = std::max(speed, 0.0);
      output.motion.reason = MotionReason::kForceCap;
    }
    state_.anchor_m -= speed * dt;
    output.desired_force_N = std::numeric_limits<double>::quiet_NaN();
    return speed;
  }
  state_.palpating_motion = false;
  double desired = std::clamp(input.desired_force_N, 0.0, config_.force_cap_N);
  if (palpates) {
    desired += std::min(input.palpation.amplitude, kLargestAmplitude * desired) * wave;
  }
  desired = std::clamp(desired, 0.0, config_.force_cap_N);
  output.desired_force_N = desired;
  return std::clamp(output.admittance_m_Ns * (output.normal_force_N - desired), -approach, approach);
}

SlaveMlcOutput SlaveMlc::step(const SlaveMlcInput& input, Seconds dt) noexcept {
  SlaveMlcOutput output;
  const auto hold = [&](MotionReason reason, Status status) {
    output.motion.q = input.q;
    output.motion.rates = JointVector::Zero(motion_.joints());
    output.motion.twist = {};
    output.motion.reason = reason;
    output.motion.status = output.status = status;
    return output;
  };
  if (!is_valid_time_step(dt, config_.motion.dt_max_s)) {
    return hold(MotionReason::kInvalidTimeStep, Status::kInvalidTimeStep);
  }
  if (!is_valid(input.pose) || !is_valid(input.desired) || !std::isfinite(input.desired_force_N) ||
      !input.normal.allFinite() || !std::isfinite(input.palpation.amplitude) || input.palpation.amplitude < 0.0 ||
      !std::isfinite(input.palpation.frequency_hz)) {
    return hold(MotionReason::kInvalidInput, Status::kInvalidInput);
  }
  if (input.stale) {
    return hold(MotionReason::kStale, Status::kStale);
  }
  const bool force_known = take_force(input, dt);
  if (input.mode != SlaveMode::kPosition) {
    if (input.force_known && saturated(input)) {
      return hold(MotionReason::kForceSaturated, Status::kInvalidInput);
    }
    if (!force_known) {
      return hold(MotionReason::kForceUnknown, Status::kStale);
    }
  }
  output.admittance_m_Ns = admittance(input.stiffness_N_m);
  MotionReason reason = MotionReason::kNone;
  ConstrainedMotionInput motion;
  motion.q = input.q;
  motion.q_measured = input.q_measured;
  motion.jacobian = input.jacobian;
  motion.rows = input.rows;
  if (input.mode == SlaveMode::kHybrid) {
    if (!take_normal(input, dt)) {
      return hold(MotionReason::kNormalUnknown, Status::kWaiting);
    }
    output.normal = state_.normal;
    output.normal_force_N = state_.force.dot(state_.normal);
    const double speed = normal_speed(input, dt, output);
    reason = output.motion.reason;
    motion.twist = position_twist(input, dt);
    motion.twist.linear += speed * state_.normal;
    motion.first = state_.normal;
  } else {
    state_.has_normal = false;
    state_.palpating_motion = false;
    state_.phase_rad = 0.0;
    motion.twist = position_twist(input, dt);
    if (input.mode == SlaveMode::kAdmittance) {
      motion.twist.linear += clamp_norm(output.admittance_m_Ns * state_.force, config_.approach_speed_m_s);
      output.normal_force_N = state_.force.norm();
    }
  }
  output.motion = motion_.step(motion, dt);
  if (output.motion.reason == MotionReason::kNone && reason != MotionReason::kNone) {
    output.motion.reason = reason;
    output.motion.status = Status::kLimited;
  }
  output.status = output.motion.status;
  return output;
}

ProxySlave::ProxySlave(ConstrainedMotionConfig config, double speed_limit_m_s, double rotation_speed_limit_rad_s)
    : motion_(std::move(config)),
      speed_limit_m_s_(speed_limit_m_s),
      rotation_speed_limit_rad_s_(rotation_speed_limit_rad_s) {
  validate::positive("speed_limit_m_s", speed_limit_m_s);
  validate::positive("rotation_speed_limit_rad_s", rotation_speed_limit_rad_s);
}

ConstrainedMotionOutput ProxySlave::step(const ConstrainedMotionInput& at, const Pose& pose, const Pose& desired,
                                         Seconds dt) noexcept {
  ConstrainedMotionInput input = at;
  input.twist.linear.setConstant(std::numeric_limits<double>::quiet_NaN());  // a bad pose is a hold
  if (is_valid(pose) && is_valid(desired) && is_valid_time_step(dt, motion_.config().dt_max_s)) {
    input.twist = pursuit(pose, desired, speed_limit_m_s_, rotation_speed_limit_rad_s_, dt);
  }
  return motion_.step(input, dt);
}

}  // namespace saras::csa
