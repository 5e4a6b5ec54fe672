#include "saras/sim/tissue.hpp"

#include <algorithm>

#include "saras/spatial/validate.hpp"

namespace saras {

void TissueConfig::validate() const {
  validate::pose("base_T_surface", base_T_surface);
  validate::in_range("curvature_1_m", curvature_1_m, -20.0, 20.0);
  validate::positive("stiffness_N_m", stiffness_N_m);
  validate::positive("inclusion_stiffness_N_m", inclusion_stiffness_N_m);
  validate::finite("inclusion_x_m", inclusion_x_m);
  validate::finite("inclusion_y_m", inclusion_y_m);
  validate::positive("inclusion_radius_m", inclusion_radius_m);
  validate::in_range("exponent", exponent, 1.0, 3.0);
  validate::not_negative("damping_N_s_m2", damping_N_s_m2);
  validate::not_negative("friction", friction);
  validate::positive("friction_speed_m_s", friction_speed_m_s);
  validate::not_negative("skin_stiffness_N_m", skin_stiffness_N_m);
  validate::not_negative("force_noise_N", force_noise_N);
}

Tissue::Tissue(TissueConfig config) : config_(std::move(config)) {
  config_.validate();
  reset();
}

TissueOutput Tissue::step(const TissueInput& input, Seconds dt) noexcept {
  TissueOutput output;
  if (!is_finite(input.tip_position) || !is_finite(input.tip_velocity) || !is_finite(input.trocar_deviation)) {
    output.status = Status::kInvalidInput;
    return output;
  }
  if (!is_valid_time_step(dt, 1e9)) {
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  const Quaternion& base_R_surface = config_.base_T_surface.rotation;
  const Vector3 tip = config_.base_T_surface.inverse() * input.tip_position;
  const Vector3 velocity = base_R_surface.conjugate() * input.tip_velocity;

  // Distance to a sphere of radius 1/curvature through the origin, written so that curvature 0 is the plane z = 0.
  const Vector3 outward = config_.curvature_1_m * tip + Vector3::UnitZ();
  const Vector3 normal = outward.normalized();
  const double depth = -(config_.curvature_1_m * tip.squaredNorm() + 2.0 * tip.z()) / (outward.norm() + 1.0);

  const Vector3 from_inclusion(tip.x() - config_.inclusion_x_m, tip.y() - config_.inclusion_y_m, 0.0);
  const double variance = config_.inclusion_radius_m * config_.inclusion_radius_m;
  const double extra = (config_.inclusion_stiffness_N_m - config_.stiffness_N_m) *
                       std::exp(-0.5 * from_inclusion.squaredNorm() / variance);
  const double stiffness = config_.stiffness_N_m + extra;
  const Vector3 stiffness_gradient = -extra / variance * from_inclusion;

  output.normal = base_R_surface * normal;
  output.depth = depth;
  output.stiffness = stiffness;
  output.contact = depth > 0.0;
  output.skin_force = config_.skin_stiffness_N_m * input.trocar_deviation;
  if (output.contact) {
    const double power_n = std::pow(depth, config_.exponent);
    const double per_stiffness = power_n * depth / (config_.exponent + 1.0);  // U / K
    output.stored_energy_J = stiffness * per_stiffness;
    const Vector3 energy_gradient = per_stiffness * stiffness_gradient - stiffness * power_n * normal;
    const double closing_speed = energy_gradient.dot(velocity) / (stiffness * power_n);
    const double damping = config_.damping_N_s_m2 / config_.stiffness_N_m * closing_speed;
    Vector3 reaction = -energy_gradient * std::max(0.0, 1.0 + damping);
    const Vector3 sliding = velocity - velocity.dot(normal) * normal;
    const double pressing = std::max(0.0, reaction.dot(normal));
    reaction -= config_.friction * pressing * sliding / std::hypot(sliding.norm(), config_.friction_speed_m_s);
    output.wrench.force = -(base_R_surface * reaction);
  }
  output.measured_wrench = output.wrench;
  if (config_.force_noise_N > 0.0) {
    for (int axis = 0; axis < 3; ++axis) {
      output.measured_wrench.force[axis] += config_.force_noise_N * state_.noise.normal();
    }
  }
  return output;
}

}  // namespace saras
