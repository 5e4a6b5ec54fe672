#include "saras/teleop/disturbance_observer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "saras/spatial/errors.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using test::kNan;
using test::RandomValues;

constexpr Seconds kDt = 0.01;

/// The servo that the observer models, by small semi-implicit Euler steps.
struct Servo {
  Vector3 position = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();

  void step(const Vector3& set_point, const Vector3& external_force, Seconds dt) {
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
      velocity += (3600.0 * (set_point - position) - 120.0 * velocity + external_force / 2.0) * (dt / kSteps);
      position += velocity * (dt / kSteps);
    }
  }
};

TEST(DisturbanceObserver, FreeMotionGivesNoForceInEitherDirection) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    RandomValues random(seed);
    DisturbanceObserverConfig config;
    config.deadband_N = 0.0;
    DisturbanceObserver observer(config);
    Servo servo;
    Vector3 set_point = Vector3::Zero();
    Vector3 velocity = Vector3::Zero();
    observer.step({set_point, servo.position, false}, kDt);
    for (int i = 0; i < 100; ++i) {
      velocity = i % 20 == 0 ? random.vector(0.1) : velocity;
      const Seconds dt = random.uniform(0.005, 0.02);
      set_point += velocity * dt;
      servo.step(set_point, Vector3::Zero(), dt);
      const auto output = observer.step({set_point, servo.position, false}, dt);
      EXPECT_LT(output.wrench.force.norm(), 0.01);  // Euler's error; the lag alone would pass for 24 N
    }
  }
}

TEST(DisturbanceObserver, WrenchIsWhatTheTipExertsOnTheTissue) {
  DisturbanceObserver observer({});
  Servo servo;
  observer.step({}, kDt);
  DisturbanceObserverOutput output;
  const Vector3 reaction(0, 0, 3.0);  // tissue pushes the tip up
  for (int i = 0; i < 100; ++i) {
    servo.step(Vector3::Zero(), reaction, kDt);
    output = observer.step({Vector3::Zero(), servo.position, false}, kDt);
  }
  EXPECT_EQ(output.status, Status::kOk);
  EXPECT_LT((output.wrench.force + reaction).norm(), 1e-3);
  EXPECT_EQ(output.wrench.torque, Vector3::Zero());
}

TEST(DisturbanceObserver, AnySequenceOfFaultsStaysFinite) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    RandomValues random(seed);
    DisturbanceObserver observer({});
    for (int i = 0; i < 100; ++i) {
      DisturbanceObserverInput input{random.vector(0.1), random.vector(0.1), random.chance(0.1)};
      if (random.chance(0.2)) {
        (random.chance(0.5) ? input.set_point : input.measured).y() = random.chance(0.5) ? kNan : 1e308;
      }
      const double dts[] = {kDt, kDt, kDt, 0.0, kNan, 3.0};
      const auto output = observer.step(input, dts[static_cast<int>(random.uniform(0, 6))]);
      ASSERT_TRUE(is_finite(output.wrench));
      ASSERT_EQ(output.has_wrench, output.status == Status::kOk);
    }
  }
}

TEST(DisturbanceObserver, RefusesBadConfiguration) {
  DisturbanceObserverConfig config;
  config.mass_kg = 0.0;
  EXPECT_THROW(DisturbanceObserver{config}, ConfigError);
}

}  // namespace
}  // namespace saras
