#include "saras/teleop/energy_tank.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Seconds kDt = 0.001;

EnergyTankConfig all_axes() {
  EnergyTankConfig config;
  config.damping_min.setConstant(1.0);
  config.damping_max.setConstant(6.0);
  config.applied_limit.setConstant(3.3);
  return config;
}

EnergyTankInput input(const EnergyTank& tank, double desired, double conjugate) {
  EnergyTankInput in;
  in.desired = ChannelArray::Constant(6, tank.channels(), desired);
  in.conjugate = ChannelArray::Constant(6, tank.channels(), conjugate);
  in.measured.resize(6, 0);
  return in;
}

double ledger_residual(const EnergyTankState& s) {
  return s.energy_J + s.work_out_J + s.sent_J + s.vented_J - s.granted_J - s.received_J;
}

TEST(EnergyTank, FullTankIsTransparent) {
  EnergyTank tank(all_axes(), 2);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.03, 0.03);
  ChannelArray conjugate = ChannelArray::Zero(6, 2);
  for (int i = 0; i < 1000; ++i) {
    auto in = input(tank, 0.0, 0.0);
    in.desired = 50.0 * ChannelArray::NullaryExpr(6, 2, [&]() { return uniform(random); });
    conjugate += 0.1 * ChannelArray::NullaryExpr(6, 2, [&]() { return uniform(random); });
    in.conjugate = conjugate;
    in.received_J = 0.1;  // keeps it full
    const auto out = tank.step(in, kDt);
    ASSERT_EQ(out.status, Status::kOk);
    const ChannelArray expected = in.desired - in.conjugate;  // B_min = 1
    ASSERT_TRUE((out.applied.array() == expected.array().min(3.3).max(-3.3)).all());
  }
}

TEST(EnergyTank, LedgerOfOneTankCloses) {
  EnergyTank tank(all_axes(), 1);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  double v = 0.0;
  for (int i = 0; i < 20000; ++i) {
    v += 0.01 * uniform(random);
    auto in = input(tank, 10.0 * uniform(random), v);
    in.received_J = uniform(random) > 0.9 ? 0.01 : 0.0;
    in.requesting_peers = uniform(random) > 0.5 ? 2 : 0;
    in.peer_has_room = uniform(random) > 0.0;
    tank.step(in, kDt);
    ASSERT_LT(std::abs(ledger_residual(tank.state())), 1e-9);
  }
}

// The strongest hand that keeps its rate: each tick it moves with what was applied.
TEST(EnergyTank, GreedyOperatorCannotTakeMoreThanTheBudget) {
  for (int channels : {1, 2}) {
    EnergyTank tank(all_axes(), channels);
    const double drift = tank.config().conjugate_rate[0] * tank.config().hold_s;
    ChannelArray v = ChannelArray::Zero(6, channels);
    ChannelArray applied = ChannelArray::Zero(6, channels);
    for (int i = 0; i < 5000; ++i) {
      v += drift * applied.cwiseSign();
      auto in = input(tank, 3.0, 0.0);
      in.conjugate = v;
      const auto out = tank.step(in, tank.config().hold_s * 0.999);
      applied = out.applied;
      ASSERT_GE(out.energy_J, tank.config().minimum_J - tank.damping_reserve_J() - 1e-12);
    }
  }
}

// A vibrating hand can turn damping into a source for a moment; it must not do so for ever.
TEST(EnergyTank, VibratingHandCannotDrainTheReserve) {
  auto config = all_axes();
  config.initial_J = config.minimum_J;
  EnergyTank tank(config, 1);
  const double half = 0.5 * config.conjugate_rate[0] * config.hold_s;
  for (int i = 0; i < 20000; ++i) {
    tank.step(input(tank, 0.0, i % 2 ? half : -half), config.hold_s * 0.999);
    ASSERT_GE(tank.state().energy_J, config.minimum_J - tank.damping_reserve_J() - 1e-12);
  }
}

TEST(EnergyTank, EmptyTankKeepsItsDampingAndRecoversFromTheHand) {
  auto config = all_axes();
  config.initial_J = config.minimum_J;
  EnergyTank tank(config, 1);
  auto out = tank.step(input(tank, 3.0, 0.2), kDt);
  EXPECT_TRUE(out.applied.isApprox(ChannelArray::Constant(6, 1, -6.0 * 0.2)));
  EXPECT_EQ(out.reduction, 1.0);
  for (int i = 0; i < 1000; ++i) {
    out = tank.step(input(tank, 3.0, 0.2), kDt);
  }
  EXPECT_GT(out.energy_J, config.minimum_J);
}

TEST(EnergyTank, ScaleIsTheLargestFeasible) {
  auto config = all_axes();
  config.damping_min.setZero();
  config.damping_max.setZero();
  EnergyTank tank(config, 1);
  auto state = tank.state();
  state.energy_J = config.minimum_J + 0.12 + 1e-3;  // K_E < 1
  tank.reset(state);
  auto in = input(tank, 3.0, 12.0);
  const auto out = tank.step(in, kDt);
  ASSERT_GT(out.scale, 0.0);
  ASSERT_LT(out.scale, 1.0);
  const double drift = config.conjugate_rate[0] * config.hold_s;
  const double worst_J = (out.applied.array() * 12.0 + out.applied.array().abs() * drift).sum() * config.hold_s;
  EXPECT_NEAR(worst_J, out.energy_J - config.minimum_J, 1e-9);
}

TEST(EnergyTank, BadInputGivesZeroAndAStatusAndIsBilledAsFarAsSeen) {
  EnergyTank tank(all_axes(), 1);
  tank.step(input(tank, 1.0, 0.0), kDt);
  const double level = tank.state().energy_J;
  auto in = input(tank, 1.0, 0.01);
  in.desired(2, 0) = kNan;
  const auto bad_desired = tank.step(in, kDt);
  EXPECT_EQ(bad_desired.status, Status::kInvalidInput);
  EXPECT_TRUE(bad_desired.applied.isZero(0.0));
  EXPECT_NEAR(tank.state().energy_J, level - 6 * 1.0 * 0.01 * kDt, 1e-15);

  const auto after = tank.state();
  auto bad = input(tank, 1.0, kNan);
  EXPECT_EQ(tank.step(bad, kDt).status, Status::kInvalidInput);
  EXPECT_EQ(tank.state().energy_J, after.energy_J);
  auto bad_work = input(tank, 1.0, 0.0);
  bad_work.has_work = true;
  bad_work.work_J = kNan;
  EXPECT_EQ(tank.step(bad_work, kDt).status, Status::kInvalidInput);
  auto stale = input(tank, 1.0, 0.0);
  stale.conjugate_stale = true;
  const auto out = tank.step(stale, kDt);
  EXPECT_EQ(out.status, Status::kStale);
  EXPECT_TRUE(out.applied.isZero(0.0));
  EXPECT_TRUE(std::isfinite(tank.state().energy_J));
}

TEST(EnergyTank, BadTimeStepGivesZeroAndALongOneIsBilled) {
  EnergyTank tank(all_axes(), 1);
  tank.step(input(tank, 1.0, 0.0), kDt);
  const double level = tank.state().energy_J;
  for (const double dt : {0.0, -0.001, kNan}) {
    const auto out = tank.step(input(tank, 1.0, 0.01), dt);
    EXPECT_EQ(out.status, Status::kInvalidTimeStep);
    EXPECT_TRUE(out.applied.isZero(0.0));
    EXPECT_EQ(tank.state().energy_J, level);
    auto state = tank.state();
    state.applied.setOnes();
    tank.reset(state);
  }
  EXPECT_EQ(tank.step(input(tank, 1.0, 0.01), 0.05).status, Status::kInvalidTimeStep);
  EXPECT_NEAR(tank.state().energy_J, level - 6 * 0.01 * 0.05, 1e-15);
}

TEST(EnergyTank, TooFastConjugateIsBilledFullyAndLocksUntilAboveMinimum) {
  auto config = all_axes();
  EnergyTank tank(config, 1);
  auto state = tank.state();
  state.energy_J = config.minimum_J + 1e-4;
  state.applied.setConstant(1.0);
  state.has_conjugate = true;
  tank.reset(state);
  auto out = tank.step(input(tank, 1.0, 0.1), kDt);
  EXPECT_EQ(out.status, Status::kRateExceeded);
  EXPECT_NEAR(out.energy_J, config.minimum_J + 1e-4 - 6 * 0.1 * kDt, 1e-15);
  EXPECT_TRUE((out.applied.array() <= 0.0).all());  // damping only
  out = tank.step(input(tank, 1.0, 0.1), kDt);
  EXPECT_EQ(out.status, out.energy_J > config.minimum_J ? Status::kOk : Status::kRateExceeded);
}

TEST(EnergyTank, RequestsSwitchOnBelowRequestAndOffAtAvailable) {
  auto config = all_axes();
  config.initial_J = 0.2;
  EnergyTank tank(config, 1);
  EXPECT_FALSE(tank.step(input(tank, 0.0, 0.0), kDt).requesting);
  auto take = input(tank, 0.0, 0.0);
  take.has_work = true;
  take.work_J = 0.06;
  EXPECT_TRUE(tank.step(take, kDt).requesting);
  auto give = input(tank, 0.0, 0.0);
  give.received_J = 0.05;
  EXPECT_TRUE(tank.step(give, kDt).requesting);  // 0.19: still between the thresholds
  give.received_J = 0.07;
  EXPECT_FALSE(tank.step(give, kDt).requesting);
}

TEST(EnergyTank, APeerGetsAtMostItsPowerAndNeverBelowAvailable) {
  EnergyTank tank(all_axes(), 1);
  auto in = input(tank, 0.0, 0.0);
  in.requesting_peers = 1;
  EXPECT_NEAR(tank.step(in, kDt).sent_J, 2.0 * kDt, 1e-15);
  for (int i = 0; i < 500; ++i) {
    tank.step(in, kDt);
  }
  EXPECT_NEAR(tank.state().energy_J, tank.config().available_J, 1e-12);
}

TEST(EnergyTank, OverflowGoesToAPeerWithRoomElseIsVented) {
  EnergyTank tank(all_axes(), 1);
  auto in = input(tank, 0.0, 0.0);
  in.received_J = 0.3;
  in.peer_has_room = false;
  EXPECT_EQ(tank.step(in, kDt).sent_J, 0.0);
  EXPECT_NEAR(tank.state().vented_J, 0.2, 1e-12);
  in.peer_has_room = true;
  EXPECT_NEAR(tank.step(in, kDt).sent_overflow_J, 0.3, 1e-12);
}

TEST(EnergyTank, RestartBeginsAtMinimumAndGrantsAreCounted) {
  EnergyTank tank(all_axes(), 1);
  EXPECT_NEAR(tank.state().granted_J, 0.40, 1e-15);
  tank.reset();
  EXPECT_EQ(tank.state().energy_J, tank.config().minimum_J);
  tank.grant(0.6);
  EXPECT_NEAR(tank.state().energy_J, 0.5, 1e-15);
  EXPECT_NEAR(tank.state().vented_J, 0.12, 1e-12);
  EXPECT_LT(std::abs(ledger_residual(tank.state())), 1e-12);
  EXPECT_THROW(tank.grant(-0.1), ConfigError);
  EXPECT_THROW(tank.grant(kNan), ConfigError);
}

// Slave use: a lagging arm that still moves as before is part of the worst case.
TEST(EnergyTank, WorstCaseTakesTheLargerOfCommandedAndMeasured) {
  auto config = all_axes();
  EnergyTank tank(config, 1);
  auto state = tank.state();
  state.energy_J = config.minimum_J + 0.1;
  tank.reset(state);
  auto in = input(tank, 0.01, 1.0);
  ASSERT_EQ(tank.step(in, kDt).scale, 1.0);
  tank.reset(state);
  in.measured = ChannelArray::Constant(6, 1, 10.0);  // 6 axes x 10 x (1 + 0.04) x 2 ms = 0.125 J > 0.1 J
  EXPECT_EQ(tank.step(in, kDt).scale, 0.0);
}

// Defects of the published listing, each named after what it did.
TEST(EnergyTankListing, ReductionNeverExceedsOneSoTheForceNeverReverses) {
  auto config = all_axes();
  EnergyTank tank(config, 1);
  auto state = tank.state();
  state.energy_J = 0.001;
  tank.reset(state);
  const auto out = tank.step(input(tank, 3.0, 0.0), kDt);
  EXPECT_EQ(out.reduction, 1.0);
  EXPECT_TRUE(out.applied.isZero(0.0));
}

TEST(EnergyTankListing, EmptyTankDividesByNothing) {
  EnergyTank tank(all_axes(), 1);
  auto state = tank.state();
  state.energy_J = 0.0;
  tank.reset(state);
  const auto out = tank.step(input(tank, 3.0, 0.5), kDt);
  EXPECT_TRUE(out.applied.allFinite());
}

TEST(EnergyTankListing, DampingReturnsExactlyWhatItTakesFromTheHand) {
  auto config = all_axes();
  EnergyTank tank(config, 1);
  tank.step(input(tank, 0.0, 0.02), kDt);
  const double before = tank.state().energy_J;
  tank.step(input(tank, 0.0, 0.02), kDt);
  EXPECT_NEAR(tank.state().energy_J - before, 6 * 1.0 * 0.02 * 0.02 * kDt, 1e-15);
}

TEST(EnergyTankListing, AxesWithoutAMotorCreditNothing) {
  EnergyTank tank(EnergyTankConfig{}, 1);  // torque axes: no motor
  auto in = input(tank, 0.0, 0.0);
  in.conjugate.bottomRows<3>().setConstant(2.0);
  const double before = tank.state().energy_J;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(tank.step(in, kDt).applied.isZero(0.0));
  }
  EXPECT_EQ(tank.state().energy_J, before);
}

TEST(EnergyTankListing, NothingIsReceivedFromASilentPeer) {
  EnergyTank tank(all_axes(), 1);
  tank.step(input(tank, 0.0, 0.0), kDt);
  const double before = tank.state().energy_J;
  for (int i = 0; i < 100; ++i) {
    tank.step(input(tank, 0.0, 0.0), kDt);
  }
  EXPECT_EQ(tank.state().energy_J, before);
}

TEST(EnergyTankListing, ReductionIsGradualNotAllOrNothing) {
  auto config = all_axes();
  config.damping_min.setZero();
  config.damping_max.setZero();
  EnergyTank tank(config, 1);
  double last = 10.0;
  for (double level = config.request_J; level > config.minimum_J; level -= 0.01) {
    auto state = tank.state();
    state.energy_J = level;
    tank.reset(state);
    const double force = tank.step(input(tank, 1.0, 0.0), kDt).applied(0, 0);
    EXPECT_LT(force, last);
    EXPECT_GT(force, 0.0);
    last = force;
  }
}

TEST(EnergyTankListing, OneNanDoesNotPoisonIt) {
  EnergyTank tank(all_axes(), 1);
  tank.step(input(tank, kNan, kNan), kNan);
  const auto out = tank.step(input(tank, 1.0, 0.0), kDt);
  EXPECT_EQ(out.status, Status::kOk);
  EXPECT_TRUE(out.applied.isOnes());
}

TEST(EnergyTankConfig, RefusalsNameFieldValueAndBound) {
  const auto message = [](auto change) {
    EnergyTankConfig config;
    change(config);
    try {
      EnergyTank tank(config, 1);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message([](auto& c) { c.minimum_J = 0.2; }), "minimum_J = 0.2: must be < request_J = 0.15");
  EXPECT_EQ(message([](auto& c) { c.initial_J = 0.6; }), "initial_J = 0.6: must be in [0.02, 0.5]");
  EXPECT_EQ(message([](auto& c) { c.damping_min[1] = 7; }), "damping_min[1] = 7: must be <= damping_max[1] = 6");
  EXPECT_EQ(message([](auto& c) { c.damping_max[1] = -1; }), "damping_max[1] = -1: must be finite and >= 0");
  EXPECT_EQ(message([](auto& c) { c.hold_s = kNan; }), "hold_s = nan: must be finite and > 0");
  EXPECT_THROW(EnergyTank(EnergyTankConfig{}, 0), ConfigError);
  EXPECT_THROW(EnergyTank(EnergyTankConfig{}, kMaxTankChannels + 1), ConfigError);
}

}  // namespace
}  // namespace saras
