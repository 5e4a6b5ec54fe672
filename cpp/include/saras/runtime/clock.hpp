// The monotonic clock, in nanoseconds. Only the runtime room reads clocks.
#pragma once

#include <cstdint>

namespace saras {

/// CLOCK_MONOTONIC [ns].
std::int64_t monotonic_ns() noexcept;
/// CLOCK_REALTIME [ns since the epoch]: for stamps, never for time steps.
std::int64_t wall_ns() noexcept;
/// Sleeps until the monotonic clock shows due_ns, whatever signals come.
void sleep_until_ns(std::int64_t due_ns) noexcept;

}  // namespace saras
