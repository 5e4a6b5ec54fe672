#include "saras/teleop/velocity_integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/frames.hpp>

#include "saras/spatial/rotation.hpp"
#include "support/random_values.hpp"
#include "teleop/velocity_integrator_rig.hpp"

namespace saras {
namespace {

using test::command;
using test::follow;
using test::hanging_tip;
using test::kDt;
using test::kNan;
using test::RandomValues;

TEST(VelocityIntegrator, StartsFromMeasuredAndTheFirstStepIsOnePeriod) {
  for (const Seconds first_dt : {kDt, 1e9, 0.0, kNan}) {
    VelocityIntegrator law({});
    const auto output = law.step(command(Vector3(0.05, 0, 0)), first_dt);
    EXPECT_EQ(output.status, Status::kOk);
    EXPECT_LT((output.set_point.translation - Vector3(0.05 * kDt, 0, -0.1)).norm(), 1e-15);
  }
}

TEST(VelocityIntegrator, AgreesWithKdlAddDelta) {
  RandomValues random(1);
  VelocityIntegratorConfig config;
  config.insertion_min_m = 0.0;
  VelocityIntegrator law(config);
  VelocityIntegratorInput input = command(Vector3::Zero());
  law.step(input, kDt);
  KDL::Frame expected(KDL::Rotation::RotX(M_PI), KDL::Vector(0, 0, -0.1));
  for (int i = 0; i < 1000; ++i) {
    input.measured_pose = law.state().set_point;
    const Vector3 strayed = input.measured_pose.translation - hanging_tip().translation;
    const Vector3 v = strayed.norm() > 0.03 ? Vector3(-0.5 * strayed) : random.vector(0.05);
    const Vector3 w = random.vector(0.5);
    input.twist = {v, w};
    const Seconds dt = random.uniform(1e-3, 0.05);
    const auto output = law.step(input, dt);
    ASSERT_EQ(output.status, Status::kOk);
    const KDL::Twist twist(KDL::Vector(v.x(), v.y(), v.z()), KDL::Vector(w.x(), w.y(), w.z()));
    expected = KDL::addDelta(expected, twist, dt);
    const Eigen::Matrix3d rotation = output.set_point.rotation.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
      EXPECT_NEAR(output.set_point.translation[row], expected.p[row], 1e-12);
      for (int column = 0; column < 3; ++column) {
        EXPECT_NEAR(rotation(row, column), expected.M(row, column), 1e-9);
      }
    }
    EXPECT_NEAR(output.set_point.rotation.norm(), 1.0, 1e-15);
  }
}

TEST(VelocityIntegrator, SpeedIsLimitedInNorm) {
  VelocityIntegrator law({});
  const auto output = law.step(command(Vector3(3, -4, 0), Vector3(0, 0, 7)), kDt);
  EXPECT_TRUE(output.speed_limited);
  EXPECT_EQ(output.status, Status::kLimited);
  EXPECT_LT((output.set_point.translation - Vector3(0.0006, -0.0008, -0.1)).norm(), 1e-15);
  EXPECT_NEAR(displacement(hanging_tip(), output.set_point).angular.z(), 0.01, 1e-12);
}

TEST(VelocityIntegrator, LeadOverAHeldArmIsBounded) {
  VelocityIntegrator law({});
  const auto input = command(Vector3(0.1, 0, 0), Vector3(0, 0, 1.0));
  VelocityIntegratorOutput output;
  for (int i = 0; i < 200; ++i) {
    output = law.step(input, kDt);
  }
  EXPECT_TRUE(output.lead_limited);
  EXPECT_NEAR(output.lead_m, 0.01, 1e-12);
  EXPECT_NEAR(displacement(input.measured_pose, output.set_point).angular.norm(), 10 * M_PI / 180, 1e-9);
}

TEST(VelocityIntegrator, StopsAtTheConeAndSlidesAlongIt) {
  VelocityIntegrator law({});
  auto output = follow(law, command(Vector3(0.1, 0, 0)), 130);
  const auto angle = [](const Vector3& p) { return std::atan2(std::hypot(p.x(), p.y()), -p.z()); };
  EXPECT_TRUE(output.cone_limited);
  EXPECT_NEAR(angle(output.set_point.translation), 50 * M_PI / 180, 1e-9);
  const double insertion = output.set_point.translation.norm();
  output = follow(law, command(Vector3(0.05, 0, -0.05)), 50);  // outward and deeper: slides deeper
  EXPECT_LE(angle(output.set_point.translation), 50 * M_PI / 180 + 1e-9);
  EXPECT_GT(output.set_point.translation.norm(), insertion + 0.01);
}

TEST(VelocityIntegrator, InsertionIsBoundedBothWays) {
  VelocityIntegrator law({});
  auto output = follow(law, command(Vector3(0, 0, -0.1)), 300);
  EXPECT_TRUE(output.insertion_limited);
  EXPECT_NEAR(output.set_point.translation.norm(), 0.2, 1e-12);
  output = follow(law, command(Vector3(0, 0, 0.1)), 400);
  EXPECT_TRUE(output.insertion_limited);
  EXPECT_NEAR(output.set_point.translation.norm(), 0.03, 1e-12);
}

TEST(VelocityIntegrator, StartOutsideTheWorkspaceMovesNothingByItselfAndNeverFurtherOut) {
  VelocityIntegrator law({});
  auto input = command(Vector3::Zero());
  input.measured_pose.translation = Vector3(0.0, 0.0, -0.25);
  EXPECT_EQ(follow(law, input, 50).set_point.translation, input.measured_pose.translation);
  input.twist.linear.z() = -0.05;
  EXPECT_NEAR(follow(law, input, 50).set_point.translation.z(), -0.25, 1e-12);
  input.twist.linear.z() = 0.05;
  EXPECT_NEAR(follow(law, input, 200).set_point.translation.z(), -0.15, 1e-9);
}

TEST(VelocityIntegrator, SlowDownCapsApproachNeverRetreat) {
  VelocityIntegrator law({});
  auto input = command(Vector3(0.06, 0.03, 0));
  input.approach_direction = Vector3(2, 0, 0);
  input.approach_speed_limit_m_s = 0.01;
  auto output = law.step(input, kDt);
  EXPECT_TRUE(output.approach_limited);
  EXPECT_LT((output.set_point.translation - Vector3(0.0001, 0.0003, -0.1)).norm(), 1e-12);
  const double x = output.set_point.translation.x();
  input.twist.linear.x() = -0.06;
  output = law.step(input, kDt);
  EXPECT_FALSE(output.approach_limited);
  EXPECT_NEAR(output.set_point.translation.x() - x, -0.0006, 1e-12);
  input.approach_direction.setZero();  // something is near, nobody knows where
  input.twist.linear = Vector3(0, 0.06, 0);
  const double y = output.set_point.translation.y();
  output = law.step(input, kDt);
  EXPECT_TRUE(output.approach_limited);
  EXPECT_NEAR(output.set_point.translation.y() - y, 0.0001, 1e-12);
}

TEST(VelocityIntegrator, SpeedScaleReducesTheSpeedLimit) {
  VelocityIntegrator law({});
  auto input = command(Vector3(0.1, 0, 0));
  input.max_speed_scale = 0.2;
  EXPECT_NEAR(law.step(input, kDt).set_point.translation.x(), 0.02 * kDt, 1e-15);
  input.max_speed_scale = kNan;
  const auto output = law.step(input, kDt);
  EXPECT_EQ(output.status, Status::kInvalidInput);
  EXPECT_NEAR(output.set_point.translation.x(), 0.02 * kDt, 1e-15);
}

TEST(VelocityIntegrator, PivotedShaftKeepsThroughTheTrocarAndRolls) {
  RandomValues random(3);
  VelocityIntegratorConfig config;
  config.shaft_through_rcm = true;
  VelocityIntegrator law(config);
  auto input = command(Vector3::Zero());
  law.step(input, kDt);
  for (int i = 0; i < 3000; ++i) {
    if (i % 50 == 0) {
      input.twist = {random.vector(0.02), random.vector(0.5)};
    }
    input.measured_pose = law.state().set_point;
    const auto output = law.step(input, kDt);
    const Vector3 shaft = output.set_point.translation.normalized();
    EXPECT_LT((output.set_point.rotation * Vector3::UnitZ()).cross(shaft).norm(), 1e-9);
    const Twist moved = displacement(input.measured_pose, output.set_point);
    EXPECT_NEAR(moved.angular.dot(shaft) / kDt, input.twist.angular.dot(shaft), 0.02);
  }
}

TEST(VelocityIntegrator, LeadHoldsForAnyCommandWhileTheArmMovesSlowly) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    RandomValues random(seed);
    VelocityIntegrator law({});
    auto input = command(Vector3::Zero());
    for (int i = 0; i < 300; ++i) {
      input.twist = random.twist(0.3, 3.0);
      const Vector3 towards = law.state().started ? Vector3(law.state().set_point.translation) : Vector3(0, 0, -0.1);
      input.measured_pose.translation += 0.05 * (towards - input.measured_pose.translation);
      const auto output = law.step(input, kDt);
      EXPECT_LE(output.lead_m, 0.01 * (1 + 1e-9));
      EXPECT_LE(displacement(input.measured_pose, output.set_point).angular.norm(), 0.17454);
    }
  }
}

}  // namespace
}  // namespace saras
