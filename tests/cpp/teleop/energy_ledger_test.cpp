#include "saras/teleop/energy_ledger.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace saras {
namespace {

TEST(EnergyLedger, FirstMessageIsTheBaseline) {
  LedgerReceiver receiver;
  EXPECT_EQ(receiver.credit({7, 3, 0.25}), 0.0);
  EXPECT_DOUBLE_EQ(receiver.credit({7, 4, 0.30}), 0.30 - 0.25);
}

TEST(EnergyLedger, RepeatedAndEarlierMessagesCreditNothing) {
  LedgerReceiver receiver;
  receiver.credit({1, 1, 0.0});
  receiver.credit({1, 5, 0.1});
  EXPECT_EQ(receiver.credit({1, 5, 0.1}), 0.0);
  EXPECT_EQ(receiver.credit({1, 4, 9.0}), 0.0);
  EXPECT_EQ(receiver.state().ignored, 2U);
}

TEST(EnergyLedger, OlderSessionIsIgnoredAndANewerOneStartsFromItsOwnBaseline) {
  LedgerReceiver receiver;
  receiver.credit({5, 1, 0.0});
  receiver.credit({5, 2, 0.2});
  EXPECT_EQ(receiver.credit({4, 99, 5.0}), 0.0);
  EXPECT_EQ(receiver.credit({6, 1, 0.1}), 0.0);
  EXPECT_DOUBLE_EQ(receiver.credit({6, 2, 0.15}), 0.15 - 0.1);
}

TEST(EnergyLedger, UnusableTotalsChangeNothing) {
  LedgerReceiver receiver;
  receiver.credit({1, 1, 0.1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  std::uint64_t seq = 2;
  for (const double bad : {nan, infinite, -infinite, -0.1}) {
    EXPECT_EQ(receiver.credit({1, seq++, bad}), 0.0);
  }
  EXPECT_DOUBLE_EQ(receiver.credit({1, 2, 0.2}), 0.2 - 0.1);
}

TEST(EnergyLedger, LossDuplicationAndReorderingNeverCreateEnergy) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int run = 0; run < 200; ++run) {
    LedgerSender sender(1);
    LedgerReceiver receiver;
    receiver.credit(sender.next());
    std::vector<LedgerMessage> wire;
    for (int i = 0; i < 100; ++i) {
      sender.send(1e-3 * uniform(random));
      const LedgerMessage message = sender.next();
      if (uniform(random) < 0.5) {
        wire.push_back(message);
      }
      if (uniform(random) < 0.2) {
        wire.push_back(message);
      }
      std::shuffle(wire.begin(), wire.end(), random);
      while (!wire.empty() && uniform(random) < 0.5) {
        receiver.credit(wire.back());
        wire.pop_back();
      }
      ASSERT_LE(receiver.state().credited_J, sender.last().sent_J + 1e-15);
    }
    receiver.credit(sender.next());
    ASSERT_NEAR(receiver.state().credited_J, sender.last().sent_J, 1e-15);  // one message that arrives heals all losses
  }
}

}  // namespace
}  // namespace saras
