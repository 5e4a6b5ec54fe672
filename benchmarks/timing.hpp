// Percentiles of single calls: what a control loop feels is the slow call, not the mean.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

namespace saras::benchmarks {

struct Row {
  std::string group;
  std::string name;
  double p50_ns = 0.0;
  double p99_ns = 0.0;
};

using Clock = std::chrono::steady_clock;

inline double nanoseconds(Clock::duration duration) {
  return static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count());
}

/// Keeps the compiler from removing what only the benchmark looks at.
template <typename T>
inline void keep(const T& value) {
  asm volatile("" : : "r,m"(value) : "memory");
}

inline double percentile(std::vector<double>& samples, double share) {
  const auto place = samples.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(samples.size() - 1));
  std::nth_element(samples.begin(), place, samples.end());
  return *place;
}

/// Median cost of asking the clock twice [ns].
inline double clock_overhead_ns() {
  std::vector<double> samples(10001);
  for (double& sample : samples) {
    const auto start = Clock::now();
    sample = nanoseconds(Clock::now() - start);
  }
  return percentile(samples, 0.5);
}

/// Times call(i) for i in [0, count) after `warm_up` unmeasured calls, each call by itself, less the clock's own cost.
template <typename Call>
Row measure(const char* group, const char* name, int count, Call&& call, int warm_up = 2000) {
  static const double overhead_ns = clock_overhead_ns();
  for (int i = 0; i < warm_up; ++i) {
    call(i);
  }
  std::vector<double> samples(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const auto start = Clock::now();
    call(i);
    samples[static_cast<std::size_t>(i)] = std::max(0.0, nanoseconds(Clock::now() - start) - overhead_ns);
  }
  return {group, name, percentile(samples, 0.5), percentile(samples, 0.99)};
}

}  // namespace saras::benchmarks
