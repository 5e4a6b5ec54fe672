#include "saras/runtime/clock.hpp"

#include <cerrno>
#include <ctime>

namespace saras {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

std::int64_t read(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

}  // namespace

std::int64_t monotonic_ns() noexcept { return read(CLOCK_MONOTONIC); }

std::int64_t wall_ns() noexcept { return read(CLOCK_REALTIME); }

void sleep_until_ns(std::int64_t due_ns) noexcept {
  const timespec due{due_ns / kSecond, due_ns % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
  }
}

}  // namespace saras
