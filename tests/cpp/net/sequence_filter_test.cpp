#include "saras/net/sequence_filter.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace saras {
namespace {

TEST(SequenceFilter, CountsWhatItRefuses) {
  SequenceFilter filter;
  EXPECT_TRUE(filter.accept(5, 10));
  EXPECT_TRUE(filter.accept(5, 13));   // two skipped
  EXPECT_FALSE(filter.accept(5, 12));  // late
  EXPECT_FALSE(filter.accept(5, 12));  // and again
  EXPECT_FALSE(filter.accept(5, 13));
  EXPECT_FALSE(filter.accept(4, 99));
  EXPECT_EQ(filter.counts().accepted, 2u);
  EXPECT_EQ(filter.counts().gaps, 2u);
  EXPECT_EQ(filter.counts().out_of_order, 1u);
  EXPECT_EQ(filter.counts().duplicate, 2u);
  EXPECT_EQ(filter.counts().old_session, 1u);
}

TEST(SequenceFilter, ARestartedSenderIsAcceptedAndItsPredecessorIsNot) {
  SequenceFilter filter;
  EXPECT_TRUE(filter.accept(5, 1000000));
  EXPECT_TRUE(filter.accept(6, 0));
  EXPECT_FALSE(filter.accept(5, 1000001));
  EXPECT_TRUE(filter.accept(6, 1));
}

TEST(SequenceFilter, AfterARestartAnySessionIsTheNewest) {
  SequenceFilter filter;
  EXPECT_TRUE(filter.accept(9, 1000000));
  filter.restart();
  EXPECT_TRUE(filter.accept(5, 0));  // a sender whose clock was set back
  EXPECT_FALSE(filter.accept(5, 0));
  EXPECT_TRUE(filter.accept(5, 1));
  EXPECT_EQ(filter.counts().sessions, 2u);
}

TEST(SequenceFilter, HoldsAtTheEndsOfTheNumberRange) {
  constexpr auto kLast = std::numeric_limits<std::uint64_t>::max();
  SequenceFilter filter;
  EXPECT_TRUE(filter.accept(0, 0));
  EXPECT_TRUE(filter.accept(0, kLast));
  EXPECT_FALSE(filter.accept(0, 0));
  EXPECT_TRUE(filter.accept(kLast, 0));
}

}  // namespace
}  // namespace saras
