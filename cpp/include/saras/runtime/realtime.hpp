// What makes a thread's wake-ups punctual, as far as the machine permits, and what of it was obtained.
#pragma once

#include <string>

namespace saras {

struct RealtimeRequest {
  int priority = 80;        ///< of SCHED_FIFO, 1..99; 0: an ordinary thread
  bool lock_memory = true;  ///< keep all pages in memory (mlockall)
  void validate() const;    ///< throws ConfigError
};

/// What the calling thread got. A refusal is no error: the loop runs on, less punctually.
struct RealtimeReport {
  bool fifo = false;           ///< SCHED_FIFO obtained
  int priority = 0;            ///< in effect
  std::string fifo_reason;     ///< why not; empty when obtained
  bool memory_locked = false;  ///< pages of now are locked
  bool future_locked = false;  ///< and those of later
  std::string memory_reason;   ///< why not, or why only those of now
  bool timer_slack = false;    ///< the kernel may not delay this thread's timers to join wake-ups
  /// All that in one line for a person.
  std::string text() const;
};

/// Applies the request to the calling thread (memory: to the process). An ordinary policy is set back to SCHED_OTHER:
/// a thread inherits whatever its creator had.
RealtimeReport enter_realtime(const RealtimeRequest& request);

}  // namespace saras
