// The state table of one channel (side): what each event does in each state. Constant data, so that tests walk through
// all of it and the SPIN model (safety/) is generated from it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace saras {

/// The first four as ChannelState. ESTOP has no number on the wire: there it is HOLD.
enum class SafetyState : std::uint8_t {
  kWaiting = 0,  ///< something needed is missing
  kReady,        ///< all there; waits for an explicit engage
  kEngaged,      ///< motion and force may flow
  kHold,         ///< stopped; latched until an explicit engage or disengage
  kEstop,        ///< emergency stop; latched until an explicit reset, which leads to HOLD
};
inline constexpr std::size_t kSafetyStates = 5;
/// Upper-case name, as shown to operators and in messages.
const char* to_string(SafetyState state) noexcept;

/// What others see of a channel, by CRTK's names. `enable` and `resume` are engage, `pause` is hold, `disable` is
/// disengage. CRTK lets `enable` retry out of FAULT; here the E-stop is reset first, as a reset never moves.
enum class CrtkState : std::uint8_t { kDisabled = 0, kEnabled, kPaused, kFault };
const char* to_string(CrtkState state) noexcept;

constexpr CrtkState crtk_state(SafetyState state) noexcept {
  switch (state) {
    case SafetyState::kEngaged:
      return CrtkState::kEnabled;
    case SafetyState::kHold:
      return CrtkState::kPaused;
    case SafetyState::kEstop:
      return CrtkState::kFault;
    case SafetyState::kWaiting:
    case SafetyState::kReady:
      break;
  }
  return CrtkState::kDisabled;
}

enum class SafetyEvent : std::uint8_t {
  kNone = 0,
  kReady,          ///< all that is needed is there
  kLost,           ///< something needed is missing, or the lease
  kFault,          ///< a fault that needs no age, such as a pose that jumped
  kEngage,         ///< the lease holder asks, all is there and aligned
  kEngageRefused,  ///< somebody asks, and one of these does not hold
  kHold,           ///< the operator asks for HOLD
  kDisengage,      ///< the operator ends the engagement, or gives a HOLD up
  kEstop,
  kEstopReset,
};
inline constexpr std::size_t kSafetyEvents = 10;
const char* to_string(SafetyEvent event) noexcept;

/// One row a state, one column an event, in the order of the enumerations. The clutch is no event: it is a level that
/// stills an engaged arm, and no state changes by it.
inline constexpr std::array<std::array<SafetyState, kSafetyEvents>, kSafetyStates> kChannelTable = [] {
  constexpr auto W = SafetyState::kWaiting;
  constexpr auto R = SafetyState::kReady;
  constexpr auto E = SafetyState::kEngaged;
  constexpr auto H = SafetyState::kHold;
  constexpr auto S = SafetyState::kEstop;
  return std::array<std::array<SafetyState, kSafetyEvents>, kSafetyStates>{{
      // none ready lost fault engage refused hold disengage estop reset
      {{W, R, W, W, R, W, H, W, S, W}},  // WAITING: who asks before READY was shown gets READY
      {{R, R, W, R, E, R, H, R, S, R}},  // READY
      {{E, E, H, H, E, E, H, W, S, E}},  // ENGAGED
      {{H, H, H, H, E, H, H, W, S, H}},  // HOLD
      {{S, S, S, S, S, S, S, S, S, H}},  // ESTOP
  }};
}();

/// Out of range: ESTOP, the state that lets nothing move.
constexpr SafetyState next_state(SafetyState state, SafetyEvent event) noexcept {
  const auto row = static_cast<std::size_t>(state);
  const auto column = static_cast<std::size_t>(event);
  return row < kSafetyStates && column < kSafetyEvents ? kChannelTable[row][column] : SafetyState::kEstop;
}

/// Signs of one step, as bits. Several may stand at once; kEventRules says which one counts.
enum SafetySign : std::uint16_t {
  kSignEstop = 1 << 0,         ///< the button is pressed, or nobody knows
  kSignEstopLatched = 1 << 1,  ///< it was pressed and was not reset
  kSignResetAsked = 1 << 2,
  kSignHoldAsked = 1 << 3,
  kSignFault = 1 << 4,
  kSignDisengageAsked = 1 << 5,
  kSignLost = 1 << 6,
  kSignEngageAsked = 1 << 7,
  kSignHolderAsks = 1 << 8,  ///< who asks for engagement holds the lease
  kSignAllThere = 1 << 9,
  kSignAligned = 1 << 10,  ///< hand and tool are aligned within the operator's tolerance
};
inline constexpr int kSafetySigns = 11;

struct EventRule {
  SafetyEvent event;
  std::uint16_t all_of;   ///< signs that must stand
  std::uint16_t none_of;  ///< signs that must not
};

/// The first rule that fits gives the step's one event: what stops comes before what moves. A reset comes early because
/// while the E-stop is latched nothing else leads anywhere.
inline constexpr std::array<EventRule, 9> kEventRules{{
    {SafetyEvent::kEstop, kSignEstop, 0},
    {SafetyEvent::kEstopReset, kSignEstopLatched | kSignResetAsked, kSignEstop},
    {SafetyEvent::kHold, kSignHoldAsked, 0},
    {SafetyEvent::kFault, kSignFault, 0},
    {SafetyEvent::kDisengage, kSignDisengageAsked, 0},
    {SafetyEvent::kLost, kSignLost, 0},
    {SafetyEvent::kEngage, kSignEngageAsked | kSignHolderAsks | kSignAllThere | kSignAligned, kSignLost},
    {SafetyEvent::kEngageRefused, kSignEngageAsked, 0},
    {SafetyEvent::kReady, kSignAllThere, 0},
}};

constexpr SafetyEvent event_of(std::uint16_t signs) noexcept {
  for (const EventRule& rule : kEventRules) {
    if ((signs & rule.all_of) == rule.all_of && (signs & rule.none_of) == 0) {
      return rule.event;
    }
  }
  return SafetyEvent::kNone;
}

}  // namespace saras
