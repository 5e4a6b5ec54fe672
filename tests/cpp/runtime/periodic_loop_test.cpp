#include "saras/runtime/periodic_loop.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <vector>

#include "saras/runtime/clock.hpp"
#include "saras/spatial/errors.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

LoopConfig ordinary(Pacing pacing, Seconds period_s = 0.001) {
  LoopConfig config;
  config.period_s = period_s;
  config.pacing = pacing;
  config.hold_after_s = std::max(config.hold_after_s, period_s);
  config.realtime = {0, false};
  return config;
}

/// Waits for a condition, without a claim about speed.
template <typename Condition>
bool eventually(Condition condition) {
  for (int i = 0; i < 3000; ++i) {
    if (condition()) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST(PeriodicLoop, RefusesWhatMakesNoLoop) {
  for (const double bad : {0.0, -1.0, 1.0, test::kNan}) {
    LoopConfig config = ordinary(Pacing::kTick);
    config.period_s = bad;
    EXPECT_THROW(config.validate(), ConfigError);
  }
  LoopConfig config = ordinary(Pacing::kTick);
  config.hold_after_s = 0.5 * config.period_s;
  EXPECT_THROW(config.validate(), ConfigError);
  config = ordinary(Pacing::kTick);
  config.realtime.priority = 100;
  EXPECT_THROW(config.validate(), ConfigError);
}

class BothPacings : public testing::TestWithParam<Pacing> {};

TEST_P(BothPacings, StepsUntilItIsStoppedAndStartsAgain) {
  std::atomic<int> steps{0};
  PeriodicLoop loop(ordinary(GetParam()), [&](const Wake&) { ++steps; });
  for (int run = 0; run < 3; ++run) {
    const int before = steps;
    loop.start();
    EXPECT_TRUE(loop.running());
    EXPECT_THROW(loop.start(), Error);
    EXPECT_TRUE(eventually([&] { return steps > before + 5; }));
    loop.stop();
    EXPECT_FALSE(loop.running());
    const int at_stop = steps;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(steps, at_stop);
    loop.stop();
  }
  EXPECT_EQ(loop.statistics().wakes, static_cast<std::uint64_t>(steps.load()));
  EXPECT_EQ(loop.statistics().execution.count, static_cast<std::uint64_t>(steps.load()));
}

TEST_P(BothPacings, AnOverrunGetsOneNominalPeriodAndNoBurstFollows) {
  std::mutex mutex;
  std::vector<Wake> wakes;
  PeriodicLoop loop(ordinary(GetParam()), [&](const Wake& wake) {
    const std::lock_guard<std::mutex> lock(mutex);
    wakes.push_back(wake);
    if (wakes.size() == 5) {
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
  });
  loop.start();
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return wakes.size() > 20;
  }));
  loop.stop();
  const Wake& late = wakes[5];
  EXPECT_TRUE(late.overrun);
  EXPECT_DOUBLE_EQ(late.dt_s, 0.001);
  EXPECT_GE(late.late_s, 0.028);
  EXPECT_TRUE(late.hold) << "30 ms were lost, 20 ms are allowed";
  // A burst would be ticks closer than a period on the raster that was lost.
  EXPECT_GE(wakes[6].now_ns - late.now_ns, 900'000);
  EXPECT_GE(loop.statistics().overruns, 1u);
  EXPECT_GE(loop.statistics().missed_periods, 28u);
  EXPECT_GE(loop.statistics().holds, 1u);
}

TEST_P(BothPacings, SmallOverrunsInARowAddUpToAHold) {
  std::atomic<bool> hold{false};
  std::atomic<int> steps{0};
  PeriodicLoop loop(ordinary(GetParam()), [&](const Wake& wake) {
    hold = hold || wake.hold;
    if (++steps < 20) {
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
  });
  loop.start();
  EXPECT_TRUE(eventually([&] { return hold.load(); }));
  loop.stop();
}

INSTANTIATE_TEST_SUITE_P(, BothPacings, testing::Values(Pacing::kDatagram, Pacing::kTick));

TEST(PeriodicLoop, ADatagramWakesItLongBeforeItsTimer) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends), 0);
  std::atomic<int> read_by_datagram{0};
  std::atomic<int> by_timer{0};
  PeriodicLoop loop(
      ordinary(Pacing::kDatagram, 0.1),
      [&](const Wake& wake) {
        char byte = 0;
        if (!wake.by_datagram) {
          ++by_timer;
        } else if (recv(ends[0], &byte, 1, MSG_DONTWAIT) == 1) {
          ++read_by_datagram;
        }
      },
      ends[0]);
  loop.start();
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(send(ends[1], "x", 1, 0), 1);
    ASSERT_TRUE(eventually([&] { return read_by_datagram > i; }));
  }
  EXPECT_TRUE(eventually([&] { return by_timer > 1; })) << "without datagrams the timer goes on";
  loop.stop();
  EXPECT_EQ(loop.statistics().by_datagram, 20u);
  close(ends[0]);
  close(ends[1]);
}

TEST(PeriodicLoop, AnExceptionEndsItAndIsTold) {
  PeriodicLoop loop(ordinary(Pacing::kTick), [](const Wake&) { throw Error("the step is broken"); });
  loop.start();
  EXPECT_TRUE(eventually([&] { return !loop.running(); }));
  EXPECT_EQ(loop.failure(), "the step is broken");
  loop.stop();
}

TEST(Realtime, WhatIsNotObtainedHasAReason) {
  LoopConfig config = ordinary(Pacing::kTick);
  config.realtime = {70, false};
  PeriodicLoop loop(config, [](const Wake&) {});
  loop.start();
  const RealtimeReport report = loop.report();
  loop.stop();
  EXPECT_EQ(report.fifo, report.fifo_reason.empty());
  EXPECT_EQ(report.fifo ? 70 : 0, report.priority);
  EXPECT_EQ(report.memory_reason, "not asked for");
  EXPECT_FALSE(report.text().empty());
}

}  // namespace
}  // namespace saras
