#include "saras/console/port_guard.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {

void PortGuardConfig::validate() const {
  tank.validate();
  validate::positive("force_ramp_s", force_ramp_s);
  validate::pose("touch_R_simball", Pose{touch_R_simball, Vector3::Zero()});
}

PortGuard::PortGuard(PortGuardConfig config) : config_((config.validate(), config)), tank_(config.tank, 1) { reset(); }

PortGuardOutput PortGuard::step(const PortGuardInput& input, Seconds dt) noexcept {
  const bool usable = input.has_pose && is_valid(input.simball_T_handle);
  const double towards = input.active && is_finite(input.wrench) ? 1.0 : 0.0;
  const double elapsed = std::isfinite(dt) && dt > 0.0 ? dt / config_.force_ramp_s : 0.0;
  // After a stall the force may be gone at once, but it comes back step by step.
  state_.ramp = towards > state_.ramp
                    ? std::min(towards, state_.ramp + std::min(elapsed, config_.tank.dt_max_s / config_.force_ramp_s))
                    : std::max(towards, state_.ramp - elapsed);

  EnergyTankInput tank;
  tank.desired.setZero(6, 1);
  tank.conjugate.setZero(6, 1);
  tank.measured.resize(6, 0);
  if (is_finite(input.wrench)) {
    tank.desired.col(0) = state_.ramp * to_vector(input.wrench);
  }
  if (usable && state_.has_previous && dt > 0.0) {
    const Twist moved = displacement(state_.simball_T_previous, input.simball_T_handle);
    tank.conjugate.col(0) = to_vector(config_.touch_R_simball * moved) / dt;
  }
  tank.conjugate_stale = !usable;
  tank.has_work = true;
  tank.work_J = input.work_J - state_.billed_J;
  tank.received_J = input.received_J;
  tank.requesting_peers = input.peer_requests ? 1 : 0;
  tank.peer_has_room = input.peer_has_room;

  PortGuardOutput output;
  output.tank = tank_.step(tank, dt);
  output.applied = to_wrench(output.tank.applied.col(0));
  output.status = output.tank.status;
  state_.tank = tank_.state();
  state_.has_previous = usable;
  if (usable) {
    state_.simball_T_previous = input.simball_T_handle;
  }
  if (std::isfinite(input.work_J)) {
    state_.billed_J = input.work_J;
  }
  return output;
}

void PortGuard::grant() {
  tank_.grant(std::max(0.0, config_.tank.initial_J - tank_.state().energy_J));
  state_.tank = tank_.state();
}

void PortGuard::reset() {
  tank_.reset();
  state_ = {};
  state_.tank = tank_.state();
}

void PortGuard::reset(const PortGuardState& state) {
  tank_.reset(state.tank);
  state_ = state;
}

}  // namespace saras
