// Whether each channel may move: the channel table over all channels, with one E-stop for the whole.
#pragma once

#include <array>

#include "saras/safety/channel_table.hpp"
#include "saras/safety/lease.hpp"

namespace saras {

/// Fixed capacity, so that input, output and state are plain values and no step allocates.
inline constexpr std::size_t kMaxChannels = 8;

struct SupervisorConfig {
  int channels = 2;            ///< 1..kMaxChannels
  int steps_missing_hold = 2;  ///< 1..100; so many steps in a row without all there end an engagement: one is a hiccup
  void validate() const;       ///< throws ConfigError
};

struct ChannelInput {
  bool all_there = false;            ///< everything that the channel needs is fresh; ages are judged by the caller
  bool fault = false;                ///< in this step, such as a pose that jumped
  bool aligned = false;              ///< hand and tool are aligned within the operator's tolerance
  bool hold = false;                 ///< asked for in this step
  bool disengage = false;            ///< asked for in this step
  bool clutch = false;               ///< pressed, a level
  std::uint8_t holder = kNobody;     ///< of the arm's lease
  std::uint8_t engage_by = kNobody;  ///< operator who asks for engagement in this step; nobody: none
};

struct SupervisorInput {
  std::array<ChannelInput, kMaxChannels> channels;  ///< as many as there are
  bool estop = true;                                ///< pressed; also when the button's state is not known
  bool estop_reset = false;                         ///< asked for in this step
};

struct ChannelOutput {
  SafetyState state = SafetyState::kWaiting;
  CrtkState crtk = CrtkState::kDisabled;
  SafetyEvent event = SafetyEvent::kNone;  ///< of this step
  bool may_move = false;                   ///< engaged, clutch released, by who holds the lease
  bool engage_refused = false;             ///< somebody asked for engagement and did not get it
  std::uint64_t engagement = 0;            ///< counts engagements
};

struct SupervisorOutput {
  std::array<ChannelOutput, kMaxChannels> channels;  ///< unused places say WAITING and do not move
  CrtkState whole = CrtkState::kDisabled;  ///< FAULT: E-stop; else ENABLED: a channel is; else PAUSED: a channel is
  bool estop_latched = false;
  Status status = Status::kOk;
};

struct ChannelMemory {
  SafetyState state = SafetyState::kWaiting;
  SafetyEvent cause = SafetyEvent::kNone;  ///< event that led to this state
  std::uint8_t engaged_by = kNobody;
  int steps_missing = 0;
  std::uint64_t engagement = 0;
};

struct SupervisorState {
  std::array<ChannelMemory, kMaxChannels> channels;  ///< the E-stop is latched where a channel is in ESTOP
};

/// Channels know nothing of each other; only the E-stop is common. Each step, each channel has one event (event_of) and
/// one transition (next_state). E-stop: all channels are in ESTOP in the step that sees it, whatever else is wrong with
/// the input; a reset leads to HOLD, and only an engage by the lease holder moves again. An engagement belongs to the
/// operator who asked for it: when the lease goes to nobody or, handed over, to another, the channel goes to HOLD in
/// that step.
///
/// dt not finite or <= 0 (INVALID_TIME_STEP), or an operator's number out of range (INVALID_INPUT): nothing may move in
/// this step, states are kept but for the E-stop, nothing is granted. Time enters in no other way.
class Supervisor {
 public:
  explicit Supervisor(SupervisorConfig config = {});
  SupervisorOutput step(const SupervisorInput& input, Seconds dt) noexcept;
  void reset(const SupervisorState& state = {}) { state_ = state; }
  const SupervisorState& state() const { return state_; }
  const SupervisorConfig& config() const { return config_; }

 private:
  Status check(const SupervisorInput& input, Seconds dt) const noexcept;
  std::uint16_t signs(const SupervisorInput& input, std::size_t channel) const noexcept;
  void advance(const SupervisorInput& input, std::size_t channel, ChannelOutput& output) noexcept;
  CrtkState whole() const noexcept;

  SupervisorConfig config_;
  SupervisorState state_;
};

static_assert(has_law_shape<Supervisor, SupervisorInput, SupervisorState>());

}  // namespace saras
