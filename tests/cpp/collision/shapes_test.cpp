#include "saras/collision/shapes.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

Corners unit_cube() {
  return {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 0, 1), Vector3(0, 0, 1),
          Vector3(0, 1, 0), Vector3(1, 1, 0), Vector3(1, 1, 1), Vector3(0, 1, 1)};
}

std::string refusal(const Corners& corners) {
  try {
    Parallelepiped::from_corners(corners);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Parallelepiped, CornersInTheOrderOfTheSource) {
  const Parallelepiped cube = Parallelepiped::from_corners(unit_cube());
  EXPECT_TRUE(cube.rectangular());
  EXPECT_EQ(cube.half_edge(0), Vector3(0.5, 0, 0));
  EXPECT_EQ(cube.half_edge(1), Vector3(0, 0.5, 0));
  EXPECT_EQ(cube.half_edge(2), Vector3(0, 0, 0.5));
  EXPECT_DOUBLE_EQ(cube.volume(), 1.0);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(cube.corners()[i], unit_cube()[i]);
  }
}

TEST(Parallelepiped, RefusesEachCornerThatDoesNotClose) {
  for (const std::size_t i : {2u, 5u, 6u, 7u}) {
    Corners corners = unit_cube();
    corners[i].y() += 2e-6;
    EXPECT_NE(refusal(corners).find("v" + std::to_string(i) + " is 2e-06 m"), std::string::npos) << refusal(corners);
    corners[i].y() -= 1.5e-6;
    EXPECT_EQ(refusal(corners), "");
  }
}

TEST(Parallelepiped, RefusesNoVolumeAndNoNumber) {
  Corners flat = unit_cube();
  for (const std::size_t i : {4u, 5u, 6u, 7u}) {
    flat[i] = flat[i - 4];
  }
  EXPECT_NE(refusal(flat).find("y = v4 - v0"), std::string::npos);
  Corners folded = unit_cube();
  for (const std::size_t i : {4u, 5u, 6u, 7u}) {
    folded[i] = folded[i - 4] + Vector3(1, 0, 1);
  }
  EXPECT_NE(refusal(folded).find("zero volume"), std::string::npos);
  for (std::size_t i = 0; i < 8; ++i) {
    Corners bad = unit_cube();
    bad[i].z() = test::kNan;
    EXPECT_NE(refusal(bad).find("v" + std::to_string(i)), std::string::npos);
  }
  Corners far = unit_cube();
  for (Vector3& corner : far) {
    corner.x() += 1e12;
  }
  EXPECT_NE(refusal(far), "");
}

TEST(Parallelepiped, MovedStaysRectangular) {
  test::RandomValues random(2);
  Parallelepiped shape = Parallelepiped::from_corners(unit_cube());
  for (int i = 0; i < 100; ++i) {
    const Pose pose = random.pose(1.0);
    const Parallelepiped moved = shape.moved(pose);
    EXPECT_TRUE(moved.rectangular());
    EXPECT_NEAR((moved.corners()[6] - pose * shape.corners()[6]).norm(), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace saras
