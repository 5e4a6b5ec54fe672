#include "saras/console/simulated_handle.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

OperatorConfig hand_around(const SimulatedHandleConfig& config) {
  OperatorConfig hand = config.hand;
  hand.workspace_centre_m = SimballHandle(config.simball).forward(config.home_joints).translation;
  hand.workspace_radius_m = config.workspace_radius_m;
  return hand;
}

}  // namespace

void SimulatedHandleConfig::validate() const {
  simball.validate();
  hand.validate();
  SimballHandle(simball).check_limits(home_joints);
  validate::pose("touch_R_simball", Pose{touch_R_simball, Vector3::Zero()});
  validate::in_range("workspace_radius_m", workspace_radius_m, 0.001, home_joints[3]);
  validate::positive("watchdog_s", watchdog_s);
  validate::in_range("stall_max_s", stall_max_s, watchdog_s, hand.dt_max_s);
}

SimulatedHandle::SimulatedHandle(SimulatedHandleConfig config)
    : config_((config.validate(), config)),
      simball_(config_.simball),
      simball_T_home_(simball_.forward(config_.home_joints)),
      hand_(hand_around(config_)) {
  reset();
}

SimulatedHandleOutput SimulatedHandle::step(const SimulatedHandleInput& input, Seconds dt) noexcept {
  SimulatedHandleOutput output;
  OperatorInput intent;
  intent.intended_position = simball_T_home_ * input.intended_offset;
  intent.intended_velocity = simball_T_home_.rotation * input.intended_velocity;
  intent.intended_roll = input.intended_roll;
  const Vector3 force = config_.touch_R_simball.conjugate() * input.wrench.force;

  const bool usable = is_valid_time_step(dt, std::numeric_limits<double>::max()) && is_finite(force);
  const Seconds simulated = usable ? std::min(dt, config_.stall_max_s) : 0.0;
  const Seconds forced = std::min(simulated, config_.watchdog_s);
  for (const auto& [push, duration] :
       {std::pair<Vector3, Seconds>{force, forced}, {Vector3::Zero(), simulated - forced}}) {
    if (duration <= 0.0) {
      continue;
    }
    intent.force = push;
    const Vector3 before = hand_.state().position;
    output.status = hand_.step(intent, duration).status;
    state_.work_J += push.dot(hand_.state().position - before);
  }
  if (!usable) {
    output.status = is_finite(force) ? Status::kInvalidTimeStep : Status::kInvalidInput;
  }
  state_.hand = hand_.state();
  const auto joints = simball_.inverse(state_.hand.position, state_.hand.roll);
  output.valid = joints.has_value();
  output.joints = joints.value_or(Vector4::Zero());
  output.work_J = state_.work_J;
  return output;
}

void SimulatedHandle::reset() {
  OperatorState hand;
  hand.position = simball_T_home_.translation;
  hand.roll = config_.home_joints[2];
  reset({hand, 0.0});
}

void SimulatedHandle::reset(const SimulatedHandleState& state) {
  hand_.reset(state.hand);
  state_ = state;
}

}  // namespace saras
