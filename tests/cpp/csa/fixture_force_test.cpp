#include "saras/csa/fixture_force.hpp"

#include <gtest/gtest.h>

#include "csa/fixture_rig.hpp"
#include "saras/spatial/errors.hpp"

namespace saras::csa {
namespace {

using test::RandomValues;
using test::teleop_fixture;

constexpr Seconds kDt = 0.001;

FixtureForceInput at(const Vector3& tip, const Vector3& hand_ahead = Vector3::Zero()) {
  FixtureForceInput input;
  input.base_T_tip.translation = tip;
  input.hand_ahead = hand_ahead;
  return input;
}

/// After the ramp.
FixtureForceOutput settled(FixtureForce& law, const FixtureForceInput& input) {
  FixtureForceOutput output;
  for (int i = 0; i < 300; ++i) {
    output = law.step(input, kDt);
  }
  return output;
}

TEST(FixtureForce, AWallPushesAndNeverPulls) {
  RandomValues random(1);
  for (int k = 0; k < 200; ++k) {
    const Vector3 normal = random.rotation() * Vector3::UnitX();
    FixtureForce law({}, {teleop_fixture("wall", PlaneFixture{random.vector(0.01), normal, 0.001})});
    for (int i = 0; i < 200; ++i) {
      FixtureForceInput input = at(random.vector(0.02), random.vector(0.02));
      input.word = {random.chance(0.9), random.chance(0.9)};
      const Vector3 force = law.step(input, kDt).wrench.force;
      ASSERT_GE(force.dot(normal), 0.0);
      ASSERT_LE(force.cross(normal).norm(), 1e-12) << "only along its normal";
    }
  }
}

TEST(FixtureForce, ItIsASpringFromItsStartOnUpToItsLimit) {
  FixtureForce law({}, {teleop_fixture("floor", test::plane(Vector3::Zero(), Vector3::UnitZ()))});
  EXPECT_EQ(settled(law, at({0, 0, 0.0031})).wrench.force, Vector3::Zero());
  EXPECT_NEAR(settled(law, at({0, 0, 0.001})).wrench.force.z(), 150.0 * 0.002, 1e-12);
  EXPECT_NEAR(settled(law, at({0, 0, 0.0}, {0, 0, -0.002})).wrench.force.z(), 150.0 * 0.005, 1e-12) << "the hand's";
  EXPECT_NEAR(settled(law, at({0, 0, 0.0}, {0, 0, 0.002})).wrench.force.z(), 150.0 * 0.003, 1e-12) << "the tip's";
  const FixtureForceOutput deep = settled(law, at({0, 0, -0.2}));
  EXPECT_NEAR(deep.wrench.force.z(), 1.5, 1e-12);
  EXPECT_EQ(deep.status, Status::kLimited);
  EXPECT_NEAR(deep.violation_m, 0.2, 1e-12);
  EXPECT_EQ(deep.nearest, 0);
  EXPECT_NEAR(deep.closest.norm(), 0.0, 1e-12);
}

TEST(FixtureForce, AHandBehindAThinWallIsNotPulledThrough) {
  const auto slab = test::box(Pose{}, Vector3(0.05, 0.05, 0.001), false);
  FixtureForce law({}, {teleop_fixture("slab", slab)});
  const Vector3 force = settled(law, at({0, 0, 0.001}, {0, 0, -0.02})).wrench.force;
  EXPECT_NEAR(force.z(), 1.5, 1e-12);
  EXPECT_LE(force.head<2>().norm(), 1e-12);
}

TEST(FixtureForce, ACornerPushesFromAllItsWalls) {
  const auto box = test::box(Pose{}, Vector3(0.02, 0.02, 0.02), true);
  FixtureForce law({}, {teleop_fixture("box", box)});
  const Vector3 force = settled(law, at({0.019, 0.019, 0.0})).wrench.force;
  EXPECT_NEAR(force.x(), -150.0 * 0.002, 1e-12);
  EXPECT_NEAR(force.y(), -150.0 * 0.002, 1e-12);
  EXPECT_NEAR(force.z(), 0.0, 1e-12);
}

TEST(FixtureForce, APathGuidesToItself) {
  RandomValues random(2);
  TeleopFixture guide = teleop_fixture("guide", PathFixture{{-Vector3::UnitX(), Vector3::UnitX()}, 0.001}, true);
  FixtureForce law({}, {guide});
  EXPECT_LE(settled(law, at({0.1, 0.0, 0.0})).wrench.force.norm(), 1e-12) << "on it: nothing";
  EXPECT_NEAR(settled(law, at({0.1, 0.003, 0.0})).wrench.force.y(), -150.0 * 0.003, 1e-9);
  EXPECT_NEAR(settled(law, at({0.1, 0.0, 0.0}, {0.0, 0.002, 0.0})).wrench.force.y(), -150.0 * 0.002, 1e-9);
  for (int k = 0; k < 500; ++k) {
    const Vector3 tip(0.0, random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02));
    const Vector3 force = settled(law, at(tip)).wrench.force;
    ASSERT_LE(force.dot(tip), 0.0);
    ASSERT_LE(force.norm(), 1.5 + 1e-12);
  }
}

TEST(FixtureForce, NothingThatHappensIsAStepOfForce) {
  RandomValues random(3);
  const auto fixtures = [&random] {
    std::vector<TeleopFixture> made = test::walls(random, 0.005);
    made.push_back(teleop_fixture("ball", MeshFixture{test::ball(0.01, 2), true, 0.0, 0.005}));
    made.push_back(teleop_fixture("block", test::box(random.pose(0.005), Vector3(0.002, 0.001, 0.002), false)));
    made.push_back(teleop_fixture("path", PathFixture{{Vector3::Zero(), Vector3(0.01, 0, 0)}, 0.001}, true));
    return made;
  };
  FixtureForceConfig config;
  config.force_limit_N = 2.0;
  for (int k = 0; k < 30; ++k) {
    FixtureForce law(config, fixtures());
    Vector3 before = Vector3::Zero();
    for (int i = 0; i < 300; ++i) {
      if (i % 100 == 99) {  // another set takes over
        FixtureForceState state = law.state();
        state.fixtures = {};
        law = FixtureForce(config, fixtures());
        law.reset(state);
      }
      FixtureForceInput input = at(random.vector(0.012), random.vector(0.01));
      input.word = {random.chance(0.8), random.chance(0.9)};
      input.base_T_tip.translation.x() *= random.chance(0.05) ? test::kNan : 1.0;
      const double dt = random.uniform(1e-4, 0.01);
      const FixtureForceOutput output = law.step(input, dt);
      ASSERT_LE((output.wrench.force - before).norm(), 2.0 / 0.1 * dt + 1e-12);
      ASSERT_LE(output.wrench.force.norm(), 2.0 + 1e-12);
      if (!input.word.known || !is_finite(input.base_T_tip.translation)) {
        ASSERT_TRUE(std::isnan(output.distance_m[0])) << "unknown is not shown as safe";
        ASSERT_GE(output.status, Status::kStale);
      }
      before = output.wrench.force;
    }
  }
}

TEST(FixtureForce, WhatIsUnknownOrOffFades) {
  FixtureForce law({}, {teleop_fixture("floor", test::plane(Vector3::Zero(), Vector3::UnitZ()))});
  for (const FixtureWord word : {FixtureWord{false, true}, FixtureWord{true, false}, FixtureWord{false, false}}) {
    ASSERT_GT(settled(law, at({0, 0, -0.01})).wrench.force.z(), 1.0);
    FixtureForceInput input = at({0, 0, -0.01});
    input.word = word;
    const FixtureForceOutput output = settled(law, input);
    EXPECT_EQ(output.wrench.force, Vector3::Zero());
    EXPECT_EQ(output.status, word.known ? Status::kWaiting : Status::kStale);
    EXPECT_EQ(std::isnan(output.distance_m[0]), !word.known);
  }
  EXPECT_EQ(law.step(at({0, 0, -0.01}), 1.0).status, Status::kInvalidTimeStep);
  EXPECT_EQ(law.step(at({0, 0, -0.01}), test::kNan).wrench.force, Vector3::Zero());
  FixtureForce none({}, {});
  EXPECT_EQ(none.step(at(Vector3::Zero()), kDt).status, Status::kWaiting);
}

TEST(FixtureForce, RefusesWhatIsNoLimit) {
  FixtureForceConfig config;
  config.ramp_s = 0.0;
  EXPECT_THROW(FixtureForce(config, {}), ConfigError);
  config = {};
  config.force_limit_N = test::kInf;
  EXPECT_THROW(FixtureForce(config, {}), ConfigError);
}

}  // namespace
}  // namespace saras::csa
