#include "saras/sim/channel.hpp"

#include <gtest/gtest.h>

#include <set>

#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

std::vector<std::uint64_t> run(Channel& channel, int count, Seconds step = 1e-3, Seconds after = 10.0) {
  std::vector<std::uint64_t> received;
  std::uint64_t id = 0;
  for (int i = 0; i < count; ++i) {
    channel.send(static_cast<std::uint64_t>(i), i * step);
    while (channel.receive(i * step, id)) {
      received.push_back(id);
    }
  }
  while (channel.receive(count * step + after, id)) {
    received.push_back(id);
  }
  return received;
}

TEST(Channel, DelaysAndKeepsOrder) {
  ChannelConfig config;
  config.delay_s = 0.1;
  config.jitter_s = 0.05;
  Channel channel(config);
  std::uint64_t id = 0;
  channel.send(7, 0.0);
  EXPECT_FALSE(channel.receive(0.0999, id));
  EXPECT_TRUE(channel.receive(0.151, id));
  EXPECT_EQ(id, 7U);
  Channel many(config);
  const auto received = run(many, 2000);
  ASSERT_EQ(received.size(), 2000U);
  EXPECT_TRUE(std::is_sorted(received.begin(), received.end()));
}

TEST(Channel, LosesDuplicatesAndReordersAtItsRates) {
  ChannelConfig config;
  config.loss = 0.3;
  config.duplicate = 0.2;
  config.reorder = 0.1;
  Channel channel(config);
  const auto received = run(channel, 20000);
  const ChannelCounters& counters = channel.counters();
  EXPECT_NEAR(counters.lost / 20000.0, 0.3, 0.01);
  EXPECT_NEAR(counters.duplicated / 14000.0, 0.2, 0.01);
  EXPECT_NEAR(counters.reordered / 14000.0, 0.1, 0.01);
  EXPECT_EQ(received.size(), counters.delivered);
  EXPECT_EQ(counters.delivered, counters.sent - counters.lost + counters.duplicated);
  EXPECT_FALSE(std::is_sorted(received.begin(), received.end()));
  EXPECT_EQ(std::set<std::uint64_t>(received.begin(), received.end()).size(), counters.sent - counters.lost);
}

TEST(Channel, RepeatsForASeedAndDiffersForAnother) {
  ChannelConfig config;
  config.loss = 0.5;
  Channel one(config);
  Channel same(config);
  config.seed = 2;
  Channel other(config);
  const auto received = run(one, 500);
  EXPECT_EQ(received, run(same, 500));
  EXPECT_NE(received, run(other, 500));
}

TEST(Channel, BurstsAndBlackoutsLoseRunsOfDatagrams) {
  ChannelConfig config;
  config.burst_rate_hz = 1.0;
  config.burst_s = 0.2;
  Channel bursty(config);
  run(bursty, 60000);
  // on for 1 s on average, off for 0.2 s
  EXPECT_NEAR(bursty.counters().lost / 60000.0, 0.2 / 1.2, 0.04);
  Channel cut{ChannelConfig{}};
  cut.blackout_until(0.5);
  EXPECT_EQ(run(cut, 1000).front(), 500U);
}

TEST(Channel, HoldsAndReleases) {
  Channel channel{ChannelConfig{}};
  channel.hold_until(1.0);
  std::uint64_t id = 0;
  channel.send(1, 0.0);
  channel.send(2, 0.1);
  EXPECT_FALSE(channel.receive(0.99, id));
  EXPECT_DOUBLE_EQ(channel.next_arrival(), 1.0);
  EXPECT_TRUE(channel.receive(1.0, id));
  EXPECT_TRUE(channel.receive(1.0, id));
  EXPECT_EQ(id, 2U);
}

TEST(Channel, CountsWhatDoesNotFit) {
  ChannelConfig config;
  config.capacity = 10;
  config.delay_s = 1.0;
  Channel channel(config);
  for (std::uint64_t i = 0; i < 15; ++i) {
    channel.send(i, 0.0);
  }
  EXPECT_EQ(channel.in_flight(), 10U);
  EXPECT_EQ(channel.counters().overflowed, 5U);
}

TEST(Channel, RefusesAProbabilityAboveOne) {
  ChannelConfig config;
  config.loss = 1.5;
  EXPECT_THROW(Channel{config}, ConfigError);
}

}  // namespace
}  // namespace saras
