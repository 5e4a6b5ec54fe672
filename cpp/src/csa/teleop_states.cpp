#include "saras/csa/teleop_states.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/clamp_norm.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::csa {

const char* to_string(ContactState state) noexcept {
  switch (state) {
    case ContactState::kNoContact:
      return "NO_CONTACT";
    case ContactState::kProxyContact:
      return "PROXY_CONTACT";
    case ContactState::kSlaveContact:
      return "SLAVE_CONTACT";
    case ContactState::kFullContact:
      return "FULL_CONTACT";
  }
  return "UNKNOWN";
}

ContactTransition contact_transition(ContactState from, bool slave_contact, bool proxy_contact) noexcept {
  if (slave_contact && proxy_contact) {
    return {ContactState::kFullContact, true, SlaveMode::kHybrid, Synchronisation::kNever};
  }
  if (proxy_contact) {
    return {ContactState::kProxyContact, true, SlaveMode::kHybrid, Synchronisation::kNever};
  }
  if (slave_contact) {
    return {ContactState::kSlaveContact, false, SlaveMode::kAdmittance, Synchronisation::kNever};
  }
  Synchronisation synchronise = Synchronisation::kNever;
  if (from == ContactState::kProxyContact || from == ContactState::kSlaveContact) {
    synchronise = Synchronisation::kAlways;
  } else if (from == ContactState::kFullContact) {
    synchronise = Synchronisation::kWhenMismatched;
  }
  return {ContactState::kNoContact, false, SlaveMode::kPosition, synchronise};
}

void ContactDetector::update(double signal, double on, double off, Seconds debounce_s, Seconds dt) noexcept {
  const bool otherwise = contact ? signal <= off : signal >= on;
  pending_s = otherwise ? pending_s + dt : 0.0;
  if (otherwise && pending_s >= debounce_s - 1e-12) {
    contact = !contact;
    pending_s = 0.0;
  }
}

void CsaTeleopConfig::validate() const {
  validate::positive("scale", scale);
  validate::in_range("scale", scale, 0.0, 10.0);
  validate::positive("contact_off_N", contact_off_N);
  validate::less("contact_off_N", contact_off_N, "contact_on_N", contact_on_N);
  validate::less("proxy_off_m", proxy_off_m, "proxy_on_m", proxy_on_m);
  validate::not_negative("debounce_s", debounce_s);
  validate::positive("stiffness_N_m", stiffness_N_m);
  validate::positive("desired_force_N", desired_force_N);
  validate::positive("force_cap_N", force_cap_N);
  validate::in_range("desired_force_N", desired_force_N, 0.0, force_cap_N);
  validate::not_negative("mismatch_tolerance_m", mismatch_tolerance_m);
  validate::positive("force_limit_N", force_limit_N);
  validate::not_negative("torque_limit_Nm", torque_limit_Nm);
  validate::positive("ramp_s", ramp_s);
  validate::positive("dt_max_s", dt_max_s);
}

CsaTeleop::CsaTeleop(CsaTeleopConfig config) : config_(config) { config_.validate(); }

void CsaTeleop::take_reference(const CsaTeleopInput& input) {
  state_.has_reference = true;
  state_.master_reference = input.master_pose;
  state_.slave_reference = input.slave_pose;
}

void CsaTeleop::ramp_wrench(const Wrench& target, Seconds dt) {
  const Vector3 force = clamp_norm(target.force, config_.force_limit_N);
  const Vector3 torque = clamp_norm(target.torque, config_.torque_limit_Nm);
  const double share = dt / config_.ramp_s;
  state_.wrench.force += clamp_norm(force - state_.wrench.force, share * config_.force_limit_N);
  state_.wrench.torque += clamp_norm(torque - state_.wrench.torque, share * config_.torque_limit_Nm);
}

CsaTeleopOutput CsaTeleop::step(const CsaTeleopInput& input, Seconds dt) noexcept {
  CsaTeleopOutput output;
  output.state = state_.state;
  output.desired = is_valid(input.slave_pose) ? input.slave_pose : state_.slave_reference;
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    state_.wrench = {};
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  const auto hold = [&](Status status) {
    ramp_wrench({}, dt);
    state_.has_reference = false;  // who comes back is re-referenced
    output.wrench = state_.wrench;
    output.status = status;
    return output;
  };
  if (!is_valid(input.master_pose) || !is_valid(input.slave_pose) || !is_valid(input.proxy_pose)) {
    return hold(Status::kInvalidInput);
  }
  output.mismatch_m = (input.slave_pose.translation - input.proxy_pose.translation).norm();
  if (!input.enabled) {
    return hold(Status::kWaiting);
  }
  const bool known = input.force_known && std::isfinite(input.slave_force_N) && input.model_known &&
                     std::isfinite(input.proxy_depth_m) && input.proxy_normal.allFinite() &&
                     is_finite(input.compliance_wrench) && is_finite(input.fixture_wrench);
  if (input.stale || !known) {
    return hold(Status::kStale);
  }
  state_.slave.update(input.slave_force_N, config_.contact_on_N, config_.contact_off_N, config_.debounce_s, dt);
  state_.proxy.update(input.proxy_depth_m, config_.proxy_on_m, config_.proxy_off_m, config_.debounce_s, dt);
  const ContactTransition transition = contact_transition(state_.state, state_.slave.contact, state_.proxy.contact);
  state_.state = output.state = transition.state;
  output.mode = transition.mode;
  output.hold = false;
  const bool mismatched = output.mismatch_m > config_.mismatch_tolerance_m;
  output.synchronise = transition.synchronise == Synchronisation::kAlways ||
                       (transition.synchronise == Synchronisation::kWhenMismatched && mismatched) ||
                       !state_.has_reference;
  if (output.synchronise) {
    output.mismatch_m = 0.0;
  }
  if (output.synchronise || input.clutch) {
    take_reference(input);
  }
  const Vector3 moved = input.master_pose.translation - state_.master_reference.translation;
  output.desired.translation = state_.slave_reference.translation + config_.scale * moved;
  output.desired.rotation =
      (input.master_pose.rotation * state_.master_reference.rotation.conjugate() * state_.slave_reference.rotation)
          .normalized();
  if (transition.state == ContactState::kProxyContact) {
    const double depth = std::max(0.0, input.proxy_depth_m);
    output.normal = input.proxy_normal;
    output.desired_force_N = std::min(config_.stiffness_N_m * depth, config_.force_cap_N);
  } else if (transition.state == ContactState::kFullContact) {
    output.desired_force_N = config_.desired_force_N;
  }
  Wrench felt;
  if (!input.clutch) {
    felt = input.fixture_wrench;
    if (transition.master_feels) {
      felt.force += input.compliance_wrench.force;
      felt.torque += input.compliance_wrench.torque;
    }
  }
  ramp_wrench(felt, dt);
  output.wrench = state_.wrench;
  output.status = Status::kOk;
  return output;
}

}  // namespace saras::csa
