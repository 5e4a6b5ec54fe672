// The whole table: each (state, event) pair and each set of signs.
#include "saras/safety/channel_table.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "saras/net/touchball_packet.hpp"

namespace saras {
namespace {

template <typename Visit>
void for_each_pair(Visit visit) {
  for (std::size_t s = 0; s < kSafetyStates; ++s) {
    for (std::size_t e = 0; e < kSafetyEvents; ++e) {
      const auto state = static_cast<SafetyState>(s);
      const auto event = static_cast<SafetyEvent>(e);
      visit(state, event, next_state(state, event));
    }
  }
}

TEST(ChannelTable, SameNumbersAsTheWire) {
  EXPECT_EQ(static_cast<int>(SafetyState::kWaiting), static_cast<int>(ChannelState::kWaiting));
  EXPECT_EQ(static_cast<int>(SafetyState::kReady), static_cast<int>(ChannelState::kReady));
  EXPECT_EQ(static_cast<int>(SafetyState::kEngaged), static_cast<int>(ChannelState::kEngaged));
  EXPECT_EQ(static_cast<int>(SafetyState::kHold), static_cast<int>(ChannelState::kHold));
}

TEST(ChannelTable, EveryPair) {
  for_each_pair([](SafetyState state, SafetyEvent event, SafetyState next) {
    SCOPED_TRACE(std::string(to_string(state)) + " + " + to_string(event) + " -> " + to_string(next));
    if (event == SafetyEvent::kEstop) {
      EXPECT_EQ(next, SafetyState::kEstop);
    } else if (state == SafetyState::kEstop) {
      EXPECT_EQ(next, event == SafetyEvent::kEstopReset ? SafetyState::kHold : SafetyState::kEstop);
    } else if (state == SafetyState::kHold) {
      const auto explicit_act = event == SafetyEvent::kEngage      ? SafetyState::kEngaged
                                : event == SafetyEvent::kDisengage ? SafetyState::kWaiting
                                                                   : SafetyState::kHold;
      EXPECT_EQ(next, explicit_act);
    } else if (event == SafetyEvent::kHold) {
      EXPECT_EQ(next, SafetyState::kHold);
    } else if (state == SafetyState::kEngaged) {
      const bool stops = event == SafetyEvent::kLost || event == SafetyEvent::kFault;
      EXPECT_EQ(next, stops                              ? SafetyState::kHold
                      : event == SafetyEvent::kDisengage ? SafetyState::kWaiting
                                                         : SafetyState::kEngaged);
    } else if (event == SafetyEvent::kLost) {
      EXPECT_EQ(next, SafetyState::kWaiting);
    } else if (event == SafetyEvent::kReady) {
      EXPECT_EQ(next, SafetyState::kReady);
    }
    if (next == SafetyState::kEngaged && state != SafetyState::kEngaged) {
      EXPECT_EQ(event, SafetyEvent::kEngage);
      EXPECT_TRUE(state == SafetyState::kReady || state == SafetyState::kHold);
    }
    if (event == SafetyEvent::kNone || event == SafetyEvent::kEngageRefused) {
      EXPECT_EQ(next, state);
    }
  });
}

TEST(ChannelTable, OutOfRangeIsEstop) {
  EXPECT_EQ(next_state(static_cast<SafetyState>(kSafetyStates), SafetyEvent::kNone), SafetyState::kEstop);
  EXPECT_EQ(next_state(SafetyState::kEngaged, static_cast<SafetyEvent>(kSafetyEvents)), SafetyState::kEstop);
}

TEST(ChannelTable, ReadyIsReachableFromEveryState) {
  for (std::size_t from = 0; from < kSafetyStates; ++from) {
    std::set<SafetyState> reached{static_cast<SafetyState>(from)};
    for (std::size_t round = 0; round < kSafetyStates; ++round) {
      for_each_pair([&](SafetyState state, SafetyEvent, SafetyState next) {
        if (reached.count(state) != 0) {
          reached.insert(next);
        }
      });
    }
    EXPECT_EQ(reached.size(), kSafetyStates) << to_string(static_cast<SafetyState>(from));
  }
}

TEST(ChannelTable, EverySetOfSigns) {
  std::set<SafetyEvent> seen;
  for (int bits = 0; bits < 1 << kSafetySigns; ++bits) {
    SCOPED_TRACE(bits);
    const SafetyEvent event = event_of(static_cast<std::uint16_t>(bits));
    const auto has = [&](int sign) { return (bits & sign) != 0; };
    seen.insert(event);
    EXPECT_EQ(event == SafetyEvent::kEstop, has(kSignEstop));
    if (event == SafetyEvent::kEngage) {
      EXPECT_TRUE(has(kSignEngageAsked) && has(kSignHolderAsks) && has(kSignAllThere) && has(kSignAligned));
      EXPECT_FALSE(has(kSignEstop) || has(kSignHoldAsked) || has(kSignFault) || has(kSignLost));
    }
    // An engaged channel never stays so beside a reason to stop.
    if (has(kSignEstop) || has(kSignHoldAsked) || has(kSignFault) || has(kSignDisengageAsked) || has(kSignLost)) {
      if (!has(kSignEstopLatched)) {
        EXPECT_NE(next_state(SafetyState::kEngaged, event), SafetyState::kEngaged);
      }
    }
  }
  EXPECT_EQ(seen.size(), kSafetyEvents) << "an event that never happens";
}

TEST(ChannelTable, CrtkNames) {
  EXPECT_STREQ(to_string(crtk_state(SafetyState::kWaiting)), "DISABLED");
  EXPECT_STREQ(to_string(crtk_state(SafetyState::kReady)), "DISABLED");
  EXPECT_STREQ(to_string(crtk_state(SafetyState::kEngaged)), "ENABLED");
  EXPECT_STREQ(to_string(crtk_state(SafetyState::kHold)), "PAUSED");
  EXPECT_STREQ(to_string(crtk_state(SafetyState::kEstop)), "FAULT");
}

}  // namespace
}  // namespace saras
