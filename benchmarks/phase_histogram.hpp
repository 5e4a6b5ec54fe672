// A histogram of the current phase of a measurement, and its JSON.
#pragma once

#include <cstdio>
#include <memory>
#include <mutex>

#include "saras/runtime/histogram.hpp"

namespace saras::benchmarks {

/// "name": {"count": …, "p50": …} in ns.
inline void print_json(const char* name, const HistogramSnapshot& h) {
  std::printf("\"%s\": {\"count\": %llu, \"p50\": %lld, \"p99\": %lld, \"p99.9\": %lld, \"max\": %lld}", name,
              static_cast<unsigned long long>(h.count), static_cast<long long>(h.quantile_ns(0.5)),
              static_cast<long long>(h.quantile_ns(0.99)), static_cast<long long>(h.quantile_ns(0.999)),
              static_cast<long long>(h.max_ns));
}

/// Recorded by one thread; another one ends the phase. The lock is of the meter, not of what it measures.
class PhaseHistogram {
 public:
  void record(std::int64_t duration_ns) {
    const std::lock_guard<std::mutex> lock(mutex_);
    histogram_->record(duration_ns);
  }
  /// What was recorded since the last call.
  HistogramSnapshot end_phase() {
    const std::lock_guard<std::mutex> lock(mutex_);
    const HistogramSnapshot phase = histogram_->snapshot();
    histogram_ = std::make_unique<Histogram>();
    return phase;
  }

 private:
  std::mutex mutex_;
  std::unique_ptr<Histogram> histogram_ = std::make_unique<Histogram>();
};

}  // namespace saras::benchmarks
