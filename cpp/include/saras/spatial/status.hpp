// What a law's step says about its output. One list for all laws, so that nodes and reports read one table.
#pragma once

#include <cstdint>

namespace saras {

enum class Status : std::uint8_t {
  kOk = 0,
  kLimited,          ///< output was bounded (saturation, workspace, lead, budget)
  kWaiting,          ///< references not taken yet: the safe output
  kStale,            ///< an input is older than its limit: the safe output
  kInvalidInput,     ///< non-finite number, non-unit quaternion: the safe output, state kept
  kInvalidTimeStep,  ///< dt not finite, not positive, or beyond its bound: the safe output
  kRateExceeded,     ///< the conjugate moved faster than the configured rate: damping only
};

/// Upper-case name, as shown to operators and in messages.
inline const char* to_string(Status status) noexcept {
  switch (status) {
    case Status::kOk:
      return "OK";
    case Status::kLimited:
      return "LIMITED";
    case Status::kWaiting:
      return "WAITING";
    case Status::kStale:
      return "STALE";
    case Status::kInvalidInput:
      return "INVALID_INPUT";
    case Status::kInvalidTimeStep:
      return "INVALID_TIME_STEP";
    case Status::kRateExceeded:
      return "RATE_EXCEEDED";
  }
  return "UNKNOWN";
}

}  // namespace saras
