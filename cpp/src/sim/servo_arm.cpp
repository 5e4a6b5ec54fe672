#include "saras/sim/servo_arm.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

double approach(double value, double target, double step) noexcept {
  return value + std::clamp(target - value, -step, step);
}

bool is_usable(const ServoArmInput& input) noexcept {
  return is_finite(input.target_tip) && std::isfinite(input.target_roll) && is_finite(input.rcm) &&
         is_finite(input.reaction_force) && std::isfinite(input.target_jaw) && input.roll_speed_max_rad_s > 0.0 &&
         input.jaw_speed_max_1_s > 0.0;
}

}  // namespace

void ServoArmConfig::validate() const {
  arm.validate();
  for (int joint = 0; joint < 6; ++joint) {
    validate::positive("natural_frequency_rad_s", natural_frequency_rad_s[joint]);
    validate::positive("damping_ratio", damping_ratio[joint]);
  }
  validate::positive("effective_mass_kg", effective_mass_kg);
  validate::positive("jaw_speed_max_1_s", jaw_speed_max_1_s);
  validate::not_negative("joint_resolution", joint_resolution);
  validate::not_negative("joint_noise", joint_noise);
  validate::positive("dt_max_s", dt_max_s);
}

Vector6 ServoArmConfig::initial_q() const {
  const Vector3 rcm = Eigen::Map<const Vector3>(mesa::kNominalRcm.data());
  const Vector6 elbow_out = (Vector6() << -1.0, 2.0, 0.0, 0.0, 0.1, 0.0).finished();
  return RcmArm(arm).inverse_pivot(rcm - Vector3(0.0, 0.0, 0.1), 0.0, rcm, elbow_out).value();
}

ServoArm::ServoArm(ServoArmConfig config) : config_(std::move(config)), kinematics_(config_.arm) {
  config_.validate();
  reset();
}

void ServoArm::reset() { reset(config_.initial_q()); }

void ServoArm::reset(const Vector6& q) {
  validate::finite("q", q);
  if (const Violation violation = kinematics_.check_limits(q)) {
    throw ConfigError("q: " + describe(violation));
  }
  state_ = {};
  state_.q = q;
  state_.q_target = q;
  state_.roll_reference = q[5];
  state_.noise = Random(config_.seed);
}

ServoArmOutput ServoArm::step(const ServoArmInput& input, Seconds dt) noexcept {
  ServoArmOutput output;
  if (!is_usable(input) || !is_valid_time_step(dt, config_.dt_max_s)) {
    output.status = is_usable(input) ? Status::kInvalidTimeStep : Status::kInvalidInput;
    const ServoArmState before = state_;
    fill(is_finite(input.rcm) ? input.rcm : Vector3(Vector3::Zero()), output);
    state_ = before;
    return output;
  }
  const bool reached = update_target(input, dt, output);
  const bool within_speed = move(disturbance(input), dt);
  output.status = reached && within_speed ? Status::kOk : Status::kLimited;
  fill(input.rcm, output);
  return output;
}

// False when the target is out of reach: the last one in reach stays.
bool ServoArm::update_target(const ServoArmInput& input, Seconds dt, ServoArmOutput& output) noexcept {
  const double roll_speed = std::min(input.roll_speed_max_rad_s, config_.arm.speed[5]);
  const double jaw_speed = std::min(input.jaw_speed_max_1_s, config_.jaw_speed_max_1_s);
  state_.jaw = approach(state_.jaw, std::clamp(input.target_jaw, 0.0, 1.0), jaw_speed * dt);
  const double roll_wanted = std::clamp(input.target_roll, config_.arm.lower[5], config_.arm.upper[5]);
  state_.roll_reference = approach(state_.roll_reference, roll_wanted, roll_speed * dt);
  const RcmSolution solution =
      input.mode == ArmMode::kPivot
          ? kinematics_.inverse_pivot(input.target_tip, state_.roll_reference, input.rcm, state_.q_target)
          : kinematics_.inverse_parallel(input.target_tip, state_.roll_reference, state_.q_target);
  output.violation = solution.violation;
  if (solution.ok()) {
    state_.q_target = solution.q;
  } else {
    state_.q_target[5] = state_.roll_reference;  // the roll joint reaches wherever the tip is
  }
  return solution.ok() && roll_wanted == input.target_roll;
}

// Joint accelerations of a force on the tip, as if the tip were a mass that can only move as the mode lets it.
Vector6 ServoArm::disturbance(const ServoArmInput& input) const noexcept {
  const Vector3 acceleration = input.reaction_force / config_.effective_mass_kg;
  if (input.mode == ArmMode::kPivot) {
    const auto pivot = kinematics_.pivot_jacobian(state_.q, input.rcm);
    return pivot ? Vector6(pivot->leftCols<3>() * acceleration) : Vector6(Vector6::Zero());
  }
  Vector6 tip_acceleration = Vector6::Zero();
  tip_acceleration.head<3>() = acceleration;
  const Eigen::PartialPivLU<Matrix6> jacobian(kinematics_.jacobian(state_.q));
  const Vector6 joints = jacobian.solve(tip_acceleration);
  return joints.allFinite() ? joints : Vector6(Vector6::Zero());
}

// False when a joint would have been too fast and all were slowed down.
bool ServoArm::move(const Vector6& disturbance, Seconds dt) noexcept {
  if (dt != cached_dt_) {
    for (int joint = 0; joint < 6; ++joint) {
      const double w = config_.natural_frequency_rad_s[joint];
      cached_joints_[static_cast<std::size_t>(joint)] =
          second_order_step(w * w, 2.0 * config_.damping_ratio[joint] * w, dt);
    }
    cached_dt_ = dt;
  }
  Vector6 moved;
  Vector6 rate;
  double scale = 1.0;
  for (int joint = 0; joint < 6; ++joint) {
    const SecondOrderStep& s = cached_joints_[static_cast<std::size_t>(joint)];
    const double error = state_.q[joint] - state_.q_target[joint];
    const double next = s.a_xx * error + s.a_xv * state_.q_rate[joint] + s.b_x * disturbance[joint];
    moved[joint] = next - error;
    rate[joint] = s.a_vx * error + s.a_vv * state_.q_rate[joint] + s.b_v * disturbance[joint];
    const double fastest = std::max(std::abs(rate[joint]), std::abs(moved[joint]) / dt);
    if (fastest > config_.arm.speed[joint]) {
      scale = std::min(scale, config_.arm.speed[joint] / fastest);
    }
  }
  state_.q += scale * moved;
  state_.q_rate = scale * rate;
  return scale == 1.0;
}

void ServoArm::fill(const Vector3& rcm, ServoArmOutput& output) noexcept {
  output.q = state_.q;
  output.q_rate = state_.q_rate;
  output.base_T_tip = kinematics_.forward(state_.q);
  output.tip_velocity = (kinematics_.jacobian(state_.q) * state_.q_rate).head<3>();
  output.measured_q = state_.q;
  for (int joint = 0; joint < 6; ++joint) {
    double& measured = output.measured_q[joint];
    if (config_.joint_noise[joint] > 0.0) {
      measured += config_.joint_noise[joint] * state_.noise.normal();
    }
    if (config_.joint_resolution[joint] > 0.0) {
      measured = std::round(measured / config_.joint_resolution[joint]) * config_.joint_resolution[joint];
    }
  }
  output.measured_base_T_tip = kinematics_.forward(output.measured_q);
  const Vector3 shaft = output.base_T_tip.rotation * Vector3::UnitZ();
  const Vector3 from_trocar = output.base_T_tip.translation - rcm;
  output.trocar_deviation = from_trocar - from_trocar.dot(shaft) * shaft;
  output.rcm_deviation_m = output.trocar_deviation.norm();
  output.jaw = state_.jaw;
}

}  // namespace saras
