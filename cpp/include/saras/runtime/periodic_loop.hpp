// A thread that steps at a period, or at once when a datagram comes, and knows how punctual it was.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "saras/runtime/histogram.hpp"
#include "saras/runtime/realtime.hpp"
#include "saras/spatial/types.hpp"

namespace saras {

enum class Pacing : std::uint8_t {
  kDatagram = 0,  ///< a readable descriptor wakes the loop; without one, the timer does after a period
  kTick           ///< the timer alone: what came in between waits for the next tick
};

struct LoopConfig {
  Seconds period_s = 0.001;  ///< [0.0001, 0.1]
  Pacing pacing = Pacing::kDatagram;
  Seconds hold_after_s = 0.02;  ///< time lost by overruns in a row that asks for HOLD, >= period_s
  RealtimeRequest realtime;
  void validate() const;  ///< throws ConfigError
};

/// One wake-up. dt_s is since the last one; of an overrun only one nominal period is given: nobody makes up for time
/// that was lost, and no burst of ticks follows.
struct Wake {
  std::int64_t now_ns = 0;  ///< monotonic clock
  Seconds dt_s = 0.0;
  Seconds late_s = 0.0;      ///< behind the timer; 0 when a datagram came before it
  bool by_datagram = false;  ///< the descriptor is readable
  bool overrun = false;      ///< more than a period late
  bool hold = false;         ///< overruns in a row lost more than hold_after_s: stop the arms until somebody engages
};

/// Plain copy of the counters.
struct LoopStatistics {
  std::uint64_t wakes = 0;
  std::uint64_t by_datagram = 0;
  std::uint64_t overruns = 0;        ///< wake-ups more than a period late
  std::uint64_t missed_periods = 0;  ///< whole periods lost in them
  std::uint64_t holds = 0;
  HistogramSnapshot lateness;   ///< of timer wake-ups behind their deadline
  HistogramSnapshot execution;  ///< of the steps
};

/// start() to stop() runs `step` in a thread of its own. `step` must neither throw nor block; an exception ends the
/// loop, and failure() says so.
class PeriodicLoop {
 public:
  using Step = std::function<void(const Wake&)>;

  /// descriptor: what wakes it with Pacing::kDatagram; -1: none. Throws ConfigError.
  PeriodicLoop(LoopConfig config, Step step, int descriptor = -1);
  ~PeriodicLoop();
  PeriodicLoop(const PeriodicLoop&) = delete;
  PeriodicLoop& operator=(const PeriodicLoop&) = delete;

  /// Returns once the thread has asked for its real-time properties. Throws Error when it runs already.
  void start();
  /// Ends the thread after its step, at most one period later. Safe to repeat.
  void stop() noexcept;
  bool running() const noexcept { return running_.load(std::memory_order_acquire); }
  /// What the thread got; after start().
  const RealtimeReport& report() const noexcept { return report_; }
  /// Why the loop ended by itself; empty when it did not.
  std::string failure() const;
  LoopStatistics statistics() const noexcept;
  const LoopConfig& config() const noexcept { return config_; }

 private:
  void run() noexcept;
  /// Waits for the descriptor or until due_ns; true when the descriptor is readable.
  bool wait(std::int64_t due_ns) noexcept;
  Wake judge(std::int64_t now_ns, std::int64_t due_ns, std::int64_t last_ns, bool by_datagram,
             Seconds& lost_s) noexcept;

  LoopConfig config_;
  Step step_;
  int descriptor_;
  int stop_event_ = -1;
  std::int64_t period_ns_;
  std::thread thread_;
  RealtimeReport report_;
  std::string failure_;
  std::atomic<bool> running_{false};
  std::atomic<bool> stopping_{false};
  std::atomic<bool> failed_{false};
  std::atomic<std::uint64_t> wakes_{0}, by_datagram_{0}, overruns_{0}, missed_periods_{0}, holds_{0};
  Histogram lateness_, execution_;
};

}  // namespace saras
