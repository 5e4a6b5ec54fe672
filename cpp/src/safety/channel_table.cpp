#include "saras/safety/channel_table.hpp"

namespace saras {

const char* to_string(SafetyState state) noexcept {
  switch (state) {
    case SafetyState::kWaiting:
      return "WAITING";
    case SafetyState::kReady:
      return "READY";
    case SafetyState::kEngaged:
      return "ENGAGED";
    case SafetyState::kHold:
      return "HOLD";
    case SafetyState::kEstop:
      return "ESTOP";
  }
  return "UNKNOWN";
}

const char* to_string(CrtkState state) noexcept {
  switch (state) {
    case CrtkState::kDisabled:
      return "DISABLED";
    case CrtkState::kEnabled:
      return "ENABLED";
    case CrtkState::kPaused:
      return "PAUSED";
    case CrtkState::kFault:
      return "FAULT";
  }
  return "UNKNOWN";
}

const char* to_string(SafetyEvent event) noexcept {
  switch (event) {
    case SafetyEvent::kNone:
      return "NONE";
    case SafetyEvent::kReady:
      return "READY";
    case SafetyEvent::kLost:
      return "LOST";
    case SafetyEvent::kFault:
      return "FAULT";
    case SafetyEvent::kEngage:
      return "ENGAGE";
    case SafetyEvent::kEngageRefused:
      return "ENGAGE_REFUSED";
    case SafetyEvent::kHold:
      return "HOLD";
    case SafetyEvent::kDisengage:
      return "DISENGAGE";
    case SafetyEvent::kEstop:
      return "ESTOP";
    case SafetyEvent::kEstopReset:
      return "ESTOP_RESET";
  }
  return "UNKNOWN";
}

}  // namespace saras
