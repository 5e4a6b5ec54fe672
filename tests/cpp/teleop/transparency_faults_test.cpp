// Stale, non-finite, late and stalled input of Transparency, and refused configurations.
#include <gtest/gtest.h>

#include <cmath>

#include "saras/spatial/errors.hpp"
#include "saras/teleop/transparency.hpp"
#include "support/random_values.hpp"
#include "teleop/transparency_rig.hpp"

namespace saras {
namespace {

using test::at_rest;
using test::engaged;
using test::kDt;
using test::kNan;
using test::RandomValues;
using test::without_limits;

TEST(TransparencyFaults, StaleInputStopsTheSlaveAndFadesTheForce) {
  auto law = engaged(without_limits());
  auto input = at_rest();
  input.master_pose.translation.x() = 0.02;
  input.master_twist.linear.x() = 0.2;
  const double before = law.step(input, kDt).desired_wrench.force.norm();
  input.stale = true;
  for (int i = 1; i <= 12; ++i) {
    const auto output = law.step(input, kDt);
    EXPECT_EQ(output.status, Status::kStale);
    EXPECT_EQ(to_vector(output.desired_twist), Vector6::Zero());
    EXPECT_NEAR(output.desired_wrench.force.norm(), before * std::max(0.0, 1.0 - i * kDt / 0.1), 1e-12);
  }
  EXPECT_TRUE(law.state().has_reference);
}

TEST(TransparencyFaults, TimeStepThatIsNoneGivesZero) {
  auto law = engaged(without_limits());
  auto input = at_rest();
  input.master_pose.translation.x() = 0.02;
  input.master_twist.linear.x() = 0.2;
  for (const Seconds dt : {0.0, -kDt, kNan, 0.5}) {
    const auto output = law.step(input, dt);
    EXPECT_EQ(output.status, Status::kInvalidTimeStep);
    EXPECT_EQ(to_vector(output.desired_twist).norm() + to_vector(output.desired_wrench).norm(), 0.0);
  }
}

TEST(TransparencyFaults, ForceModeWithoutContactForceIsRefusedAndMotionGoesOn) {
  auto config = without_limits();
  config.mode = TransparencyMode::kPositionForce;
  auto law = engaged(config);
  auto input = at_rest();
  input.master_twist.linear.x() = 0.2;
  input.tissue_wrench.force.setConstant(kNan);
  const auto output = law.step(input, kDt);
  EXPECT_EQ(output.status, Status::kInvalidInput);
  EXPECT_EQ(to_vector(output.desired_wrench), Vector6::Zero());
  EXPECT_NEAR(output.desired_twist.linear.x(), 0.1, 1e-12);
  config.mode = TransparencyMode::kPositionPosition;
  auto without_force = engaged(config);
  EXPECT_EQ(without_force.step(input, kDt).status, Status::kOk);
}

TEST(TransparencyFaults, AnySequenceOfFaultsStaysFiniteAndBounded) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    RandomValues random(seed);
    TransparencyConfig config;
    config.mode = static_cast<TransparencyMode>(seed % 3);
    Transparency law(config);
    Wrench previous;
    for (int i = 0; i < 100; ++i) {
      TransparencyInput input{random.pose(0.1),       random.twist(0.5, 2.0), random.pose(0.1),
                              random.twist(0.5, 2.0), random.wrench(5, 0.1),  random.vector(0.1),
                              random.chance(0.2),     random.chance(0.1),     {},
                              random.wrench(5, 0.1)};
      if (random.chance(0.3)) {
        double* fields[] = {&input.master_pose.translation.x(), &input.master_twist.angular.y(),
                            &input.slave_pose.rotation.w(),     &input.slave_twist.linear.z(),
                            &input.tissue_wrench.force.x(),     &input.rcm.y()};
        *fields[static_cast<int>(random.uniform(0, 6))] = random.chance(0.5) ? kNan : 1e308;
      }
      const double dts[] = {kDt, kDt, kDt, kDt, 0.0, kNan, 3.0};
      const auto output = law.step(input, dts[static_cast<int>(random.uniform(0, 7))]);
      ASSERT_TRUE(is_finite(output.desired_wrench) && is_finite(output.desired_twist) && output.error.allFinite());
      EXPECT_LE(output.desired_wrench.force.norm(), config.force_limit_N * (1 + 1e-12));
      EXPECT_LE(output.desired_wrench.torque.norm(), config.torque_limit_Nm * (1 + 1e-12));
    }
  }
}

TEST(TransparencyFaults, RefusesBadConfiguration) {
  for (const double bad : {0.0, -0.5, 11.0, kNan}) {
    TransparencyConfig config;
    config.scale = bad;
    EXPECT_THROW(Transparency{config}, ConfigError);
  }
  TransparencyConfig config;
  config.damping_N_s_m = -1.0;  // damping of the wrong sign
  EXPECT_THROW(Transparency{config}, ConfigError);
}

}  // namespace
}  // namespace saras
