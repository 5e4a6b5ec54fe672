#include "saras/csa/fixture_bound.hpp"

#include <gtest/gtest.h>

#include "csa/fixture_rig.hpp"
#include "saras/spatial/errors.hpp"

namespace saras::csa {
namespace {

using test::RandomValues;
using test::teleop_fixture;

constexpr double kAtBorder = FixtureBound::kBeyond_m + 1e-9;

double plane_distance(const TeleopFixture& wall, const Vector3& at) {
  const auto& plane = std::get<PlaneFixture>(wall.fixture.geometry);
  return plane.normal.dot(at - plane.point) - plane.margin_m;
}

double from_path(const PathFixture& path, const Vector3& at) {
  double least = test::kInf;
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const Vector3 along = path.points[i + 1] - path.points[i];
    const double t = std::clamp(along.dot(at - path.points[i]) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (path.points[i] + t * along - at).norm());
  }
  return least;
}

TEST(FixtureBound, SeveralWallsAtOnceGiveTheNearestAllowedPlace) {
  RandomValues random(1);
  for (int k = 0; k < 2000; ++k) {
    const std::vector<TeleopFixture> walls = test::walls(random, 0.01);
    FixtureBound bound(walls);
    const Vector3 wanted = random.vector(0.03);
    const Vector3 next = bound.bound(Vector3::Zero(), wanted);
    const auto allowed = [&](const Vector3& at) {
      return std::all_of(walls.begin(), walls.end(), [&](const auto& wall) { return plane_distance(wall, at) >= 0.0; });
    };
    for (const TeleopFixture& wall : walls) {
      ASSERT_GE(plane_distance(wall, next), -1e-9);
    }
    if (allowed(wanted)) {
      ASSERT_EQ(next, wanted);
    }
    // Of an allowed convex set: the angle at the nearest point towards any other one is not below a right one.
    for (int i = 0; i < 200; ++i) {
      const Vector3 other = next + random.vector(0.01);
      if (allowed(other)) {
        ASSERT_LE((wanted - next).dot(other - next), 1e-9 * 0.03);
      }
    }
  }
}

TEST(FixtureBound, NoWalkPassesAWallHoweverLongItsSteps) {
  RandomValues random(2);
  for (int k = 0; k < 60; ++k) {
    const double step_m = std::pow(10.0, random.uniform(-5.0, -2.0));
    std::vector<TeleopFixture> fixtures = test::walls(random, 0.02);
    const PathFixture path{{Vector3(-0.02, 0, 0), Vector3(0.005, 0, 0), Vector3(0.005, 0.02, 0.004)}, 0.004};
    const auto mesh = test::ball(0.006, 3);
    const Pose in{random.rotation(), Vector3::Zero()};
    const Pose out{random.rotation(), Vector3(0.0, 0.0, 0.012)};
    fixtures.push_back(teleop_fixture("box", test::box(in, Vector3(0.02, 0.015, 0.012), true)));
    fixtures.push_back(teleop_fixture("block", test::box(out, Vector3(0.004, 0.003, 0.002), false)));
    if (k % 3 == 0) {
      fixtures.push_back(teleop_fixture("path", path));
    } else if (k % 3 == 1) {
      fixtures.push_back(teleop_fixture("ball", MeshFixture{mesh, true, 0.0, 0.005}));
    }
    fixtures.push_back(teleop_fixture("guide", PathFixture{{Vector3::UnitX(), Vector3::UnitY()}, 0.001}, true));
    FixtureBound bound(fixtures);
    FixtureSet judge = hard_fixture_set(fixtures);
    Vector3 at = Vector3::Zero();
    Vector3 heading = random.rotation() * Vector3::UnitX();
    for (int i = 0; i < 500; ++i) {
      if (random.chance(0.05)) {
        heading = random.rotation() * Vector3::UnitX();
      }
      const Vector3 next = bound.bound(at, at + step_m * heading);
      ASSERT_LE((next - at).norm(), step_m + 1e-9) << "never further than asked";
      at = next;
      FixtureInput place;
      place.base_T_tip.translation = at;
      judge.reset();  // no face is kept to
      const FixtureOutput found = judge.step(place, 0.001);
      for (std::size_t f = 0; f < judge.fixtures().size(); ++f) {
        ASSERT_GE(found.distance_m[f], -kAtBorder) << judge.fixtures()[f].name << ", step " << step_m;
      }
      if (k % 3 == 0) {
        ASSERT_LE(from_path(path, at), path.radius_m + kAtBorder);
      }
    }
  }
}

TEST(FixtureBound, AnAllowedWayIsFree) {
  RandomValues random(3);
  const std::vector<TeleopFixture> fixtures = {
      teleop_fixture("path", PathFixture{{Vector3(-0.02, 0, 0), Vector3(0, 0, 0), Vector3(0, 0.02, 0)}, 0.002})};
  FixtureBound bound(fixtures);
  Vector3 at(-0.02, 0.0, 0.0);
  for (int i = 0; i < 100; ++i) {  // along the path, round its corner
    const Vector3 along = i < 40 ? Vector3::UnitX() : Vector3::UnitY();
    const Vector3 wanted = at + 0.0005 * along;
    const Vector3 next = bound.bound(at, wanted);
    if (i < 78) {
      ASSERT_EQ(next, wanted) << i;
    }
    at = next;
  }
  EXPECT_NEAR(at.y(), 0.022, 1e-4) << "held at its end";
}

TEST(FixtureBound, APassedBorderMovesNothingByItselfAndLetsNothingFurtherOut) {
  RandomValues random(4);
  const std::vector<TeleopFixture> fixtures = {teleop_fixture("floor", test::plane(Vector3::Zero(), Vector3::UnitZ())),
                                               teleop_fixture("ball", MeshFixture{test::ball(0.02, 2), true})};
  FixtureBound bound(fixtures);
  const Vector3 outside(0.004, 0.0, -0.004);
  EXPECT_EQ(bound.bound(outside, outside), outside);
  Vector3 at = outside;
  for (int i = 0; i < 300; ++i) {
    const Vector3 next = bound.bound(at, at + random.vector(0.0005));
    ASSERT_GE(next.z(), std::min(at.z(), 0.0) - 1e-8);
    at = next;
  }
}

TEST(FixtureBound, WhatIsNoPlaceIsGivenBack) {
  FixtureBound bound({teleop_fixture("floor", test::plane(Vector3::Zero(), Vector3::UnitZ()))});
  EXPECT_FALSE(bound.bound(Vector3::Zero(), Vector3(test::kNan, 0, 0)).allFinite());
  EXPECT_EQ(bound.bound(Vector3::UnitZ(), Vector3::UnitX()), Vector3::UnitX());
}

TEST(TeleopFixture, ItsNumbersGiveItBack) {
  RandomValues random(5);
  const FixtureGeometry all[] = {PlaneFixture{Vector3(1, 2, 3), Vector3::UnitY(), 0.1},
                                 LineFixture{Vector3(1, 2, 3), Vector3::UnitX(), 0.2},
                                 PathFixture{{Vector3(1, 2, 3), Vector3(3, 2, 1), Vector3(0, 0, 1)}, 0.3},
                                 RemoteCentreFixture{Vector3(1, 2, 3), 0.4},
                                 test::box(random.pose(0.1), Vector3(1, 2, 3), false),
                                 MeshFixture{test::ball(0.02, 1), true, 0.5, 0.01}};
  for (const FixtureGeometry& geometry : all) {
    const int kind = static_cast<int>(geometry.index());
    const std::vector<double> numbers = to_numbers(geometry);
    const FixtureGeometry again = to_geometry(kind, numbers);
    EXPECT_EQ(again.index(), geometry.index());
    EXPECT_EQ(to_numbers(again), numbers);
    std::vector<double> shorter = numbers;
    shorter.pop_back();
    EXPECT_THROW(to_geometry(kind, shorter), ConfigError) << kind;
  }
  EXPECT_THROW(to_geometry(6, {}), ConfigError);
  EXPECT_THROW(to_geometry(4, {1, 0, 0, 1e300}), ConfigError);
  EXPECT_THROW(teleop_fixture("x", RemoteCentreFixture{}).validate(), ConfigError);
  TeleopFixture bad = teleop_fixture("x", PlaneFixture{});
  bad.stiffness_N_m = test::kNan;
  EXPECT_THROW(bad.validate(), ConfigError);
  EXPECT_THROW(FixtureBound({teleop_fixture("x", PlaneFixture{}), teleop_fixture("x", PlaneFixture{})}), ConfigError);
}

}  // namespace
}  // namespace saras::csa
