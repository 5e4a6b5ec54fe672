#include "saras/sim/servo_arm.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

const Vector3 kRcm = Eigen::Map<const Vector3>(mesa::kNominalRcm.data());

ServoArmInput target(const Vector3& tip, double roll = 0.0) {
  ServoArmInput input;
  input.target_tip = tip;
  input.target_roll = roll;
  input.rcm = kRcm;
  return input;
}

Vector3 home(const ServoArm& arm) { return arm.kinematics().forward(arm.state().q).translation; }

TEST(ServoArm, StartsAtRestWithTheShaftThroughTheTrocar) {
  ServoArm arm;
  const ServoArmOutput output = arm.step(target(home(arm)), 1e-3);
  EXPECT_EQ(output.status, Status::kOk);
  EXPECT_LT(output.rcm_deviation_m, 1e-12);
  EXPECT_LT(output.q_rate.norm(), 1e-12);
  EXPECT_NEAR((output.base_T_tip.translation - kRcm).norm(), 0.1, 1e-12);
}

TEST(ServoArm, FollowsAsACriticallyDampedSystem) {
  ServoArm arm;
  const Vector3 start = home(arm);
  const double insertion = arm.state().q[4];
  ServoArmOutput output;
  for (int i = 0; i < 25; ++i) {
    output = arm.step(target(start - Vector3(0.0, 0.0, 1e-3)), 1e-3);
  }
  const double wt = 60.0 * 0.025;
  EXPECT_NEAR(output.q[4] - insertion, 1e-3 * (1.0 - (1.0 + wt) * std::exp(-wt)), 1e-9);
}

TEST(ServoArm, KeepsTheRemoteCentreWithEqualDynamicsAndBendsItWithUnequal) {
  ServoArmConfig unequal_config;
  unequal_config.natural_frequency_rad_s << 60, 30, 60, 60, 60, 60;
  ServoArm equal;
  ServoArm unequal(unequal_config);
  const Vector3 start = home(equal);
  double worst_equal = 0.0;
  double worst_unequal = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double t = i * 1e-3;
    const ServoArmInput input = target(start + 0.03 * Vector3(std::sin(3.0 * t), std::sin(2.0 * t), std::sin(t)));
    worst_equal = std::max(worst_equal, equal.step(input, 1e-3).rcm_deviation_m);
    worst_unequal = std::max(worst_unequal, unequal.step(input, 1e-3).rcm_deviation_m);
  }
  EXPECT_LT(worst_equal, 1e-4);
  EXPECT_GT(worst_unequal, 5e-4);
}

TEST(ServoArm, YieldsToAForceAndKeepsTheRemoteCentre) {
  ServoArm arm;
  const Vector3 start = home(arm);
  ServoArmInput input = target(start);
  input.reaction_force = Vector3(3.0, -2.0, 4.0);
  ServoArmOutput output;
  for (int i = 0; i < 2000; ++i) {
    output = arm.step(input, 1e-3);
  }
  const Vector3 expected = input.reaction_force / (2.0 * 60.0 * 60.0);
  EXPECT_LT((output.base_T_tip.translation - start - expected).norm(), 0.02 * expected.norm());
  EXPECT_LT(output.rcm_deviation_m, 1e-5);
}

TEST(ServoArm, ScalesAllJointsTogetherAtASpeedLimit) {
  ServoArmConfig config;
  config.arm.speed << 0.2, 0.2, 0.2, 0.2, 0.02, 6.0;
  ServoArm arm(config);
  const Vector3 start = home(arm);
  bool limited = false;
  for (int i = 0; i < 3000; ++i) {
    const double ramp = std::min(1.0, i / 300.0);
    const ServoArmOutput output = arm.step(target(start + ramp * Vector3(0.02, 0.02, -0.02)), 1e-3);
    limited |= output.status == Status::kLimited;
    ASSERT_TRUE((output.q_rate.cwiseAbs().array() <= config.arm.speed.array() * (1.0 + 1e-12)).all());
  }
  EXPECT_TRUE(limited);
  EXPECT_LT((home(arm) - start - Vector3(0.02, 0.02, -0.02)).norm(), 1e-6);
}

TEST(ServoArm, StaysAtTheLimitWhenTheTargetIsOutOfReach) {
  ServoArm arm;
  const Vector3 start = home(arm);
  ServoArmOutput output;
  for (int i = 0; i < 4000; ++i) {
    output = arm.step(target(start - Vector3(0.0, 0.0, 0.1 * i * 1e-3)), 1e-3);
    ASSERT_FALSE(arm.kinematics().check_limits(output.q));
  }
  EXPECT_EQ(output.status, Status::kLimited);
  EXPECT_EQ(output.violation.reason, Unreachable::kJointLimit);
  EXPECT_NEAR(output.q[4], arm.config().arm.upper[4], 1e-3);
  for (int i = 0; i < 3000; ++i) {
    output = arm.step(target(start), 1e-3);
  }
  EXPECT_EQ(output.status, Status::kOk);
}

TEST(ServoArm, RollAndJawKeepTheSpeedOfTheCommand) {
  ServoArm arm;
  ServoArmInput input = target(home(arm), 1.0);
  input.roll_speed_max_rad_s = 0.5;
  input.target_jaw = 1.0;
  input.jaw_speed_max_1_s = 0.25;
  ServoArmOutput output;
  for (int i = 0; i < 1000; ++i) {
    output = arm.step(input, 1e-3);
    ASSERT_LE(std::abs(output.q_rate[5]), 0.5 + 1e-9);
  }
  EXPECT_NEAR(arm.state().roll_reference, 0.5, 1e-9);
  EXPECT_NEAR(output.jaw, 0.25, 1e-9);
}

TEST(ServoArm, ParallelModeKeepsTheDirection) {
  ServoArm arm;
  ServoArmInput input = target(home(arm) + Vector3(0.01, -0.01, 0.005));
  input.mode = ArmMode::kParallel;
  ServoArmOutput output;
  for (int i = 0; i < 1000; ++i) {
    output = arm.step(input, 1e-3);
  }
  EXPECT_LT((output.base_T_tip.translation - input.target_tip).norm(), 1e-9);
  EXPECT_LT((output.base_T_tip.rotation * Vector3::UnitZ() + Vector3::UnitZ()).norm(), 1e-6);
}

TEST(ServoArm, MeasuresWithResolutionAndNoise) {
  ServoArmConfig config;
  config.joint_resolution.setConstant(1e-3);
  config.joint_noise.setConstant(1e-3);
  ServoArm one(config);
  ServoArm two(config);
  for (int i = 0; i < 100; ++i) {
    const ServoArmOutput output = one.step(target(home(one)), 1e-3);
    ASSERT_EQ(output.measured_q, two.step(target(home(two)), 1e-3).measured_q);
    ASSERT_NEAR(std::remainder(output.measured_q[4], 1e-3), 0.0, 1e-12);
  }
}

TEST(ServoArm, BadInputKeepsTheState) {
  ServoArm arm;
  const Vector6 before = arm.state().q;
  ServoArmInput input = target(home(arm) + Vector3(0.0, 0.0, 0.01));
  input.reaction_force[0] = std::nan("");
  EXPECT_EQ(arm.step(input, 1e-3).status, Status::kInvalidInput);
  EXPECT_EQ(arm.step(target(home(arm)), -1.0).status, Status::kInvalidTimeStep);
  EXPECT_EQ(arm.state().q, before);
  ServoArmConfig config;
  config.damping_ratio[2] = 0.0;
  EXPECT_THROW(ServoArm{config}, ConfigError);
}

}  // namespace
}  // namespace saras
