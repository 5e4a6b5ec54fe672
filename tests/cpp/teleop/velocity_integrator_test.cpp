#include "saras/teleop/velocity_integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/frames.hpp>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using test::kInf;
using test::kNan;
using test::RandomValues;

constexpr Seconds kDt = 0.01;

/// Tip 0.1 m below a trocar at the origin, shaft along the tip's z.
Pose hanging_tip() { return {rotation_exp(Vector3(M_PI, 0, 0)), Vector3(0, 0, -0.1)}; }

VelocityIntegratorInput command(const Vector3& linear, const Vector3& angular = Vector3::Zero()) {
  VelocityIntegratorInput input;
  input.twist = {linear, angular};
  input.measured_pose = hanging_tip();
  return input;
}

/// Follows an ideal arm: measured = last set-point.
VelocityIntegratorOutput follow(VelocityIntegrator& law, VelocityIntegratorInput input, int ticks) {
  VelocityIntegratorOutput output;
  for (int i = 0; i < ticks; ++i) {
    if (law.state().started) {
      input.measured_pose = law.state().set_point;
    }
    output = law.step(input, kDt);
  }
  return output;
}

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

TEST(VelocityIntegrator, WaitsForAMeasuredPose) {
  VelocityIntegrator law({});
  auto input = command(Vector3(0.05, 0, 0));
  input.measured_pose.translation.x() = kNan;
  const auto output = law.step(input, kDt);
  EXPECT_EQ(output.status, Status::kWaiting);
  EXPECT_FALSE(output.has_set_point);
}

TEST(VelocityIntegrator, StaleTwistIsZero) {
  VelocityIntegrator law({});
  auto input = command(Vector3(0.05, 0, 0));
  const auto before = law.step(input, kDt);
  input.stale = true;
  for (int i = 0; i < 1000; ++i) {  // the listing went on with the last twist for ever
    const auto output = law.step(input, kDt);
    EXPECT_EQ(output.status, Status::kStale);
    EXPECT_EQ(output.set_point.translation, before.set_point.translation);
  }
}

TEST(VelocityIntegrator, StallIntegratesAtMostOnePeriod) {
  VelocityIntegrator law({});
  const auto input = command(Vector3(0.05, 0, 0));
  const auto before = law.step(input, kDt);
  const auto output = law.step(input, 0.5);
  EXPECT_EQ(output.status, Status::kInvalidTimeStep);
  EXPECT_NEAR(output.set_point.translation.x() - before.set_point.translation.x(), 0.05 * kDt, 1e-15);
}

TEST(VelocityIntegrator, ClockStepMovesNothing) {
  VelocityIntegrator law({});
  const auto input = command(Vector3(0.05, 0, 0));
  const auto before = law.step(input, kDt);
  for (const Seconds dt : {-3600.0, 0.0, kNan, kInf}) {
    const auto output = law.step(input, dt);
    EXPECT_EQ(output.status, Status::kInvalidTimeStep);
    EXPECT_EQ(output.set_point.translation, before.set_point.translation);
  }
}

TEST(VelocityIntegrator, RestartBeginsAtMeasured) {
  VelocityIntegrator law({});
  follow(law, command(Vector3(0.05, 0, 0)), 50);
  law.reset();
  auto input = command(Vector3::Zero());
  input.measured_pose.translation = Vector3(-0.03, 0.01, -0.12);
  EXPECT_EQ(law.step(input, kDt).set_point.translation, input.measured_pose.translation);
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

TEST(VelocityIntegrator, JumpOfTheMeasuredPoseIsRefused) {
  VelocityIntegrator law({});
  auto input = command(Vector3::Zero());
  const auto before = law.step(input, kDt);
  input.measured_pose.translation.x() += 0.05;
  for (int i = 0; i < 5; ++i) {
    const auto output = law.step(input, kDt);
    EXPECT_EQ(output.status, Status::kInvalidInput);
    EXPECT_TRUE(output.measured_jumped);
    EXPECT_EQ(output.set_point.translation, before.set_point.translation);
  }
  EXPECT_EQ(law.step(command(Vector3::Zero()), kDt).status, Status::kOk);
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

TEST(VelocityIntegrator, NoStepIsLongerThanTheSpeedLimitWhateverHappens) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    RandomValues random(seed);
    VelocityIntegratorConfig config;
    config.shaft_through_rcm = seed % 2 == 1;
    config.measured_jump_m = seed % 4 < 2 ? 10.0 : 0.02;
    VelocityIntegrator law(config);
    auto input = command(Vector3::Zero());
    Pose previous;
    bool started = false;
    for (int i = 0; i < 150; ++i) {
      input.twist = random.twist(random.chance(0.2) ? 100.0 : 0.1, random.chance(0.2) ? 100.0 : 1.0);
      input.stale = random.chance(0.1);
      if (random.chance(0.1)) {
        input.measured_pose = random.pose(0.3);  // jumps
      } else {
        input.measured_pose.translation += random.vector(0.003);
      }
      if (random.chance(0.05)) {
        input.rcm = random.vector(0.1);
      }
      VelocityIntegratorInput faulty = input;
      if (random.chance(0.2)) {
        double* fields[] = {&faulty.twist.linear.x(),
                            &faulty.twist.angular.y(),
                            &faulty.measured_pose.rotation.x(),
                            &faulty.measured_pose.translation.z(),
                            &faulty.rcm.y(),
                            &faulty.max_speed_scale,
                            &faulty.approach_direction.x(),
                            &faulty.approach_speed_limit_m_s};
        const double values[] = {kNan, kInf, -kInf, 1e308};
        *fields[static_cast<int>(random.uniform(0, 8))] = values[static_cast<int>(random.uniform(0, 4))];
      }
      const double dts[] = {kDt, kDt, 0.003, 0.04, 0.0, kNan, 3.0};
      const Seconds dt = dts[static_cast<int>(random.uniform(0, 7))];
      const bool was_started = law.state().started;
      const auto output = law.step(faulty, dt);
      ASSERT_TRUE(is_valid(output.set_point));
      ASSERT_TRUE(std::isfinite(output.lead_m));
      if (started && was_started) {
        const Twist moved = displacement(previous, output.set_point);
        const double allowed = std::isfinite(dt) && dt > 0.0 ? (dt > config.dt_max_s ? kDt : dt) : 0.0;
        EXPECT_LE(moved.linear.norm(), 0.1 * allowed * (1 + 1e-9) + 1e-15);
        EXPECT_LE(moved.angular.norm(), 1.0 * allowed * (1 + 1e-6) + 1e-9);
      }
      started = output.has_set_point;
      previous = output.set_point;
    }
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

TEST(VelocityIntegrator, RefusesBadConfiguration) {
  VelocityIntegratorConfig config;
  config.cone_axis = Vector3(0, 0, -2);
  EXPECT_THROW(VelocityIntegrator{config}, ConfigError);
  config = {};
  config.insertion_min_m = 0.3;
  EXPECT_THROW(VelocityIntegrator{config}, ConfigError);
  config = {};
  config.cone_half_angle_rad = 1.6;
  EXPECT_THROW(VelocityIntegrator{config}, ConfigError);
  config = {};
  config.nominal_dt_s = 1.0;
  EXPECT_THROW(VelocityIntegrator{config}, ConfigError);
  config = {};
  config.speed_limit_m_s = kNan;
  EXPECT_THROW(VelocityIntegrator{config}, ConfigError);
}

}  // namespace
}  // namespace saras
