#include "saras/teleop/transparency.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saras/spatial/rotation.hpp"
#include "support/random_values.hpp"
#include "teleop/transparency_rig.hpp"

namespace saras {
namespace {

using test::at_rest;
using test::engaged;
using test::hanging_tip;
using test::kDt;
using test::kNan;
using test::RandomValues;
using test::without_limits;

TEST(Transparency, ScaleEntersTheError) {
  auto config = without_limits();
  config.scale = 0.25;
  auto law = engaged(config);
  auto input = at_rest();
  input.master_pose.translation.x() = 0.04;
  input.slave_pose.translation.x() = 0.01;  // exactly where 0.25 puts it
  const auto output = law.step(input, kDt);
  EXPECT_LT(output.error.norm(), 1e-15);
  EXPECT_LT(to_vector(output.desired_wrench).norm(), 1e-12);
}

TEST(Transparency, AngularIsNotScaled) {
  auto law = engaged(without_limits());
  auto input = at_rest();
  input.master_twist = {Vector3(0.1, 0.2, 0.3), Vector3(1, 2, 3)};
  const auto output = law.step(input, kDt);
  EXPECT_LT((output.desired_twist.linear - 0.5 * input.master_twist.linear).norm(), 1e-15);
  EXPECT_LT((output.desired_twist.angular - input.master_twist.angular).norm(), 1e-15);
}

TEST(Transparency, NewDataFlagsAreReset) {
  Transparency law({});
  auto input = at_rest();
  input.stale = true;
  EXPECT_EQ(law.step(input, kDt).status, Status::kWaiting);
  EXPECT_FALSE(law.state().has_reference);
  law = engaged({});
  law.reset();
  input.master_pose.translation.x() = 1.0;
  EXPECT_EQ(law.step(input, kDt).status, Status::kWaiting);  // still old data: no reference from it
  input.stale = false;
  EXPECT_EQ(law.step(input, kDt).status, Status::kWaiting);
  EXPECT_EQ(law.step(input, kDt).status, Status::kOk);
  EXPECT_EQ(law.state().master_reference.translation.x(), 1.0);
}

TEST(Transparency, WaitsUntilBothPosesAreGood) {
  Transparency law({});
  auto input = at_rest();
  input.slave_pose.translation.x() = kNan;
  for (int i = 0; i < 3; ++i) {
    const auto output = law.step(input, kDt);
    EXPECT_EQ(output.status, Status::kWaiting);
    EXPECT_EQ(to_vector(output.desired_twist).norm() + to_vector(output.desired_wrench).norm(), 0.0);
  }
  EXPECT_EQ(law.step(at_rest(), kDt).status, Status::kWaiting);
  EXPECT_EQ(law.step(at_rest(), kDt).status, Status::kOk);
}

TEST(Transparency, PositionPositionPullsTheHandTowardsTheSlave) {
  auto law = engaged(without_limits());
  auto input = at_rest();
  input.master_pose.translation.x() = 0.02;  // hand ahead, slave held: 10 slave mm behind
  input.master_twist.linear.x() = 0.1;
  const auto output = law.step(input, kDt);
  EXPECT_NEAR(output.desired_wrench.force.x(), 200.0 * -0.01 + 2.0 * -0.05, 1e-12);
  EXPECT_NEAR(output.desired_twist.linear.x(), 0.5 * 0.1 + 2.0 * 0.01, 1e-12);
}

TEST(Transparency, PositionForceIsTheReactionOfTheTissue) {
  auto config = without_limits();
  config.mode = TransparencyMode::kPositionForce;
  auto law = engaged(config);
  auto input = at_rest();
  input.master_pose.translation.x() = 0.02;
  input.tissue_wrench.force = Vector3(1, 2, -3);
  EXPECT_LT((law.step(input, kDt).desired_wrench.force - Vector3(-0.2, -0.4, 0.6)).norm(), 1e-12);
}

TEST(Transparency, FourChannelIsTheSumOfBoth) {
  RandomValues random(1);
  auto config = without_limits();
  config.rotation_stiffness_Nm_rad = 0.3;
  config.rotation_damping_Nm_s_rad = 0.02;
  config.torque_scale = 0.1;
  Wrench parts[3];
  TransparencyInput input;
  input.master_pose = random.pose(0.1);
  input.slave_pose = random.pose(0.1);
  input.master_twist = random.twist(0.1, 1.0);
  input.slave_twist = random.twist(0.1, 1.0);
  input.tissue_wrench = random.wrench(2.0, 0.1);
  for (int mode = 0; mode < 3; ++mode) {
    config.mode = static_cast<TransparencyMode>(mode);
    auto law = engaged(config);
    parts[mode] = law.step(input, kDt).desired_wrench;
  }
  EXPECT_LT((to_vector(parts[0]) + to_vector(parts[1]) - to_vector(parts[2])).norm(), 1e-12);
}

TEST(Transparency, RotationErrorIsZeroForTheSameTurnAndHasNoGainByDefault) {
  auto config = without_limits();
  auto law = engaged(config);
  auto input = at_rest();
  const Quaternion turn = rotation_exp(Vector3(0.3, -0.2, 0.5));
  input.master_pose.rotation = turn * input.master_pose.rotation;
  EXPECT_LT((law.step(input, kDt).error.tail<3>() + Vector3(0.3, -0.2, 0.5)).norm(), 1e-12);
  EXPECT_EQ(law.step(input, kDt).desired_wrench.torque.norm(), 0.0);
  input.slave_pose.rotation = turn * input.slave_pose.rotation;
  input.slave_pose.rotation.coeffs() *= -1.0;
  EXPECT_LT(law.step(input, kDt).error.tail<3>().norm(), 1e-12);
}

TEST(Transparency, ForceIsLimitedInNormAndKeepsItsDirection) {
  auto law = engaged({});
  auto input = at_rest();
  input.master_pose.translation = Vector3(0.3, -0.4, 0.0);
  const auto output = law.step(input, kDt);
  EXPECT_EQ(output.status, Status::kLimited);
  EXPECT_LT((output.desired_wrench.force - 3.3 * Vector3(-0.6, 0.8, 0.0)).norm(), 1e-12);
}

TEST(Transparency, GuidanceIsAddedBeforeLimitAndRamp) {
  auto config = without_limits();
  config.force_limit_N = 3.0;
  auto law = engaged(config);
  auto input = at_rest();
  input.guidance_wrench.force = Vector3(0, 1, 0);
  EXPECT_LT((law.step(input, kDt).desired_wrench.force - Vector3(0, 1, 0)).norm(), 1e-12);
  input.guidance_wrench.force = Vector3(0, 30, 0);
  const auto limited = law.step(input, kDt);
  EXPECT_LT((limited.desired_wrench.force - Vector3(0, 3, 0)).norm(), 1e-12);
  EXPECT_EQ(limited.status, Status::kLimited);
  input.guidance_wrench.force = Vector3(0, kNan, 0);
  const auto unknown = law.step(input, kDt);
  EXPECT_EQ(unknown.status, Status::kInvalidInput);
  EXPECT_LE(unknown.desired_wrench.force.norm(), 3.0);
}

TEST(Transparency, DriftIsRemovedAtNoMoreThanItsLimit) {
  auto config = without_limits();
  config.drift_limit_m_s = 0.02;
  auto law = engaged(config);
  auto input = at_rest();
  for (const double offset : {0.001, 0.009, 0.05, 1.0}) {
    input.slave_pose.translation = hanging_tip().translation + Vector3(0, offset, 0);
    const Vector3 velocity = law.step(input, kDt).desired_twist.linear;
    EXPECT_NEAR(velocity.y(), -std::min(2.0 * offset, 0.02), 1e-12);
  }
}

/// Peak of |set-point - s master| while the hand swings 50 mm at 0.5 Hz and the arm lags its set-point by 33 ms.
double overshoot(Seconds slave_lag_s) {
  auto config = without_limits();
  config.slave_lag_s = slave_lag_s;
  Transparency law(config);
  auto input = at_rest();
  Vector3 set_point = input.slave_pose.translation;
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.05 * std::sin(M_PI * i * kDt);
    input.master_twist.linear.x() = (x - input.master_pose.translation.x()) / kDt;
    input.master_pose.translation.x() = x;
    input.slave_pose.translation += (1.0 - std::exp(-kDt / 0.033)) * (set_point - input.slave_pose.translation);
    set_point += law.step(input, kDt).desired_twist.linear * kDt;
    worst = std::max(worst, std::abs(set_point.x() - 0.5 * x));
  }
  return worst;
}

TEST(Transparency, LagOfTheServoIsNotMistakenForDrift) {
  EXPECT_GT(overshoot(0.0), 1e-3);
  EXPECT_LT(overshoot(0.033 + kDt), 2e-4);
}

TEST(Transparency, DriftDiesOutAfterAReduction) {
  Transparency law(without_limits());
  auto input = at_rest();
  for (int i = 0; i < 800; ++i) {
    const bool reduced = i > 50 && i < 60;
    input.master_twist.linear.x() = i < 100 ? 0.1 : 0.0;
    input.master_pose.translation += input.master_twist.linear * kDt;
    input.slave_pose.translation += (reduced ? 0.0 : 1.0) * law.step(input, kDt).desired_twist.linear * kDt;
  }
  EXPECT_NEAR(law.step(input, kDt).error.norm(), 0.0, 1e-6);
}

TEST(Transparency, ForceRampsInOverItsTimeAfterEngagement) {
  Transparency law(without_limits());
  auto input = at_rest();
  law.step(input, kDt);
  input.master_pose.translation.x() = 0.02;
  for (int i = 1; i <= 15; ++i) {
    const double expected = -2.0 * std::min(1.0, i * kDt / 0.1);
    EXPECT_NEAR(law.step(input, kDt).desired_wrench.force.x(), expected, 1e-12);
  }
}

TEST(Transparency, ClutchStopsTheSlaveFadesTheForceAndReleasesWithoutStep) {
  auto law = engaged(without_limits());
  auto input = at_rest();
  input.master_pose.translation.x() = 0.02;
  input.master_twist.linear.x() = 0.2;
  const Wrench before = law.step(input, kDt).desired_wrench;
  input.clutch = true;
  input.master_twist = {};
  double last = before.force.norm();
  for (int i = 0; i < 12; ++i) {
    const auto output = law.step(input, kDt);
    EXPECT_EQ(output.status, Status::kOk);
    EXPECT_EQ(to_vector(output.desired_twist), Vector6::Zero());
    const double force = output.desired_wrench.force.norm();
    EXPECT_LE(force, last);
    EXPECT_LE(last - force, before.force.norm() * kDt / 0.1 + 1e-12);
    last = force;
  }
  EXPECT_EQ(last, 0.0);
  input.clutch = false;
  const auto output = law.step(input, kDt);
  EXPECT_EQ(output.error, Vector6::Zero());
  EXPECT_EQ(to_vector(output.desired_twist), Vector6::Zero());
  EXPECT_EQ(to_vector(output.desired_wrench), Vector6::Zero());
}

TEST(Transparency, ProjectionKeepsTheTrocarStillTheTipOnCourseAndTheRoll) {
  RandomValues random(2);
  for (int i = 0; i < 5000; ++i) {
    const Vector3 rcm = random.vector(0.2);
    Pose tip = random.pose(0.1);
    const double insertion = random.uniform(0.011, 0.2);
    const Vector3 shaft = tip.rotation * Vector3::UnitZ();
    tip.translation = rcm + insertion * shaft;
    const Twist wanted = random.twist(0.1, 1.0);
    const Twist done = project_on_pivot(wanted, tip, rcm, 0.01);
    EXPECT_LT((done.linear - wanted.linear).norm(), 1e-15);
    EXPECT_NEAR(done.angular.dot(shaft), wanted.angular.dot(shaft), 1e-12);
    // The shaft's material point in the trocar moves along the shaft only.
    const Vector3 at_trocar = done.linear + done.angular.cross(rcm - tip.translation);
    EXPECT_LT(at_trocar.cross(shaft).norm(), 1e-12);
  }
}

TEST(Transparency, ProjectionStaysBoundedWithTheTipInTheTrocar) {
  const Twist wanted{Vector3(0.1, 0, 0), Vector3(0, 0, 1)};
  for (const double insertion : {0.0, 1e-12, 1e-5, 1e-3}) {
    const Pose tip{hanging_tip().rotation, Vector3(0, 0, -insertion)};
    const Twist done = project_on_pivot(wanted, tip, Vector3::Zero(), 0.01);
    EXPECT_TRUE(is_finite(done));
    EXPECT_LE(done.angular.norm(), 0.1 / 0.01 + 1.0);
    EXPECT_NEAR(done.angular.z(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace saras
