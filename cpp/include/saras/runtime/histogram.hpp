// Distribution of durations with a relative resolution of 3 %, recorded by one thread and read by any.
//
// Debian 12 has no HdrHistogram for C or C++; this is its idea with one fixed layout.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace saras {

/// Plain copy of a histogram.
struct HistogramSnapshot {
  static constexpr int kSubBits = 5;  ///< 32 buckets an octave
  static constexpr int kOctaves = 36;
  static constexpr int kBuckets = (kOctaves - kSubBits + 1) << kSubBits;

  std::array<std::uint64_t, kBuckets> counts{};
  std::uint64_t count = 0;
  std::int64_t max_ns = 0;
  std::int64_t sum_ns = 0;

  /// The duration [ns] that the share p (0..1) of all does not exceed: upper edge of its bucket, at most the largest
  /// one seen; 0 when nothing was recorded.
  std::int64_t quantile_ns(double p) const noexcept;
  double mean_ns() const noexcept {
    return count == 0 ? 0.0 : static_cast<double>(sum_ns) / static_cast<double>(count);
  }

  static int bucket(std::int64_t duration_ns) noexcept;
  /// Largest duration [ns] that falls into the bucket.
  static std::int64_t upper_edge_ns(int bucket) noexcept;
};

/// Durations from 0 to a minute; longer ones count in the last bucket, negative ones as 0.
class Histogram {
 public:
  void record(std::int64_t duration_ns) noexcept;
  HistogramSnapshot snapshot() const noexcept;

 private:
  // One writer: a load and a store are enough, and cheaper than a locked addition.
  static void add(std::atomic<std::uint64_t>& counter, std::uint64_t n) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + n, std::memory_order_relaxed);
  }

  std::array<std::atomic<std::uint64_t>, HistogramSnapshot::kBuckets> counts_{};
  std::atomic<std::uint64_t> sum_ns_{0};
  std::atomic<std::int64_t> max_ns_{0};
};

}  // namespace saras
