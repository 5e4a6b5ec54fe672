#include "saras/console/port_guard.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "saras/console/simulated_handle.hpp"
#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

constexpr double kTick = 1e-3;

PortGuardInput at_rest(bool active, const Wrench& wrench) {
  PortGuardInput input;
  input.has_pose = true;
  input.active = active;
  input.wrench = wrench;
  return input;
}

TEST(PortGuard, RampsUpAndDownInTheConfiguredTime) {
  PortGuard guard;
  guard.grant();
  const Wrench wrench{Vector3(1, 0, 0), Vector3::Zero()};
  guard.step(at_rest(true, wrench), kTick);
  EXPECT_NEAR(guard.state().ramp, 0.01, 1e-12);
  for (int i = 0; i < 120; ++i) {
    guard.step(at_rest(true, wrench), kTick);
  }
  EXPECT_EQ(guard.state().ramp, 1.0);
  EXPECT_NEAR(guard.step(at_rest(true, wrench), kTick).applied.force.x(), 1.0, 1e-12);
  for (int i = 0; i < 101; ++i) {
    guard.step(at_rest(false, wrench), kTick);
  }
  EXPECT_EQ(guard.step(at_rest(false, wrench), kTick).applied.force.norm(), 0.0);
}

TEST(PortGuard, AStallGivesNoForceIsBilledInFullAndDoesNotRampUp) {
  PortGuard guard;
  guard.grant();
  PortGuardInput input = at_rest(true, {Vector3(1, 0, 0), Vector3::Zero()});
  for (int i = 0; i < 20; ++i) {
    guard.step(input, kTick);
  }
  const double ramp = guard.state().ramp;
  input.work_J = 0.05;
  const PortGuardOutput output = guard.step(input, 0.5);
  EXPECT_EQ(output.status, Status::kInvalidTimeStep);
  EXPECT_EQ(output.applied.force.norm(), 0.0);
  EXPECT_NEAR(guard.state().tank.work_out_J, 0.05, 1e-15);
  EXPECT_LE(guard.state().ramp, ramp + 0.1 + 1e-12);
}

TEST(PortGuard, BeginsAtTheMinimumAndGrantsUpToTheInitialCharge) {
  PortGuard guard;
  EXPECT_EQ(guard.state().tank.granted_J, guard.config().tank.minimum_J);
  guard.grant();
  guard.grant();
  EXPECT_NEAR(guard.state().tank.energy_J, guard.config().tank.initial_J, 1e-12);
  EXPECT_NEAR(guard.state().tank.granted_J, guard.config().tank.initial_J, 1e-12);
}

TEST(PortGuard, WithoutAReadingThereIsNoForceAndTheNextPoseIsNoJump) {
  PortGuard guard;
  guard.grant();
  PortGuardInput input = at_rest(true, {Vector3(1, 0, 0), Vector3::Zero()});
  for (int i = 0; i < 200; ++i) {
    guard.step(input, kTick);
  }
  input.has_pose = false;
  EXPECT_EQ(guard.step(input, kTick).status, Status::kStale);
  input.has_pose = true;
  input.simball_T_handle.translation.x() = 0.05;
  EXPECT_EQ(guard.step(input, kTick).status, Status::kOk);
}

TEST(PortGuard, DampingActsInTheTouchFrame) {
  PortGuard guard;
  guard.grant();
  PortGuardInput input = at_rest(false, {});
  guard.step(input, kTick);
  input.simball_T_handle.translation = Vector3(1e-5, 0, 2e-5);  // 10 and 20 mm/s
  const Vector3 force = guard.step(input, kTick).applied.force;
  EXPECT_NEAR(force.x(), 0.01, 1e-9);  // -B v with B = 1, and x turned round
  EXPECT_NEAR(force.z(), -0.02, 1e-9);
}

TEST(PortGuard, ARecordedStateContinuesBitForBit) {
  PortGuard one;
  one.grant();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  PortGuardInput input = at_rest(true, {});
  const auto draw = [&] {
    input.wrench.force = Vector3(normal(random), normal(random), normal(random));
    input.simball_T_handle.translation += 1e-6 * Vector3(normal(random), normal(random), normal(random));
    input.work_J += 1e-5 * normal(random);
  };
  for (int i = 0; i < 50; ++i) {
    draw();
    one.step(input, kTick);
  }
  PortGuard two;
  two.reset(one.state());
  for (int i = 0; i < 50; ++i) {
    draw();
    EXPECT_EQ(one.step(input, kTick).applied.force, two.step(input, kTick).applied.force);
  }
}

TEST(PortGuard, BadInputNeverReachesTheMotors) {
  PortGuard guard;
  guard.grant();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int which = 0; which < 5; ++which) {
    PortGuardInput input = at_rest(true, {Vector3(1, 0, 0), Vector3::Zero()});
    double dt = kTick;
    if (which == 0) input.wrench.force.y() = nan;
    if (which == 1) input.simball_T_handle.translation.z() = nan;
    if (which == 2) input.work_J = nan;
    if (which == 3) input.received_J = nan;
    if (which == 4) dt = nan;
    EXPECT_TRUE(guard.step(input, dt).applied.force.allFinite()) << which;
    EXPECT_TRUE(std::isfinite(guard.state().tank.energy_J)) << which;
  }
  PortGuardConfig config;
  config.force_ramp_s = 0.0;
  EXPECT_THROW(PortGuard{config}, ConfigError);
}

// The loop that a console closes: whatever force is asked for, the tank never gives more than it got.
TEST(PortGuard, WithASimulatedHandEnergyIsConservedAndNeverNegative) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  for (int trial = 0; trial < 50; ++trial) {
    PortGuard guard;
    SimulatedHandleConfig config;
    config.hand = trial % 2 ? OperatorConfig::weak() : OperatorConfig::active();
    SimulatedHandle handle(config);
    const SimballHandle simball;
    Wrench applied;
    Wrench wanted;
    for (int tick = 0; tick < 3000; ++tick) {
      const double dt = uniform(random) < 0.01 ? 0.03 : kTick * (0.5 + uniform(random));
      const auto hand = handle.step({Vector3::Zero(), Vector3::Zero(), 0.0, applied}, dt);
      if (tick % 10 == 0) {
        wanted.force = 3.0 * Vector3(normal(random), normal(random), normal(random));
      }
      if (tick == 500) {
        guard.grant();
      }
      PortGuardInput input = at_rest(true, wanted);
      input.has_pose = hand.valid;
      input.simball_T_handle = simball.forward(hand.joints);
      input.work_J = hand.work_J;
      applied = guard.step(input, dt).applied;
      const EnergyTankState& tank = guard.state().tank;
      ASSERT_GE(tank.energy_J, 0.0) << trial << " " << tick;
      ASSERT_NEAR(tank.energy_J + tank.work_out_J + tank.sent_J + tank.vented_J, tank.granted_J, 1e-9);
    }
  }
}

}  // namespace
}  // namespace saras
