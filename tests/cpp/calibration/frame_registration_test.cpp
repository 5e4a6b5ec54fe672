#include "saras/calibration/frame_registration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "saras/calibration/board.hpp"
#include "saras/calibration/calibration_error.hpp"
#include "saras/spatial/rotation.hpp"

namespace saras {
namespace {

class Touches {
 public:
  explicit Touches(unsigned seed) : engine_(seed) {
    std::normal_distribution<double> normal;
    pose = {rotation_exp({normal(engine_), normal(engine_), normal(engine_)}),
            0.2 * Vector3(normal(engine_), normal(engine_), normal(engine_))};
  }
  std::vector<Vector3> of(const std::vector<Vector3>& board, double noise_m) {
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<Vector3> touched;
    for (const auto& dot : board) {
      touched.emplace_back(pose * dot + noise_m * Vector3(normal(engine_), normal(engine_), normal(engine_)));
    }
    return touched;
  }
  Pose pose;

 private:
  std::mt19937 engine_;
};

std::string refusal(const std::vector<Vector3>& touched, const std::vector<Vector3>& board,
                    const FrameFromPointsOptions& options = {}) {
  try {
    frame_from_points(touched, board, options);
  } catch (const CalibrationError& error) {
    return error.what();
  }
  return {};
}

TEST(FrameFromPoints, WithoutNoiseItIsExact) {
  const auto board = dot_centers({});
  for (unsigned seed = 0; seed < 200; ++seed) {
    Touches touches(seed);
    const auto result = frame_from_points(touches.of(board, 0.0), board);
    const Twist off = displacement(result.base_T_board, touches.pose);
    EXPECT_LT(off.linear.norm() + off.angular.norm(), 1e-12);
    EXPECT_LT(result.rms_m, 1e-12);
  }
}

TEST(FrameFromPoints, EveryWrongOrderIsRefusedAndTheRightOneNamed) {
  const auto all = dot_centers({});
  for (const auto& board : {all, std::vector<Vector3>{all[0], all[2], all[4]}}) {
    Touches touches(7);
    const auto touched = touches.of(board, 0.2e-3);
    std::vector<std::size_t> order(board.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      order[i] = i;
    }
    while (std::next_permutation(order.begin(), order.end())) {
      std::vector<Vector3> wrong(board.size());
      for (std::size_t i = 0; i < order.size(); ++i) {
        wrong[i] = touched[order[i]];
      }
      const std::string text = refusal(wrong, board);
      EXPECT_NE(text.find("wrong order"), std::string::npos) << text;
    }
  }
}

TEST(FrameFromPoints, WhatCannotBeBelievedIsRefusedWithItsReason) {
  const auto board = dot_centers({});
  Touches touches(3);
  const auto touched = touches.of(board, 0.2e-3);
  EXPECT_NE(refusal({touched[0], touched[1]}, {board[0], board[1]}).find("different dots = 2"), std::string::npos);
  EXPECT_NE(refusal({touched[0], touched[1], touched[0]}, {board[0], board[1], board[0]}).find("different dots = 2"),
            std::string::npos);
  const std::vector<Vector3> line = {{0, 0, 0}, {0.05, 0, 0}, {0.1, 0, 0}};
  EXPECT_NE(refusal(line, line).find("collinear"), std::string::npos);
  EXPECT_NE(refusal(std::vector<Vector3>(6, touched[0]), board).find("must be"), std::string::npos);
  auto millimetres = touched;
  for (auto& point : millimetres) {
    point *= 1000.0;
  }
  EXPECT_NE(refusal(millimetres, board).find("millimetres"), std::string::npos);
  auto one_off = touched;
  one_off[3] += Vector3(0.0, 0.0, 0.015);
  EXPECT_NE(refusal(one_off, board).find("touch 4 is off"), std::string::npos) << refusal(one_off, board);
  auto nan = touched;
  nan[2].x() = std::nan("");
  EXPECT_NE(refusal(nan, board).find("point 3"), std::string::npos);
  auto scaled = touched;
  for (auto& point : scaled) {
    point *= 0.94;  // printed to fit the page
  }
  EXPECT_NE(refusal(scaled, board).find("0.94 times"), std::string::npos) << refusal(scaled, board);
  FrameFromPointsOptions options;
  options.above = touches.pose * Vector3(0.02, 0.0, -0.15);
  EXPECT_NE(refusal(touched, board, options).find("from behind"), std::string::npos);
  options.above = touches.pose * Vector3(0.02, 0.0, 0.15);
  EXPECT_EQ(refusal(touched, board, options), "");
}

TEST(FrameFromThreePoints, FindsTheCircleOfTheSource) {
  const auto dots = dot_centers({});
  for (unsigned seed = 0; seed < 100; ++seed) {
    Touches touches(seed);
    const auto touched = touches.of({dots[0], dots[2], dots[4]}, 0.0);
    const Twist off = displacement(frame_from_three_points(touched[0], touched[1], touched[2]), touches.pose);
    EXPECT_LT(off.linear.norm() + off.angular.norm(), 1e-9);
  }
  EXPECT_THROW(frame_from_three_points({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), CalibrationError);
}

}  // namespace
}  // namespace saras
