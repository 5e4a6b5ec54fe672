#include "saras/calibration/board.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

TEST(Board, DotsLieOnTheirCircleAtTheSourcesAngles) {
  const BoardConfig config;
  config.validate();
  const auto dots = dot_centers(config);
  ASSERT_EQ(dots.size(), 6u);
  EXPECT_NEAR((dots[0] - Vector3(0.1, 0.0, 0.0)).norm(), 0.0, 1e-15);
  for (const auto& dot : dots) {
    EXPECT_NEAR(dot.norm(), 0.1, 1e-15);
    EXPECT_EQ(dot.z(), 0.0);
  }
  EXPECT_NEAR(dots[0].dot(dots[1]) / 0.01, std::cos(40.0 * M_PI / 180.0), 1e-12);
}

TEST(Board, MarkersAreSquaresThatFaceUp) {
  const BoardConfig config;
  for (const auto& corners : marker_corners(config)) {
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR((corners[i] - corners[(i + 1) % 4]).norm(), 0.025, 1e-15);
    }
    // Clockwise as seen from +z: upper left, upper right, lower right.
    EXPECT_LT((corners[1] - corners[0]).cross(corners[2] - corners[1]).z(), 0.0);
    EXPECT_GT((corners[0] - corners[3]).y(), 0.0);
  }
}

TEST(Board, AnEvenOrderOfDotsIsRefused) {
  BoardConfig config;
  config.dot_angles_deg = {0.0, 60.0, 120.0, 180.0, 240.0, 300.0};
  EXPECT_THROW(config.validate(), ConfigError);
  config.dot_angles_deg = {0.0, 100.0, 200.0};  // its mirror image fits
  EXPECT_THROW(config.validate(), ConfigError);
  config.dot_angles_deg = {0.0, 100.0, 250.0};
  EXPECT_NO_THROW(config.validate());
}

TEST(Board, WhatOverlapsOrIsNoNumberIsRefused) {
  BoardConfig config;
  config.marker_circle_radius_m = 0.09;
  EXPECT_THROW(config.validate(), ConfigError);
  config = {};
  config.dot_diameter_m = std::nan("");
  EXPECT_THROW(config.validate(), ConfigError);
  config = {};
  config.dot_angles_deg = {0.0, 100.0, 40.0};
  EXPECT_THROW(config.validate(), ConfigError);
}

}  // namespace
}  // namespace saras
