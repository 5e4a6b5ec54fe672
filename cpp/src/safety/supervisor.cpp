#include "saras/safety/supervisor.hpp"

#include <limits>

#include "saras/spatial/validate.hpp"

namespace saras {

void SupervisorConfig::validate() const {
  validate::in_range("channels", channels, 1, static_cast<double>(kMaxChannels));
  validate::in_range("steps_missing_hold", steps_missing_hold, 1, 100);
}

Supervisor::Supervisor(SupervisorConfig config) : config_(config) { config_.validate(); }

Status Supervisor::check(const SupervisorInput& input, Seconds dt) const noexcept {
  if (!is_valid_time_step(dt, std::numeric_limits<double>::infinity())) {
    return Status::kInvalidTimeStep;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(config_.channels); ++i) {
    if (input.channels[i].holder > kMaxOperators || input.channels[i].engage_by > kMaxOperators) {
      return Status::kInvalidInput;
    }
  }
  return Status::kOk;
}

std::uint16_t Supervisor::signs(const SupervisorInput& input, std::size_t channel) const noexcept {
  const ChannelInput& in = input.channels[channel];
  const ChannelMemory& memory = state_.channels[channel];
  const bool engaged = memory.state == SafetyState::kEngaged;
  // Whoever else holds the arm now has neither asked nor been aligned: the engagement was not his.
  const bool leased = in.holder != kNobody && (!engaged || in.holder == memory.engaged_by);
  const bool missing = engaged ? memory.steps_missing >= config_.steps_missing_hold : !in.all_there;
  int bits = 0;
  bits |= input.estop ? kSignEstop : 0;
  bits |= memory.state == SafetyState::kEstop ? kSignEstopLatched : 0;
  bits |= input.estop_reset ? kSignResetAsked : 0;
  bits |= in.hold ? kSignHoldAsked : 0;
  bits |= in.fault ? kSignFault : 0;
  bits |= in.disengage ? kSignDisengageAsked : 0;
  bits |= missing || !leased ? kSignLost : 0;
  bits |= in.engage_by != kNobody ? kSignEngageAsked : 0;
  bits |= in.engage_by != kNobody && in.engage_by == in.holder ? kSignHolderAsks : 0;
  bits |= in.all_there ? kSignAllThere : 0;
  bits |= in.aligned ? kSignAligned : 0;
  return static_cast<std::uint16_t>(bits);
}

void Supervisor::advance(const SupervisorInput& input, std::size_t channel, ChannelOutput& output) noexcept {
  const ChannelInput& in = input.channels[channel];
  ChannelMemory& memory = state_.channels[channel];
  // Counted up to the limit only: a channel may be without its console for days.
  memory.steps_missing = in.all_there ? 0 : memory.steps_missing + (memory.steps_missing < config_.steps_missing_hold);
  output.event = event_of(signs(input, channel));
  const SafetyState next = next_state(memory.state, output.event);
  if (next != memory.state) {
    memory.state = next;
    memory.cause = output.event;
    memory.engagement += next == SafetyState::kEngaged ? 1 : 0;
    memory.engaged_by = next == SafetyState::kEngaged ? in.holder : kNobody;
  }
}

CrtkState Supervisor::whole() const noexcept {
  bool fault = false;
  bool enabled = false;
  bool paused = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(config_.channels); ++i) {
    const CrtkState state = crtk_state(state_.channels[i].state);
    fault = fault || state == CrtkState::kFault;
    enabled = enabled || state == CrtkState::kEnabled;
    paused = paused || state == CrtkState::kPaused;
  }
  if (fault) {
    return CrtkState::kFault;
  }
  return enabled ? CrtkState::kEnabled : paused ? CrtkState::kPaused : CrtkState::kDisabled;
}

SupervisorOutput Supervisor::step(const SupervisorInput& input, Seconds dt) noexcept {
  SupervisorOutput output;
  output.status = check(input, dt);
  const bool valid = output.status == Status::kOk;
  for (std::size_t i = 0; i < static_cast<std::size_t>(config_.channels); ++i) {
    const ChannelInput& in = input.channels[i];
    ChannelMemory& memory = state_.channels[i];
    ChannelOutput& out = output.channels[i];
    if (valid || input.estop) {
      advance(input, i, out);
    }
    out.state = memory.state;
    out.crtk = crtk_state(memory.state);
    out.engagement = memory.engagement;
    out.may_move = valid && memory.state == SafetyState::kEngaged && !in.clutch;
    out.engage_refused = in.engage_by != kNobody &&
                         (!valid || memory.state != SafetyState::kEngaged || in.engage_by != memory.engaged_by);
  }
  output.whole = whole();
  output.estop_latched = output.whole == CrtkState::kFault;
  return output;
}

}  // namespace saras
