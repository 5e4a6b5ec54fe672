#include "saras/runtime/periodic_loop.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <future>
#include <utility>

#include "saras/runtime/clock.hpp"
#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr double kSecond = 1e9;

void count(std::atomic<std::uint64_t>& counter, std::uint64_t n = 1) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + n, std::memory_order_relaxed);
}

}  // namespace

void LoopConfig::validate() const {
  validate::in_range("period_s", period_s, 1e-4, 0.1);
  validate::in_range("hold_after_s", hold_after_s, period_s, 10.0);
  realtime.validate();
}

PeriodicLoop::PeriodicLoop(LoopConfig config, Step step, int descriptor)
    : config_((config.validate(), config)),
      step_(std::move(step)),
      descriptor_(descriptor),
      stop_event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      period_ns_(std::llround(config_.period_s * kSecond)) {
  if (stop_event_ < 0) {
    throw Error("no event descriptor for a loop");
  }
}

PeriodicLoop::~PeriodicLoop() {
  stop();
  close(stop_event_);
}

void PeriodicLoop::start() {
  if (thread_.joinable()) {
    throw Error("the loop runs already: stop it first");
  }
  std::uint64_t drained = 0;
  (void)!read(stop_event_, &drained, sizeof(drained));
  stopping_.store(false, std::memory_order_relaxed);
  failed_.store(false, std::memory_order_relaxed);
  running_.store(true, std::memory_order_release);
  std::promise<void> promise;
  std::future<void> ready = promise.get_future();
  thread_ = std::thread([this, promise = std::move(promise)]() mutable {
    report_ = enter_realtime(config_.realtime);
    promise.set_value();
    run();
    running_.store(false, std::memory_order_release);
  });
  ready.wait();
}

void PeriodicLoop::stop() noexcept {
  if (!thread_.joinable()) {
    return;
  }
  stopping_.store(true, std::memory_order_release);
  const std::uint64_t one = 1;
  (void)!write(stop_event_, &one, sizeof(one));
  thread_.join();
}

std::string PeriodicLoop::failure() const { return failed_.load(std::memory_order_acquire) ? failure_ : std::string(); }

bool PeriodicLoop::wait(std::int64_t due_ns) noexcept {
  if (config_.pacing == Pacing::kTick) {
    sleep_until_ns(due_ns);
    return false;
  }
  // poll ignores a negative descriptor.
  std::array<pollfd, 2> events{{{stop_event_, POLLIN, 0}, {descriptor_, POLLIN, 0}}};
  const std::int64_t left_ns = std::max<std::int64_t>(0, due_ns - monotonic_ns());
  const timespec timeout{left_ns / 1'000'000'000, left_ns % 1'000'000'000};
  const int ready = ppoll(events.data(), events.size(), &timeout, nullptr);
  return ready > 0 && (events[1].revents & POLLIN) != 0;
}

Wake PeriodicLoop::judge(std::int64_t now_ns, std::int64_t due_ns, std::int64_t last_ns, bool by_datagram,
                         Seconds& lost_s) noexcept {
  Wake wake;
  wake.now_ns = now_ns;
  wake.by_datagram = by_datagram;
  const std::int64_t late_ns = std::max<std::int64_t>(0, now_ns - due_ns);
  wake.late_s = static_cast<double>(late_ns) / kSecond;
  wake.overrun = late_ns > period_ns_;
  wake.dt_s = wake.overrun ? config_.period_s : static_cast<double>(now_ns - last_ns) / kSecond;
  if (wake.overrun) {
    lost_s += wake.late_s;
    wake.hold = lost_s > config_.hold_after_s;
    count(overruns_);
    count(missed_periods_, static_cast<std::uint64_t>(late_ns / period_ns_));
    count(holds_, wake.hold ? 1 : 0);
  } else {
    lost_s = 0.0;
  }
  count(wakes_);
  count(by_datagram_, by_datagram ? 1 : 0);
  if (!by_datagram || late_ns > 0) {
    lateness_.record(late_ns);
  }
  return wake;
}

void PeriodicLoop::run() noexcept {
  try {
    Seconds lost_s = 0.0;
    std::int64_t last_ns = monotonic_ns();
    std::int64_t due_ns = last_ns + period_ns_;
    while (true) {
      const bool by_datagram = wait(due_ns);
      if (stopping_.load(std::memory_order_acquire)) {
        return;
      }
      const std::int64_t now_ns = monotonic_ns();
      // A signal may end the wait early: nothing is due then.
      if (!by_datagram && now_ns < due_ns) {
        continue;
      }
      const Wake wake = judge(now_ns, due_ns, last_ns, by_datagram, lost_s);
      step_(wake);
      execution_.record(monotonic_ns() - now_ns);
      last_ns = now_ns;
      // Ticks keep their raster; periods that are gone are gone.
      due_ns = config_.pacing == Pacing::kTick && !wake.overrun ? due_ns + period_ns_ : now_ns + period_ns_;
    }
  } catch (const std::exception& error) {
    failure_ = error.what();
  } catch (...) {
    failure_ = "unknown exception";
  }
  failed_.store(true, std::memory_order_release);
}

LoopStatistics PeriodicLoop::statistics() const noexcept {
  LoopStatistics statistics;
  statistics.wakes = wakes_.load(std::memory_order_relaxed);
  statistics.by_datagram = by_datagram_.load(std::memory_order_relaxed);
  statistics.overruns = overruns_.load(std::memory_order_relaxed);
  statistics.missed_periods = missed_periods_.load(std::memory_order_relaxed);
  statistics.holds = holds_.load(std::memory_order_relaxed);
  statistics.lateness = lateness_.snapshot();
  statistics.execution = execution_.snapshot();
  return statistics;
}

}  // namespace saras
