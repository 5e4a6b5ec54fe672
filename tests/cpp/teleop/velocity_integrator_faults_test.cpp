// Stale, non-finite, late and stalled input of VelocityIntegrator, and refused configurations.
#include <gtest/gtest.h>

#include <cmath>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/teleop/velocity_integrator.hpp"
#include "support/random_values.hpp"
#include "teleop/velocity_integrator_rig.hpp"

namespace saras {
namespace {

using test::command;
using test::follow;
using test::kDt;
using test::kInf;
using test::kNan;
using test::RandomValues;

TEST(VelocityIntegratorFaults, WaitsForAMeasuredPose) {
  VelocityIntegrator law({});
  auto input = command(Vector3(0.05, 0, 0));
  input.measured_pose.translation.x() = kNan;
  const auto output = law.step(input, kDt);
  EXPECT_EQ(output.status, Status::kWaiting);
  EXPECT_FALSE(output.has_set_point);
}

TEST(VelocityIntegratorFaults, StaleTwistIsZero) {
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

TEST(VelocityIntegratorFaults, StallIntegratesAtMostOnePeriod) {
  VelocityIntegrator law({});
  const auto input = command(Vector3(0.05, 0, 0));
  const auto before = law.step(input, kDt);
  const auto output = law.step(input, 0.5);
  EXPECT_EQ(output.status, Status::kInvalidTimeStep);
  EXPECT_NEAR(output.set_point.translation.x() - before.set_point.translation.x(), 0.05 * kDt, 1e-15);
}

TEST(VelocityIntegratorFaults, ClockStepMovesNothing) {
  VelocityIntegrator law({});
  const auto input = command(Vector3(0.05, 0, 0));
  const auto before = law.step(input, kDt);
  for (const Seconds dt : {-3600.0, 0.0, kNan, kInf}) {
    const auto output = law.step(input, dt);
    EXPECT_EQ(output.status, Status::kInvalidTimeStep);
    EXPECT_EQ(output.set_point.translation, before.set_point.translation);
  }
}

TEST(VelocityIntegratorFaults, RestartBeginsAtMeasured) {
  VelocityIntegrator law({});
  follow(law, command(Vector3(0.05, 0, 0)), 50);
  law.reset();
  auto input = command(Vector3::Zero());
  input.measured_pose.translation = Vector3(-0.03, 0.01, -0.12);
  EXPECT_EQ(law.step(input, kDt).set_point.translation, input.measured_pose.translation);
}

TEST(VelocityIntegratorFaults, JumpOfTheMeasuredPoseIsRefused) {
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

TEST(VelocityIntegratorFaults, NoStepIsLongerThanTheSpeedLimitWhateverHappens) {
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

TEST(VelocityIntegratorFaults, RefusesBadConfiguration) {
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
