#include "saras/safety/lease.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace saras {
namespace {

constexpr Seconds kDt = 0.01;

LeaseInput all_alive() {
  LeaseInput in;
  for (OperatorSigns& signs : in.operators) {
    signs.alive = true;
  }
  return in;
}

Lease held_by(std::uint8_t holder, std::uint8_t offered_to = kNobody) {
  Lease lease;
  lease.reset({holder, offered_to});
  return lease;
}

TEST(Lease, EveryActOfEveryOperatorInEveryState) {
  for (std::uint8_t holder = 0; holder <= kMaxOperators; ++holder) {
    for (std::uint8_t offered = 0; offered <= kMaxOperators; ++offered) {
      for (std::size_t a = 0; a < kLeaseActs; ++a) {
        for (std::uint8_t by = 0; by <= kMaxOperators + 1; ++by) {
          for (std::uint8_t to = 0; to <= kMaxOperators + 1; ++to) {
            const auto act = static_cast<LeaseAct>(a);
            const LeaseState before{holder, offered};
            const LeaseState after = next_lease(before, act, by, to);
            SCOPED_TRACE(testing::Message() << int{holder} << int{offered} << " " << to_string(act) << " by " << int{by}
                                            << " to " << int{to});
            EXPECT_LE(after.holder, kMaxOperators);
            EXPECT_LE(after.offered_to, kMaxOperators);
            if (after.holder != holder) {
              const bool left =
                  after.holder == kNobody && by == holder && (act == LeaseAct::kSilent || act == LeaseAct::kRelease);
              const bool claimed = holder == kNobody && after.holder == by && act == LeaseAct::kClaim;
              const bool accepted = offered == by && after.holder == by && act == LeaseAct::kAccept;
              EXPECT_TRUE(left || claimed || accepted);
              EXPECT_EQ(after.offered_to, kNobody) << "an offer is its maker's alone";
            }
            if (after.offered_to != offered && after.offered_to != kNobody) {
              EXPECT_TRUE(act == LeaseAct::kOffer && by == holder && after.offered_to == to);
            }
          }
        }
      }
    }
  }
}

TEST(Lease, TheSecondIsRefused) {
  Lease lease;
  LeaseInput in = all_alive();
  in.operators[1].claim = in.operators[2].claim = true;
  LeaseOutput out = lease.step(in, kDt);
  EXPECT_EQ(out.holder, 2);
  EXPECT_FALSE(out.refused[1]);
  EXPECT_TRUE(out.refused[2]);
  out = lease.step(in, kDt);
  EXPECT_EQ(out.holder, 2);
  EXPECT_FALSE(out.refused[1]) << "it holds already";
  EXPECT_TRUE(out.refused[2]);
}

TEST(Lease, HandOverNeedsOfferAndAcceptance) {
  Lease lease = held_by(1);
  LeaseInput in = all_alive();
  in.operators[1].accept = true;
  EXPECT_TRUE(lease.step(in, kDt).refused[1]) << "nothing was offered";
  in.operators[0].offer_to = 2;
  LeaseOutput out = lease.step(in, kDt);
  EXPECT_EQ(out.holder, 1) << "who accepts must have seen the offer";
  EXPECT_EQ(out.offered_to, 2);
  in = all_alive();
  in.operators[2].accept = true;
  out = lease.step(in, kDt);
  EXPECT_TRUE(out.refused[2]) << "offered to another";
  EXPECT_EQ(out.holder, 1);
  in.operators[1].accept = true;
  EXPECT_EQ(lease.step(in, kDt).holder, 2);
}

TEST(Lease, AnOfferCanBeTakenBackAndDiesWithItsAddressee) {
  LeaseInput in = all_alive();
  in.operators[0].withdraw = true;
  in.operators[1].accept = true;
  Lease withdrawn = held_by(1, 2);
  EXPECT_EQ(withdrawn.step(in, kDt).holder, 1);
  in = all_alive();
  in.operators[1].alive = false;
  Lease lapsed = held_by(1, 2);
  EXPECT_EQ(lapsed.step(in, kDt).offered_to, kNobody);
  in = all_alive();
  in.operators[1].alive = false;
  in.operators[0].offer_to = 2;
  EXPECT_TRUE(held_by(1).step(in, kDt).refused[0]) << "nobody is there to take it";
}

TEST(Lease, SilenceReleasesToNobody) {
  for (const std::uint8_t offered_to : {std::uint8_t{0}, std::uint8_t{2}}) {
    Lease lease = held_by(1, offered_to);
    LeaseInput in = all_alive();
    in.operators[0].alive = false;
    in.operators[1].accept = in.operators[1].claim = in.operators[2].claim = true;
    LeaseOutput out = lease.step(in, kDt);
    EXPECT_EQ(out.holder, kNobody) << "the supervisor must see the gap";
    EXPECT_EQ(out.status, Status::kWaiting);
    EXPECT_TRUE(out.refused[1] && out.refused[2]);
    out = lease.step(in, kDt);
    EXPECT_EQ(out.holder, 2) << "who claims a free arm gets it";
  }
}

TEST(Lease, BadInputGrantsNothing) {
  for (const double dt : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    Lease lease;
    LeaseInput in = all_alive();
    in.operators[0].claim = true;
    const LeaseOutput out = lease.step(in, dt);
    EXPECT_EQ(out.holder, kNobody);
    EXPECT_TRUE(out.refused[0]);
    EXPECT_EQ(out.status, Status::kInvalidTimeStep);
  }
  Lease lease = held_by(1);
  LeaseInput in = all_alive();
  in.operators[0].offer_to = 200;
  const LeaseOutput out = lease.step(in, kDt);
  EXPECT_EQ(out.status, Status::kInvalidInput);
  EXPECT_EQ(out.holder, 1);
  EXPECT_EQ(out.offered_to, kNobody);
}

}  // namespace
}  // namespace saras
