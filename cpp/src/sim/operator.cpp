#include "saras/sim/operator.hpp"

#include "saras/spatial/validate.hpp"

namespace saras {

void OperatorConfig::validate() const {
  validate::not_negative("stiffness_N_m", stiffness_N_m);
  validate::finite("damping_N_s_m", damping_N_s_m);
  validate::positive("hand_mass_kg", hand_mass_kg);
  validate::not_negative("handle_mass_kg", handle_mass_kg);
  validate::not_negative("roll_stiffness_N_m_rad", roll_stiffness_N_m_rad);
  validate::finite("roll_damping_N_m_s_rad", roll_damping_N_m_s_rad);
  validate::positive("roll_inertia_kg_m2", roll_inertia_kg_m2);
  validate::finite("workspace_centre_m", workspace_centre_m);
  validate::positive("workspace_radius_m", workspace_radius_m);
  validate::positive("speed_max_m_s", speed_max_m_s);
  validate::positive("dt_max_s", dt_max_s);
}

OperatorConfig OperatorConfig::firm() {
  OperatorConfig config;
  config.stiffness_N_m = 400.0;
  config.damping_N_s_m = 15.0;
  config.hand_mass_kg = 0.8;
  return config;
}

OperatorConfig OperatorConfig::weak() {
  OperatorConfig config;
  config.stiffness_N_m = 50.0;
  config.damping_N_s_m = 1.0;
  config.hand_mass_kg = 0.15;
  return config;
}

OperatorConfig OperatorConfig::active() {
  OperatorConfig config = weak();
  config.damping_N_s_m = -1.0;
  return config;
}

Operator::Operator(OperatorConfig config) : config_(config) { config_.validate(); }

OperatorOutput Operator::step(const OperatorInput& input, Seconds dt) noexcept {
  OperatorOutput output{state_.position, Vector3::Zero(), state_.roll, 0.0, Status::kOk};
  if (!is_finite(input.force) || !std::isfinite(input.roll_torque) || !is_finite(input.intended_position) ||
      !is_finite(input.intended_velocity) || !std::isfinite(input.intended_roll)) {
    output.status = Status::kInvalidInput;
    return output;
  }
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  const double mass = config_.hand_mass_kg + config_.handle_mass_kg;
  const double inertia = config_.roll_inertia_kg_m2;
  if (dt != cached_dt_) {
    cached_translation_ = second_order_step(config_.stiffness_N_m / mass, config_.damping_N_s_m / mass, dt);
    cached_roll_ =
        second_order_step(config_.roll_stiffness_N_m_rad / inertia, config_.roll_damping_N_m_s_rad / inertia, dt);
    cached_dt_ = dt;
  }
  const SecondOrderStep& t = cached_translation_;
  const Vector3 drive = (config_.stiffness_N_m * input.intended_position +
                         config_.damping_N_s_m * input.intended_velocity + input.force) /
                        mass;
  const Vector3 position = t.a_xx * state_.position + t.a_xv * state_.velocity + t.b_x * drive;
  Vector3 velocity = t.a_vx * state_.position + t.a_vv * state_.velocity + t.b_v * drive;

  Vector3 moved = position - state_.position;
  if (velocity.norm() > config_.speed_max_m_s) {
    velocity *= config_.speed_max_m_s / velocity.norm();
    output.status = Status::kLimited;
  }
  if (moved.norm() > config_.speed_max_m_s * dt) {
    moved *= config_.speed_max_m_s * dt / moved.norm();
    output.status = Status::kLimited;
  }
  Vector3 from_centre = state_.position + moved - config_.workspace_centre_m;
  if (from_centre.norm() > config_.workspace_radius_m) {
    const Vector3 outward = from_centre.normalized();
    from_centre = config_.workspace_radius_m * outward;
    velocity -= std::max(0.0, velocity.dot(outward)) * outward;
    output.status = Status::kLimited;
  }
  state_.position = config_.workspace_centre_m + from_centre;
  state_.velocity = velocity;

  const SecondOrderStep& r = cached_roll_;
  const double roll_drive = (config_.roll_stiffness_N_m_rad * input.intended_roll + input.roll_torque) / inertia;
  const double roll = r.a_xx * state_.roll + r.a_xv * state_.roll_rate + r.b_x * roll_drive;
  state_.roll_rate = r.a_vx * state_.roll + r.a_vv * state_.roll_rate + r.b_v * roll_drive;
  state_.roll = roll;

  output.position = state_.position;
  output.velocity = state_.velocity;
  output.roll = state_.roll;
  output.roll_rate = state_.roll_rate;
  return output;
}

}  // namespace saras
