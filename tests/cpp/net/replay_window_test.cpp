#include "saras/net/replay_window.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

namespace saras {
namespace {

TEST(ReplayWindow, TakesEachNumberOnceInAnyOrderWithinTheWindow) {
  ReplayWindow window;
  EXPECT_EQ(window.accept(1000), ReplayVerdict::kNew);  // the first may be any
  EXPECT_EQ(window.accept(1000), ReplayVerdict::kReplayed);
  EXPECT_EQ(window.accept(1063), ReplayVerdict::kNew);
  EXPECT_EQ(window.accept(1000), ReplayVerdict::kReplayed);  // the last place of the window
  EXPECT_EQ(window.accept(999), ReplayVerdict::kTooOld);
  EXPECT_EQ(window.accept(1001), ReplayVerdict::kNew);
  EXPECT_EQ(window.accept(1001), ReplayVerdict::kReplayed);
  EXPECT_EQ(window.accept(1064), ReplayVerdict::kNew);
  EXPECT_EQ(window.accept(1000), ReplayVerdict::kTooOld);
}

TEST(ReplayWindow, FarAheadLeavesTheWindowUnchanged) {
  ReplayWindow window;
  window.accept(5);
  for (const auto seq : {5 + ReplayWindow::kMostAhead + 1, std::numeric_limits<std::uint64_t>::max()}) {
    EXPECT_EQ(window.accept(seq), ReplayVerdict::kFarAhead);
    EXPECT_EQ(window.newest(), 5u);
  }
  EXPECT_EQ(window.accept(6), ReplayVerdict::kNew);
  EXPECT_EQ(window.accept(6 + ReplayWindow::kMostAhead), ReplayVerdict::kNew);
}

TEST(ReplayWindow, HoldsAtTheEndsOfTheNumberRange) {
  constexpr auto kLast = std::numeric_limits<std::uint64_t>::max();
  ReplayWindow window;
  EXPECT_EQ(window.accept(kLast), ReplayVerdict::kNew);
  EXPECT_EQ(window.accept(kLast), ReplayVerdict::kReplayed);
  EXPECT_EQ(window.accept(0), ReplayVerdict::kTooOld);
  window.reset();
  EXPECT_EQ(window.accept(0), ReplayVerdict::kNew);
  EXPECT_EQ(window.accept(0), ReplayVerdict::kReplayed);
}

TEST(ReplayWindow, SaysWhatASetOfAllNumbersSays) {
  std::mt19937_64 random(8);
  for (int run = 0; run < 200; ++run) {
    ReplayWindow window;
    std::set<std::uint64_t> seen;
    std::uint64_t centre = random() % 1000;
    for (int i = 0; i < 500; ++i) {
      centre += random() % 40 == 0 ? random() % 200 : random() % 3;
      const std::uint64_t behind = random() % 80;
      const std::uint64_t seq = centre >= behind ? centre - behind : 0;
      const std::uint64_t newest = seen.empty() ? seq : *seen.rbegin();
      const auto expected = seen.count(seq) != 0 && newest - seq < ReplayWindow::kSize ? ReplayVerdict::kReplayed
                            : newest >= seq + ReplayWindow::kSize                      ? ReplayVerdict::kTooOld
                                                                                       : ReplayVerdict::kNew;
      ASSERT_EQ(window.accept(seq), expected) << "run " << run << " seq " << seq << " newest " << newest;
      if (expected == ReplayVerdict::kNew) {
        seen.insert(seq);
      }
    }
  }
}

}  // namespace
}  // namespace saras
