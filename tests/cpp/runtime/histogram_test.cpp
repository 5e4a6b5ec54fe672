#include "saras/runtime/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random_values.hpp"

namespace saras {
namespace {

TEST(Histogram, EachDurationFallsIntoABucketThatHoldsItWithinThreePercent) {
  test::RandomValues random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto duration = static_cast<std::int64_t>(std::exp2(random.uniform(0.0, 35.9)));
    const int bucket = HistogramSnapshot::bucket(duration);
    const std::int64_t edge = HistogramSnapshot::upper_edge_ns(bucket);
    EXPECT_GE(edge, duration);
    EXPECT_LE(static_cast<double>(edge - duration), 0.032 * static_cast<double>(duration) + 1.0);
    EXPECT_EQ(HistogramSnapshot::bucket(edge), bucket);
    EXPECT_EQ(HistogramSnapshot::bucket(edge + 1), bucket + 1);
  }
}

TEST(Histogram, QuantilesAreThoseOfTheSortedDurations) {
  test::RandomValues random(2);
  for (int run = 0; run < 20; ++run) {
    Histogram histogram;
    std::vector<std::int64_t> durations(1 + static_cast<std::size_t>(random.uniform(0.0, 3000.0)));
    for (std::int64_t& duration : durations) {
      duration = static_cast<std::int64_t>(std::exp2(random.uniform(0.0, 30.0)));
      histogram.record(duration);
    }
    std::sort(durations.begin(), durations.end());
    const HistogramSnapshot snapshot = histogram.snapshot();
    EXPECT_EQ(snapshot.count, durations.size());
    EXPECT_EQ(snapshot.max_ns, durations.back());
    for (const double p : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const auto rank = static_cast<std::size_t>(std::ceil(p * static_cast<double>(durations.size())));
      const auto exact = static_cast<double>(durations[std::max<std::size_t>(1, rank) - 1]);
      EXPECT_GE(static_cast<double>(snapshot.quantile_ns(p)), exact);
      EXPECT_LE(static_cast<double>(snapshot.quantile_ns(p)), 1.032 * exact + 1.0);
    }
  }
}

TEST(Histogram, TakesWhatIsAbsurd) {
  Histogram histogram;
  EXPECT_EQ(histogram.snapshot().quantile_ns(0.5), 0);
  EXPECT_EQ(histogram.snapshot().mean_ns(), 0.0);
  histogram.record(-5);
  EXPECT_EQ(histogram.snapshot().quantile_ns(1.0), 0);
  histogram.record(std::int64_t{1} << 60);
  EXPECT_EQ(histogram.snapshot().max_ns, std::int64_t{1} << 60);
  EXPECT_EQ(histogram.snapshot().quantile_ns(1.0), std::int64_t{1} << 60);
}

}  // namespace
}  // namespace saras
