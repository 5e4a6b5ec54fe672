#include "saras/runtime/histogram.hpp"

#include <algorithm>
#include <cmath>

namespace saras {

int HistogramSnapshot::bucket(std::int64_t duration_ns) noexcept {
  const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(0, duration_ns));
  if (value < (1u << (kSubBits + 1))) {
    return static_cast<int>(value);
  }
  const int octave = 63 - __builtin_clzll(value);
  const int shift = octave - kSubBits;
  const int index = (shift << kSubBits) + static_cast<int>(value >> shift);
  return std::min(index, kBuckets - 1);
}

std::int64_t HistogramSnapshot::upper_edge_ns(int bucket) noexcept {
  if (bucket < (1 << (kSubBits + 1))) {
    return bucket;
  }
  const int shift = (bucket >> kSubBits) - 1;
  const std::int64_t mantissa = (bucket & ((1 << kSubBits) - 1)) + (1 << kSubBits);
  return ((mantissa + 1) << shift) - 1;
}

std::int64_t HistogramSnapshot::quantile_ns(double p) const noexcept {
  if (count == 0) {
    return 0;
  }
  const double share = std::clamp(p, 0.0, 1.0) * static_cast<double>(count);
  const auto wanted = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(share)));
  std::uint64_t seen = 0;
  for (int i = 0; i < kBuckets; ++i) {
    seen += counts[static_cast<std::size_t>(i)];
    if (seen >= wanted) {
      return i == kBuckets - 1 ? max_ns : std::min(max_ns, upper_edge_ns(i));
    }
  }
  return max_ns;
}

void Histogram::record(std::int64_t duration_ns) noexcept {
  const std::int64_t duration = std::max<std::int64_t>(0, duration_ns);
  add(counts_[static_cast<std::size_t>(HistogramSnapshot::bucket(duration))], 1);
  add(sum_ns_, static_cast<std::uint64_t>(duration));
  if (duration > max_ns_.load(std::memory_order_relaxed)) {
    max_ns_.store(duration, std::memory_order_relaxed);
  }
}

HistogramSnapshot Histogram::snapshot() const noexcept {
  HistogramSnapshot copy;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    copy.counts[i] = counts_[i].load(std::memory_order_relaxed);
    copy.count += copy.counts[i];
  }
  copy.sum_ns = static_cast<std::int64_t>(sum_ns_.load(std::memory_order_relaxed));
  copy.max_ns = max_ns_.load(std::memory_order_relaxed);
  return copy;
}

}  // namespace saras
