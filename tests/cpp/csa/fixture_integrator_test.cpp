#include "saras/csa/fixture_integrator.hpp"

#include <gtest/gtest.h>

#include "csa/fixture_rig.hpp"

namespace saras::csa {
namespace {

using test::RandomValues;
using test::teleop_fixture;

constexpr Seconds kDt = 0.001;
const Vector3 kTip(0.0, 0.0, -0.1);  // below a trocar at the origin

VelocityIntegratorConfig config() {
  VelocityIntegratorConfig config;
  config.shaft_through_rcm = true;
  config.nominal_dt_s = kDt;  // of the first step
  return config;
}

FixtureIntegratorInput command(const Vector3& linear) {
  FixtureIntegratorInput input;
  input.motion.twist.linear = linear;
  input.motion.measured_pose = {Quaternion(0, 1, 0, 0), kTip};
  return input;
}

/// Walls, a block and a path's tube around the tip.
std::vector<TeleopFixture> around_the_tip(RandomValues& random) {
  std::vector<TeleopFixture> made;
  for (int i = 0; i < 4; ++i) {
    const Vector3 normal = random.rotation() * Vector3::UnitX();
    made.push_back(teleop_fixture("wall " + std::to_string(i),
                                  PlaneFixture{kTip - random.uniform(0.001, 0.02) * normal, normal, 0.0005}));
  }
  made.push_back(teleop_fixture(
      "block", test::box({random.rotation(), kTip + Vector3(0, 0, 0.012)}, Vector3(0.003, 0.005, 0.002), false)));
  return made;
}

TEST(FixtureIntegrator, NoCommandTakesTheSetPointBeyondAWall) {
  RandomValues random(1);
  int held = 0;
  for (int k = 0; k < 60; ++k) {
    const std::vector<TeleopFixture> fixtures = around_the_tip(random);
    FixtureIntegrator law(config(), fixtures);
    FixtureSet judge = hard_fixture_set(fixtures);
    FixtureIntegratorInput input = command(Vector3::Zero());
    const double dt = random.chance(0.5) ? 0.001 : 0.01;
    Vector3 before = kTip;
    Vector3 heading = random.vector(0.1);
    for (int i = 0; i < 1000; ++i) {
      if (random.chance(0.02)) {
        heading = random.vector(0.15);
      }
      input.motion.twist = {heading, random.vector(1.0)};
      input.motion.approach_direction = Vector3::UnitY();
      input.motion.approach_speed_limit_m_s = 0.02;
      const VelocityIntegratorOutput output = law.step(input, dt);
      const Vector3 at = output.set_point.translation;
      FixtureInput place;
      place.base_T_tip.translation = at;
      judge.reset();  // no face is kept to
      const FixtureOutput found = judge.step(place, dt);
      for (std::size_t f = 0; f < judge.fixtures().size(); ++f) {
        ASSERT_GE(found.distance_m[f], -FixtureBound::kBeyond_m - 1e-9) << judge.fixtures()[f].name;
      }
      // What the integrator promises holds on.
      ASSERT_LE((at - before).norm(), 0.1 * dt + 1e-8);
      if (!output.lead_limited && !output.cone_limited && !output.insertion_limited) {  // these may pull faster
        ASSERT_LE((at - before).y(), 0.02 * dt + 1e-8);
      }
      const Vector3& measured = input.motion.measured_pose.translation;
      ASSERT_LE((at - measured).norm(), std::max(0.01, (before - measured).norm()) + 1e-8);
      const Vector3 shaft = at;
      ASSERT_LE(shaft.norm(), 0.2 + 1e-6);
      ASSERT_GE(shaft.norm(), 0.03 - 1e-4);
      ASSERT_LE(std::acos(-shaft.normalized().z()), config().cone_half_angle_rad + 1e-5);
      held += output.fixture_limited ? 1 : 0;
      before = at;
      // The arm lags, and now and then something pushes it through a wall.
      input.motion.measured_pose.translation += 0.2 * (at - measured);
      if (random.chance(0.003)) {
        input.motion.measured_pose.translation += random.vector(0.004);
      }
      input.motion.measured_pose.rotation = output.set_point.rotation;
    }
  }
  EXPECT_GT(held, 1000);
}

TEST(FixtureIntegrator, TheShaftStillPassesTheTrocar) {
  FixtureIntegrator law(config(), {teleop_fixture("wall", PlaneFixture{kTip, -Vector3::UnitX(), 0.0})});
  FixtureIntegratorInput input = command(Vector3(0.05, 0.03, 0.0));
  for (int i = 0; i < 300; ++i) {
    const VelocityIntegratorOutput output = law.step(input, kDt);
    const Vector3 along = output.set_point.rotation * Vector3::UnitZ();
    ASSERT_LE(along.cross(output.set_point.translation.normalized()).norm(), 1e-6);
    ASSERT_TRUE(output.fixture_limited);
    ASSERT_EQ(output.status, Status::kLimited);
    input.motion.measured_pose = output.set_point;
  }
  EXPECT_NEAR(law.state().integrator.set_point.translation.y(), 0.03 * 0.3, 1e-6) << "it slides along";
}

TEST(FixtureIntegrator, WithoutAHardOneOrOffItIsTheVelocityIntegrator) {
  RandomValues random(2);
  for (int k = 0; k < 20; ++k) {
    std::vector<TeleopFixture> fixtures = around_the_tip(random);
    const bool off = k % 2 == 0;
    for (TeleopFixture& each : fixtures) {
      each.fixture.soft = !off;
    }
    FixtureIntegrator law(config(), fixtures);
    VelocityIntegrator plain(config());
    FixtureIntegratorInput input = command(Vector3::Zero());
    input.word.on = !off;
    for (int i = 0; i < 300; ++i) {
      input.motion.twist = random.twist(0.12, 1.0);
      const VelocityIntegratorOutput one = law.step(input, kDt);
      const VelocityIntegratorOutput other = plain.step(input.motion, kDt);
      ASSERT_EQ(one.set_point.translation, other.set_point.translation);
      ASSERT_EQ(one.set_point.rotation.coeffs(), other.set_point.rotation.coeffs());
      ASSERT_EQ(one.status, other.status);
      input.motion.measured_pose = one.set_point;
    }
  }
}

TEST(FixtureIntegrator, OfWallsNobodyKnowsWhereTheSetPointStands) {
  RandomValues random(3);
  FixtureIntegrator law(config(), around_the_tip(random));
  FixtureIntegratorInput input = command(Vector3(0.0, 0.0, 0.0));
  const Vector3 start = law.step(input, kDt).set_point.translation;
  input.word.known = false;
  for (int i = 0; i < 100; ++i) {
    input.motion.twist = random.twist(0.1, 1.0);
    input.motion.measured_pose.translation += random.vector(1e-4);
    const VelocityIntegratorOutput output = law.step(input, kDt);
    ASSERT_EQ(output.set_point.translation, start);
    ASSERT_EQ(output.status, Status::kStale);
  }
}

TEST(FixtureIntegrator, AStateIsAValue) {
  RandomValues random(4);
  const std::vector<TeleopFixture> fixtures = around_the_tip(random);
  FixtureIntegrator one(config(), fixtures);
  FixtureIntegrator other(config(), fixtures);
  FixtureIntegratorInput input = command(Vector3::Zero());
  for (int i = 0; i < 500; ++i) {
    input.motion.twist = random.twist(0.1, 1.0);
    input.word = {random.chance(0.95), random.chance(0.95)};
    if (i % 50 == 25) {
      other = FixtureIntegrator(config(), fixtures);
      other.reset(one.state());
    }
    const VelocityIntegratorOutput a = one.step(input, kDt);
    const VelocityIntegratorOutput b = other.step(input, kDt);
    ASSERT_EQ(a.set_point.translation, b.set_point.translation);
    ASSERT_EQ(one.state().fixtures.feature, other.state().fixtures.feature);
    input.motion.measured_pose = a.set_point;
  }
}

}  // namespace
}  // namespace saras::csa
