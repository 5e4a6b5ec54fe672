// Ages of what was shown, in millisecond bins: percentiles of the last second and of the whole run.
#pragma once

#include <array>
#include <cstdint>

namespace saras_ros1 {

class AgeStatistics {
 public:
  void add(double age_s) {
    const double ms = age_s * 1e3;
    const double bin = ms > 0.0 ? ms : 0.0;
    ++bins_[bin < kBins - 1 ? static_cast<std::size_t>(bin) : kBins - 1];
    ++count_;
    worst_ms_ = bin > worst_ms_ ? bin : worst_ms_;
  }
  /// Upper end of the bin [ms]; 0 without any.
  double percentile_ms(double share) const {
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < kBins; ++i) {
      below += bins_[i];
      if (static_cast<double>(below) >= share * static_cast<double>(count_) && below > 0) {
        return static_cast<double>(i + 1);
      }
    }
    return 0.0;
  }
  double worst_ms() const { return worst_ms_; }
  std::uint64_t count() const { return count_; }

 private:
  static constexpr std::size_t kBins = 1001;
  std::array<std::uint32_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double worst_ms_ = 0.0;
};

}  // namespace saras_ros1
