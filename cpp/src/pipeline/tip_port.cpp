#include "saras/pipeline/tip_port.hpp"

#include "saras/spatial/rotation.hpp"

namespace saras {

TipPortOutput TipPort::step(bool known, bool is_new, const Pose& base_T_tip, const Wrench& wrench,
                            Seconds interval_s) noexcept {
  TipPortOutput output;
  if (!known) {
    state_ = {};
    return output;
  }
  if (!state_.has_last) {
    state_.has_last = true;
    state_.base_T_tip = base_T_tip;
    state_.wrench = wrench;
    return output;
  }
  if (is_new && interval_s > 0.0) {
    const Twist moved = displacement(state_.base_T_tip, base_T_tip);
    state_.mean_wrench.force = 0.5 * (state_.wrench.force + wrench.force);
    state_.mean_wrench.torque = 0.5 * (state_.wrench.torque + wrench.torque);
    state_.twist = {moved.linear / interval_s, moved.angular / interval_s};
    output.work_J = dot(state_.mean_wrench, moved);
    state_.base_T_tip = base_T_tip;
    state_.wrench = wrench;
    state_.is_live = true;
  }
  output.live = state_.is_live;
  output.mean_wrench = state_.mean_wrench;
  output.twist = state_.twist;
  return output;
}

}  // namespace saras
