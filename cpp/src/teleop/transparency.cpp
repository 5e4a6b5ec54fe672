#include "saras/teleop/transparency.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/clamp_norm.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

/// clamp_norm that notes whether it acted.
Vector3 limit(const Vector3& v, double bound, bool& limited) {
  limited = limited || v.norm() > bound;
  return clamp_norm(v, bound);
}

}  // namespace

void TransparencyConfig::validate() const {
  validate::positive("scale", scale);
  validate::in_range("scale", scale, 0.0, 10.0);
  validate::not_negative("stiffness_N_m", stiffness_N_m);
  validate::not_negative("damping_N_s_m", damping_N_s_m);
  validate::not_negative("rotation_stiffness_Nm_rad", rotation_stiffness_Nm_rad);
  validate::not_negative("rotation_damping_Nm_s_rad", rotation_damping_Nm_s_rad);
  validate::not_negative("force_scale", force_scale);
  validate::not_negative("torque_scale", torque_scale);
  validate::positive("force_limit_N", force_limit_N);
  validate::not_negative("torque_limit_Nm", torque_limit_Nm);
  validate::positive("ramp_s", ramp_s);
  validate::not_negative("drift_gain_1_s", drift_gain_1_s);
  validate::not_negative("drift_limit_m_s", drift_limit_m_s);
  validate::not_negative("slave_lag_s", slave_lag_s);
  validate::not_negative("rotation_drift_gain_1_s", rotation_drift_gain_1_s);
  validate::not_negative("rotation_drift_limit_rad_s", rotation_drift_limit_rad_s);
  validate::positive("pivot_radius_min_m", pivot_radius_min_m);
  validate::positive("dt_max_s", dt_max_s);
}

Transparency::Transparency(TransparencyConfig config) : config_(config) { config_.validate(); }

TransparencyOutput Transparency::step(const TransparencyInput& input, Seconds dt) noexcept {
  TransparencyOutput output;
  const bool valid = is_valid(input.master_pose) && is_valid(input.slave_pose) && is_finite(input.master_twist) &&
                     is_finite(input.slave_twist) && is_finite(input.master_twist_filtered.value_or(Twist{})) &&
                     (!config_.pivoted || is_finite(input.rcm));
  if (!state_.has_reference) {
    if (valid && !input.stale) {
      take_reference(input);
    }
    output.status = Status::kWaiting;
    return output;
  }
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    state_.ramp = 0.0;
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  if (!valid || input.stale) {
    output.desired_wrench = fade_out(dt);
    output.status = valid ? Status::kStale : Status::kInvalidInput;
    return output;
  }
  if (input.clutch) {
    output.desired_wrench = fade_out(dt);
    take_reference(input);
    return output;
  }

  bool limited = false;
  const Vector6 error = this->error(input);
  const Vector3 lagged_master = lag(input, dt);
  const Vector3 drift = input.slave_pose.translation - state_.slave_reference.translation - lagged_master;
  const Twist twist = twist_of_slave(input, error, drift, limited);
  // Finite inputs of absurd size can still overflow.
  if (!error.allFinite() || !is_finite(twist)) {
    output.desired_wrench = fade_out(dt);
    output.status = Status::kInvalidInput;
    return output;
  }
  state_.lagged_master = lagged_master;
  output.error = error;
  output.desired_twist = twist;

  const Wrench wrench = wrench_on_hand(input, error, limited);
  if (!is_finite(wrench)) {
    output.desired_wrench = fade_out(dt);
    output.status = Status::kInvalidInput;
    return output;
  }
  state_.wrench = wrench;
  state_.ramp = std::min(1.0, state_.ramp + dt / config_.ramp_s);
  output.desired_wrench = {state_.ramp * wrench.force, state_.ramp * wrench.torque};
  output.status = limited ? Status::kLimited : Status::kOk;
  return output;
}

Vector6 Transparency::error(const TransparencyInput& input) const {
  const Vector3 slave_moved = input.slave_pose.translation - state_.slave_reference.translation;
  const Vector3 master_moved = input.master_pose.translation - state_.master_reference.translation;
  const Quaternion slave_turned = input.slave_pose.rotation * state_.slave_reference.rotation.conjugate();
  const Quaternion master_turned = input.master_pose.rotation * state_.master_reference.rotation.conjugate();
  Vector6 error;
  error << slave_moved - config_.scale * master_moved, rotation_log(slave_turned * master_turned.conjugate());
  return error;
}

Wrench Transparency::wrench_on_hand(const TransparencyInput& input, const Vector6& error, bool& limited) const {
  Wrench wrench;
  if (config_.mode != TransparencyMode::kPositionForce) {
    const Twist master = input.master_twist_filtered.value_or(input.master_twist);
    const Vector3 velocity_error = input.slave_twist.linear - config_.scale * master.linear;
    const Vector3 angular_error = input.slave_twist.angular - master.angular;
    wrench.force += config_.stiffness_N_m * error.head<3>() + config_.damping_N_s_m * velocity_error;
    wrench.torque +=
        config_.rotation_stiffness_Nm_rad * error.tail<3>() + config_.rotation_damping_Nm_s_rad * angular_error;
  }
  if (config_.mode != TransparencyMode::kPositionPosition) {
    wrench.force -= config_.force_scale * input.tissue_wrench.force;
    wrench.torque -= config_.torque_scale * input.tissue_wrench.torque;
  }
  wrench.force += input.guidance_wrench.force;
  wrench.torque += input.guidance_wrench.torque;
  return {limit(wrench.force, config_.force_limit_N, limited), limit(wrench.torque, config_.torque_limit_Nm, limited)};
}

Vector3 Transparency::lag(const TransparencyInput& input, Seconds dt) const {
  Vector3 moved = config_.scale * (input.master_pose.translation - state_.master_reference.translation);
  if (config_.slave_lag_s == 0.0) {
    return moved;
  }
  const double gain = 1.0 - std::exp(-dt / config_.slave_lag_s);
  return state_.lagged_master + gain * (moved - state_.lagged_master);
}

Twist Transparency::twist_of_slave(const TransparencyInput& input, const Vector6& error, const Vector3& drift,
                                   bool& limited) const {
  Twist twist;
  twist.linear = config_.scale * input.master_twist.linear -
                 limit(config_.drift_gain_1_s * drift, config_.drift_limit_m_s, limited);
  twist.angular = input.master_twist.angular -
                  limit(config_.rotation_drift_gain_1_s * error.tail<3>(), config_.rotation_drift_limit_rad_s, limited);
  return config_.pivoted ? project_on_pivot(twist, input.slave_pose, input.rcm, config_.pivot_radius_min_m) : twist;
}

Wrench Transparency::fade_out(Seconds dt) {
  state_.ramp = std::max(0.0, state_.ramp - dt / config_.ramp_s);
  return {state_.ramp * state_.wrench.force, state_.ramp * state_.wrench.torque};
}

void Transparency::take_reference(const TransparencyInput& input) {
  state_.has_reference = true;
  state_.master_reference = input.master_pose;
  state_.slave_reference = input.slave_pose;
  state_.lagged_master.setZero();
}

Twist project_on_pivot(const Twist& tip_twist, const Pose& base_T_tip, const Vector3& rcm, double radius_min) {
  const Vector3 rcm_to_tip = base_T_tip.translation - rcm;
  const double radius = rcm_to_tip.norm();
  // With the tip in the trocar the shaft is known from the tool only: its z axis.
  const Vector3 shaft = radius > 1e-6 ? Vector3(rcm_to_tip / radius) : base_T_tip.rotation * Vector3::UnitZ();
  const Vector3 pivoting = shaft.cross(tip_twist.linear) / std::max(radius, radius_min);
  return {tip_twist.linear, pivoting + shaft * shaft.dot(tip_twist.angular)};
}

}  // namespace saras
