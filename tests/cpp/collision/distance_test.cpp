#include "saras/collision/distance.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using test::kInf;
using test::kNan;

Parallelepiped box(const Vector3& center, const Vector3& size) {
  return {center - 0.5 * size, {size.x(), 0, 0}, {0, size.y(), 0}, {0, 0, size.z()}};
}

/// Witnesses, normal and distance belong together, whatever the pair.
void expect_consistent(const SignedDistance& d) {
  ASSERT_NE(d.status, DistanceStatus::kUnknown);
  EXPECT_NEAR(d.normal.norm(), 1.0, 1e-12);
  EXPECT_NEAR((d.point_a + d.distance_m * d.normal - d.point_b).norm(), 0.0, 1e-12);
}

TEST(CapsuleCapsule, ApartNormalPointsFromAToB) {
  const SignedDistance d = distance(Capsule{{0, 0, 0}, {0, 0, 1}, 0.1}, Capsule{{1, -1, 0.5}, {1, 1, 0.5}, 0.2});
  expect_consistent(d);
  EXPECT_NEAR(d.distance_m, 0.7, 1e-15);
  EXPECT_NEAR((d.point_a - Vector3(0.1, 0, 0.5)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((d.point_b - Vector3(0.8, 0, 0.5)).norm(), 0.0, 1e-15);
  EXPECT_EQ(d.status, DistanceStatus::kSeparated);
}

TEST(CapsuleCapsule, CrossingAxesNormalIsPerpendicularToBoth) {
  const SignedDistance d = distance(Capsule{{-1, 0, 0}, {1, 0, 0}, 0.1}, Capsule{{0, -1, 0}, {0, 1, 0}, 0.2});
  expect_consistent(d);
  EXPECT_NEAR(d.distance_m, -0.3, 1e-15);
  EXPECT_NEAR(std::abs(d.normal.z()), 1.0, 1e-15);
  EXPECT_EQ(d.status, DistanceStatus::kPenetrating);
}

TEST(CapsuleCapsule, ParallelWitnessesAreInTheMiddleOfTheOverlap) {
  const SignedDistance d = distance(Capsule{{0, 0, 0}, {0, 0, 1}, 0.1}, Capsule{{1, 0, 3}, {1, 0, 0.5}, 0.1});
  expect_consistent(d);
  EXPECT_NEAR(d.distance_m, 0.8, 1e-15);
  EXPECT_NEAR(d.point_a.z(), 0.75, 1e-15);
}

TEST(CapsuleCapsule, Touching) {
  EXPECT_EQ(distance(Capsule{{0, 0, 0}, {0, 0, 1}, 0.1}, Capsule{{0.3, 0, 0}, {0.3, 0, 1}, 0.2}).status,
            DistanceStatus::kTouching);
}

// Zero length, zero radius, coincident, collinear: ordinary input.
TEST(CapsuleCapsule, DegenerateOnesAreOrdinary) {
  const Vector3 o = Vector3::Zero();
  const Vector3 z = Vector3::UnitZ();
  const struct {
    Capsule a;
    Capsule b;
    double distance;
  } cases[] = {
      {{o, o, 0.1}, {o, o, 0.2}, -0.3},
      {{o, o, 0.0}, {o, o, 0.0}, 0.0},
      {{o, z, 0.1}, {o, z, 0.1}, -0.2},
      {{o, z, 0.1}, {z, o, 0.1}, -0.2},
      {{o, z, 0.1}, {z, 2 * z, 0.1}, -0.2},
      {{o, z, 0.1}, {2 * z, 3 * z, 0.1}, 0.8},
      {{o, z, 0.1}, {0.5 * z, 0.5 * z, 0}, -0.1},
      {{o, o, 0.1}, {z, z, 0.2}, 0.7},
      {{o, z, 0.0}, {0.5 * z, 0.7 * z, 0.0}, 0.0},
  };
  for (const auto& c : cases) {
    const SignedDistance d = distance(c.a, c.b);
    expect_consistent(d);
    EXPECT_NEAR(d.distance_m, c.distance, 1e-15);
    // The translation that it names separates.
    const Vector3 move = d.distance_m * d.normal;
    EXPECT_NEAR(distance({c.a.a + move, c.a.b + move, c.a.radius_m}, c.b).distance_m, 0.0, 1e-12);
  }
}

TEST(CapsuleBox, OutsideFaceEdgeCorner) {
  const Parallelepiped b = box(Vector3::Zero(), {2, 2, 2});
  EXPECT_NEAR(distance(Capsule{{0, 0, 1.5}, {0.5, 0, 3}, 0.1}, b).distance_m, 0.4, 1e-15);
  EXPECT_NEAR(distance(Capsule{{2, 2, -5}, {2, 2, 5}, 0.1}, b).distance_m, std::sqrt(2.0) - 0.1, 1e-15);
  EXPECT_NEAR(distance(Capsule{{2, 2, 2}, {3, 4, 5}, 0.1}, b).distance_m, std::sqrt(3.0) - 0.1, 1e-15);
}

TEST(CapsuleBox, ParallelToAFaceWitnessIsInTheMiddleOfTheOverlap) {
  const SignedDistance d = distance(Capsule{{0, 0, 2}, {5, 0, 2}, 0.0}, box(Vector3::Zero(), {2, 2, 2}));
  expect_consistent(d);
  EXPECT_NEAR((d.point_b - Vector3(0.5, 0, 1)).norm(), 0.0, 1e-14);
}

TEST(CapsuleBox, AxisOutsideButWithinTheRadius) {
  const SignedDistance d = distance(Capsule{{0, 0, 1.05}, {0, 0, 2}, 0.1}, box(Vector3::Zero(), {2, 2, 2}));
  expect_consistent(d);
  EXPECT_NEAR(d.distance_m, -0.05, 1e-15);
  EXPECT_NEAR(d.normal.z(), -1.0, 1e-15);
}

TEST(CapsuleBox, OutsideByASideOfTheZonotope) {
  // A long axis across a thin plate, near its rim: sideways is shorter than along the axis, an edge's face is shortest.
  const Parallelepiped plate = box(Vector3::Zero(), {1, 1, 0.01});
  const SignedDistance d = distance(Capsule{{0.45, 0, -1}, {0.45, 0, 1}, 0.0}, plate);
  expect_consistent(d);
  EXPECT_NEAR(d.distance_m, -0.05, 1e-15);
  EXPECT_NEAR(std::abs(d.normal.x()), 1.0, 1e-12);
}

TEST(CapsuleBox, SkewedAgreesWithRectangularOfTheSameShape) {
  test::RandomValues random(1);
  for (int i = 0; i < 2000; ++i) {
    const Pose pose = random.pose(0.3);
    const Vector3 size(random.uniform(0.01, 1), random.uniform(0.01, 1), random.uniform(0.01, 1));
    const Parallelepiped straight = box(Vector3::Zero(), size).moved(pose);
    ASSERT_TRUE(straight.rectangular());
    Corners corners = straight.corners();
    // So little out of square that the distance is the same, and enough for the other way to it.
    for (const std::size_t i : {4u, 5u, 6u, 7u}) {
      corners[i] += 1e-10 * (corners[1] - corners[0]).normalized();
    }
    const Parallelepiped skewed = Parallelepiped::from_corners(corners);
    ASSERT_FALSE(skewed.rectangular());
    const Capsule tool{random.vector(1.0), random.vector(1.0), 0.01};
    const SignedDistance a = distance(tool, straight);
    const SignedDistance b = distance(tool, skewed);
    expect_consistent(a);
    expect_consistent(b);
    EXPECT_NEAR(a.distance_m, b.distance_m, 1e-9);
  }
}

TEST(Distance, NotFiniteIsUnknownAndNothingElse) {
  const Parallelepiped b = box(Vector3::Zero(), {1, 1, 1});
  for (const double bad : {kNan, kInf, -kInf}) {
    for (int i = 0; i < 7; ++i) {
      Capsule a{{0, 0, 2}, {0, 0, 3}, 0.1};
      (i < 3 ? a.a[i] : (i < 6 ? a.b[i - 3] : a.radius_m)) = bad;
      for (const SignedDistance& d : {distance(a, b), distance(a, Capsule{}), distance(Capsule{}, a)}) {
        EXPECT_EQ(d.status, DistanceStatus::kUnknown);
        EXPECT_TRUE(std::isnan(d.distance_m) && d.point_a.array().isNaN().all() && d.normal.array().isNaN().all());
      }
    }
  }
  EXPECT_EQ(distance(Capsule{{0, 0, 2}, {0, 0, 3}, -0.1}, b).status, DistanceStatus::kUnknown);
}

TEST(Distance, ToleranceFollowsTheScale) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Capsule a{Vector3::Zero(), scale * Vector3::UnitZ(), 0.1 * scale};
    const Capsule b{scale * Vector3(0.3, -1, 0.5), scale * Vector3(0.3, 1, 0.5), 0.2 * scale};
    EXPECT_EQ(distance(a, b).status, DistanceStatus::kTouching) << scale;
    const Capsule further{b.a + 1e-9 * scale * Vector3::UnitX(), b.b + 1e-9 * scale * Vector3::UnitX(), b.radius_m};
    EXPECT_EQ(distance(a, further).status, DistanceStatus::kSeparated) << scale;
  }
}

}  // namespace
}  // namespace saras
