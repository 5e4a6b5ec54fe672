#include "saras/collision/scene.hpp"

#include <gtest/gtest.h>

#include "support/random_values.hpp"

namespace saras {
namespace {

using test::kNan;

std::vector<Parallelepiped> random_regions(test::RandomValues& random, int count, double spread) {
  std::vector<Parallelepiped> regions;
  for (int i = 0; i < count; ++i) {
    const Quaternion r = random.rotation();
    const Vector3 x = r * Vector3(random.uniform(0.005, 0.05), 0, 0);
    const Vector3 y = r * Vector3(random.chance(0.5) ? 0.01 : 0.0, random.uniform(0.005, 0.05), 0);
    const Vector3 z = r * Vector3(0, 0, random.uniform(0.005, 0.05));
    regions.emplace_back(random.vector(spread), x, y, z);
  }
  return regions;
}

Capsule random_tool(test::RandomValues& random, double spread) {
  return {random.vector(spread), random.vector(spread), 0.0025};
}

TEST(Scene, TreeGivesWhatEachPairGives) {
  test::RandomValues random(1);
  for (const int count : {0, 1, 2, 3, 10, 300}) {
    const double spread = random.uniform(0.05, 1.0);
    const std::vector<Parallelepiped> regions = random_regions(random, count, spread);
    const RegionTree tree(regions);
    for (int i = 0; i < 200; ++i) {
      const Capsule tool = random_tool(random, 1.5 * spread);
      double least = test::kInf;
      for (const Parallelepiped& region : regions) {
        least = std::min(least, distance(tool, region).distance_m);
      }
      const RegionTree::Nearest nearest = tree.nearest(tool);
      if (count == 0) {
        EXPECT_EQ(nearest.region, -1);
        continue;
      }
      EXPECT_EQ(nearest.distance.distance_m, least);
      EXPECT_EQ(distance(tool, regions[static_cast<std::size_t>(nearest.region)]).distance_m, least);
    }
  }
}

TEST(Scene, ToolsSeeEachOtherAndRegionsMove) {
  test::RandomValues random(2);
  const std::vector<Parallelepiped> regions = random_regions(random, 50, 0.3);
  Scene scene(3, regions);
  for (int i = 0; i < 200; ++i) {
    const Pose base_T_regions = random.pose(0.2);
    std::vector<SceneTool> tools;
    for (int t = 0; t < 3; ++t) {
      tools.push_back({random_tool(random, 0.4), true});
    }
    const std::vector<ToolDistance>& found = scene.distances(tools, base_T_regions);
    for (std::size_t t = 0; t < 3; ++t) {
      double least = test::kInf;
      for (std::size_t other = 0; other < 3; ++other) {
        if (other != t) {
          least = std::min(least, distance(tools[t].capsule, tools[other].capsule).distance_m);
        }
      }
      for (const Parallelepiped& region : regions) {
        least = std::min(least, distance(tools[t].capsule, region.moved(base_T_regions)).distance_m);
      }
      const SignedDistance& d = found[t].distance;
      EXPECT_NEAR(d.distance_m, least, 1e-12);
      EXPECT_NEAR((d.point_a + d.distance_m * d.normal - d.point_b).norm(), 0.0, 1e-12);
    }
  }
}

TEST(Scene, EqualToolsBothHaveTheOtherAsPartner) {
  Scene scene(2, {});
  const auto& found = scene.distances({{{{0, 0, 0}, {0, 0, 1}, 0.1}, true}, {{{1, 0, 0}, {1, 0, 1}, 0.1}, true}});
  EXPECT_EQ(found[0].partner, Partner::kTool);
  EXPECT_EQ(found[0].index, 1);
  EXPECT_EQ(found[1].index, 0);
  EXPECT_NEAR((found[0].distance.normal - Vector3::UnitX()).norm(), 0.0, 1e-15);
  EXPECT_NEAR((found[1].distance.normal + Vector3::UnitX()).norm(), 0.0, 1e-15);
}

TEST(Scene, WhatIsUnknownIsNamed) {
  test::RandomValues random(3);
  Scene scene(2, random_regions(random, 5, 0.1));
  const SceneTool good{random_tool(random, 0.5), true};
  SceneTool lost = good;
  lost.known = false;
  SceneTool bad = good;
  bad.capsule.b.y() = kNan;
  SceneTool absurd = good;
  absurd.capsule.a.z() = 1e200;
  for (const SceneTool& unknown : {lost, bad, absurd}) {
    const auto& found = scene.distances({good, unknown});
    EXPECT_FALSE(found[0].tool_unknown);
    EXPECT_TRUE(found[0].other_tool_unknown);
    EXPECT_EQ(found[0].partner, Partner::kRegion);
    EXPECT_TRUE(found[1].tool_unknown);
    EXPECT_FALSE(found[1].other_tool_unknown);
    EXPECT_EQ(found[1].partner, Partner::kNone);
    EXPECT_TRUE(std::isnan(found[1].distance.distance_m));
  }
  EXPECT_TRUE(scene.distances({good})[1].tool_unknown);  // missing
  EXPECT_TRUE(scene.distances({good, good}, {}, false)[0].regions_unknown);
  Pose not_rigid;
  not_rigid.rotation.coeffs() *= 1.1;
  EXPECT_TRUE(scene.distances({good, good}, not_rigid)[0].regions_unknown);
  not_rigid = Pose{};
  not_rigid.translation.z() = kNan;
  EXPECT_TRUE(scene.distances({good, good}, not_rigid)[0].regions_unknown);
  EXPECT_EQ(scene.distances({good, good}, not_rigid)[0].partner, Partner::kTool);
  EXPECT_FALSE(Scene(1, {}).distances({good}, {}, false)[0].regions_unknown);  // there are none
}

}  // namespace
}  // namespace saras
