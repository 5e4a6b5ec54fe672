#include "saras/runtime/realtime.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

std::string limit_text(int resource, const char* name) {
  rlimit limit{};
  getrlimit(resource, &limit);
  return std::string(name) + " = " +
         (limit.rlim_cur == RLIM_INFINITY ? std::string("unlimited") : std::to_string(limit.rlim_cur));
}

/// Pages that a later allocation needs would fail under a limit: locking them is only asked for without one.
bool memory_is_unlimited() {
  rlimit limit{};
  return getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
}

void lock_memory(RealtimeReport& report) {
  rlimit unlimited{RLIM_INFINITY, RLIM_INFINITY};
  // Who may raise the limit (root, CAP_SYS_RESOURCE) does; else it stays as it is.
  const bool future = memory_is_unlimited() || setrlimit(RLIMIT_MEMLOCK, &unlimited) == 0;
  if (mlockall(future ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) != 0) {
    report.memory_reason =
        std::string("mlockall: ") + std::strerror(errno) + " (" + limit_text(RLIMIT_MEMLOCK, "RLIMIT_MEMLOCK") + ")";
    return;
  }
  report.memory_locked = true;
  report.future_locked = future;
  if (!future) {
    report.memory_reason = "pages of later are not locked: " + limit_text(RLIMIT_MEMLOCK, "RLIMIT_MEMLOCK");
  }
}

}  // namespace

void RealtimeRequest::validate() const { validate::in_range("priority", priority, 0, 99); }

RealtimeReport enter_realtime(const RealtimeRequest& request) {
  RealtimeReport report;
  sched_param ordinary{};
  sched_param wanted{};
  wanted.sched_priority = request.priority;
  int error = 0;
  if (request.priority > 0) {
    error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
    report.fifo = error == 0;
    if (error != 0) {
      report.fifo_reason = std::string("SCHED_FIFO ") + std::to_string(request.priority) + ": " + std::strerror(error) +
                           " (" + limit_text(RLIMIT_RTPRIO, "RLIMIT_RTPRIO") + ")";
    }
  } else {
    report.fifo_reason = "not asked for";
  }
  if (report.fifo) {
    report.priority = request.priority;
  } else {
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
  }
  report.timer_slack = prctl(PR_SET_TIMERSLACK, 1UL, 0, 0, 0) == 0;
  if (request.lock_memory) {
    lock_memory(report);
  } else {
    report.memory_reason = "not asked for";
  }
  return report;
}

std::string RealtimeReport::text() const {
  std::string line = fifo ? "SCHED_FIFO " + std::to_string(priority) : "no real-time priority: " + fifo_reason;
  line += memory_locked ? "; memory locked" : "; memory not locked";
  return memory_reason.empty() ? line : line + ": " + memory_reason;
}

}  // namespace saras
