#include "saras/teleop/twist_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using test::kNan;
using test::RandomValues;

constexpr Seconds kDt = 0.01;

TEST(TwistEstimator, FirstPoseGivesNoTwist) {
  TwistEstimator estimator({});
  const auto output = estimator.step({RandomValues(1).pose(1.0)}, kDt);
  EXPECT_EQ(output.status, Status::kWaiting);
  EXPECT_EQ(to_vector(output.twist), Vector6::Zero());
}

TEST(TwistEstimator, TwistTimesIntervalIsTheDisplacement) {
  RandomValues random(2);
  TwistEstimator estimator({});
  Pose pose = random.pose(1.0);
  estimator.step({pose}, kDt);
  for (int i = 0; i < 2000; ++i) {
    const Seconds dt = random.uniform(1e-4, 0.5);
    const Pose next = add_delta(pose, random.twist(2.0, 3.0), dt);
    const auto output = estimator.step({next}, dt);
    EXPECT_EQ(output.status, Status::kOk);
    const Pose reached = add_delta(pose, output.twist, dt);
    EXPECT_LT(displacement(reached, next).linear.norm() + displacement(reached, next).angular.norm(), 1e-12);
    pose = next;
  }
}

TEST(TwistEstimator, QuaternionSignFlipIsNoMotion) {
  TwistEstimator estimator({});
  Pose pose{RandomValues(3).rotation(), Vector3::Zero()};
  estimator.step({pose}, kDt);
  pose.rotation.coeffs() *= -1.0;
  EXPECT_LT(to_vector(estimator.step({pose}, kDt).twist).norm(), 1e-12);
}

TEST(TwistEstimator, FilterReachesSixtyThreePercentAfterItsTimeConstantForAnyStep) {
  for (const Seconds dt : {1e-4, 1e-3, 1.0 / (2 * M_PI * 20.0)}) {
    TwistEstimator estimator({20.0, 0.5});
    Pose pose;
    estimator.step({pose}, dt);
    TwistEstimatorOutput output;
    for (Seconds t = 0.0; t < 1.0 / (2 * M_PI * 20.0) - 0.5 * dt; t += dt) {
      pose.translation.x() += 0.1 * dt;
      output = estimator.step({pose}, dt);
    }
    EXPECT_NEAR(output.twist_filtered.linear.x() / 0.1, 1.0 - std::exp(-1.0), 0.004);
  }
}

TEST(TwistEstimator, BadInputLeavesTheStateAsItWas) {
  TwistEstimator estimator({});
  Pose pose;
  estimator.step({pose}, kDt);
  Pose bad = pose;
  bad.translation.x() = kNan;
  EXPECT_EQ(estimator.step({bad}, kDt).status, Status::kInvalidInput);
  bad = pose;
  bad.rotation.coeffs() *= 1.1;
  EXPECT_EQ(estimator.step({bad}, kDt).status, Status::kInvalidInput);
  pose.translation.x() = 1e-3;
  for (const Seconds dt : {0.0, -kDt, kNan}) {
    EXPECT_EQ(estimator.step({pose}, dt).status, Status::kInvalidTimeStep);
  }
  EXPECT_NEAR(estimator.step({pose}, kDt).twist.linear.x(), 0.1, 1e-12);
}

TEST(TwistEstimator, AGapIsNotSqueezedIntoTheNextInterval) {
  TwistEstimator estimator({});
  Pose pose;
  estimator.step({pose}, kDt);
  pose.translation.x() = 0.05;
  EXPECT_EQ(estimator.step({pose}, 0.6).status, Status::kInvalidTimeStep);
  EXPECT_EQ(estimator.step({pose}, kDt).twist.linear.x(), 0.0);
}

TEST(TwistEstimator, ReplaysFromItsState) {
  RandomValues random(4);
  TwistEstimator first({});
  first.step({random.pose(1.0)}, kDt);
  first.step({random.pose(1.0)}, kDt);
  TwistEstimator second({});
  second.reset(first.state());
  const Pose pose = random.pose(1.0);
  const auto a = first.step({pose}, kDt);
  const auto b = second.step({pose}, kDt);
  EXPECT_EQ(to_vector(a.twist), to_vector(b.twist));
  EXPECT_EQ(to_vector(a.twist_filtered), to_vector(b.twist_filtered));
}

TEST(TwistEstimator, RefusesBadConfiguration) {
  EXPECT_THROW(TwistEstimator({0.0, 0.5}), ConfigError);
  EXPECT_THROW(TwistEstimator({20.0, kNan}), ConfigError);
}

}  // namespace
}  // namespace saras
