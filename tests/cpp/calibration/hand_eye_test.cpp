#include "saras/calibration/hand_eye.hpp"

#include <gtest/gtest.h>

#include <random>

#include "saras/calibration/calibration_error.hpp"
#include "saras/spatial/rotation.hpp"

namespace saras {
namespace {

constexpr double kDegree = M_PI / 180.0;

class Rig {
 public:
  explicit Rig(unsigned seed) : engine_(seed) {
    gripper_T_camera = {rotation_exp(draw()), 0.05 * draw()};
    base_T_target = {rotation_exp(draw()), 0.2 * draw()};
  }
  Vector3 draw() {
    std::normal_distribution<double> normal;
    return {normal(engine_), normal(engine_), normal(engine_)};
  }
  /// noise: times HandEyeNoise's defaults.
  std::vector<HandEyePair> pairs(std::size_t n, double spread_rad, double noise, bool eye_to_hand = false) {
    const HandEyeNoise level;
    std::vector<HandEyePair> all;
    for (std::size_t i = 0; i < n; ++i) {
      const Pose camera_T_target = {rotation_exp(spread_rad * draw()), Vector3(0.0, 0.0, 0.3) + 0.02 * draw()};
      Pose moving = base_T_target * camera_T_target.inverse() * gripper_T_camera.inverse();
      moving = eye_to_hand ? moving.inverse() : moving;
      all.push_back({spoilt(moving, noise * level.robot_translation_m, noise * level.robot_rotation_rad),
                     spoilt(camera_T_target, noise * level.camera_translation_m, noise * level.camera_rotation_rad),
                     {},
                     0});
    }
    return all;
  }
  Pose spoilt(const Pose& pose, double by_m, double by_rad) {
    return {(rotation_exp(by_rad * draw()) * pose.rotation).normalized(), pose.translation + by_m * draw()};
  }
  Pose gripper_T_camera;
  Pose base_T_target;

 private:
  std::mt19937 engine_;
};

double off(const Pose& a, const Pose& b) {
  const Twist d = displacement(a, b);
  return d.linear.norm() + d.angular.norm();
}

std::string refusal(const std::vector<HandEyePair>& pairs, const HandEyeOptions& options = {}) {
  try {
    hand_eye(pairs, options);
  } catch (const CalibrationError& error) {
    return error.what();
  }
  return {};
}

TEST(HandEye, WithoutNoiseItIsExactBothWays) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    for (const bool eye_to_hand : {false, true}) {
      Rig rig(seed);
      HandEyeOptions options;
      options.eye_to_hand = eye_to_hand;
      const auto result = hand_eye(rig.pairs(seed % 2 == 0 ? 3 : 12, 0.5, 0.0, eye_to_hand), options);
      EXPECT_LT(off(result.gripper_T_camera, rig.gripper_T_camera), 1e-8) << seed;
      EXPECT_LT(off(result.base_T_target, rig.base_T_target), 1e-8) << seed;
    }
  }
}

TEST(HandEye, GrossErrorsAreFoundAndLeftOut) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    Rig rig(seed);
    auto pairs = rig.pairs(20, 0.4, 1.0);
    for (const std::size_t i : {2u, 9u, 13u, 17u}) {
      pairs[i].camera_T_target = rig.spoilt(pairs[i].camera_T_target, 0.02, 0.2);
    }
    const auto result = hand_eye(pairs);
    const Twist error = displacement(result.gripper_T_camera, rig.gripper_T_camera);
    EXPECT_LT(error.linear.norm(), 2.5e-3) << seed;
    EXPECT_LT(error.angular.norm(), 0.5 * kDegree) << seed;
    for (const std::size_t i : {2u, 9u, 13u, 17u}) {
      EXPECT_FALSE(result.used[i]) << seed;
    }
  }
}

TEST(HandEye, TheNoiseIsEstimated) {
  double rotation = 0.0;
  double translation = 0.0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    Rig rig(seed);
    const auto result = hand_eye(rig.pairs(30, 0.4, 4.0));
    rotation += result.rotation_noise / 30.0;
    translation += result.translation_noise / 30.0;
  }
  EXPECT_NEAR(rotation, 4.0, 0.3);
  EXPECT_NEAR(translation, 4.0, 0.3);
}

TEST(HandEye, WhatCannotBeBelievedIsRefusedWithItsReason) {
  Rig rig(5);
  const auto good = rig.pairs(10, 0.4, 1.0);
  EXPECT_EQ(refusal(good), "");
  EXPECT_NE(refusal({good[0], good[1]}).find("pairs = 2: must be >= 3; rotation spread"), std::string::npos);
  auto repeated = good;
  repeated[7] = repeated[2];
  EXPECT_NE(refusal(repeated).find("pairs 3 and 8: the same robot pose twice"), std::string::npos);
  const std::string same = refusal(std::vector<HandEyePair>(10, good[0]));
  EXPECT_NE(same.find("rotation spread = 0 deg"), std::string::npos) << same;
  auto parallel = good;
  for (std::size_t i = 0; i < parallel.size(); ++i) {
    parallel[i].base_T_gripper = {rotation_exp({0.0, 0.0, 0.1 * static_cast<double>(i)}), 0.01 * rig.draw()};
  }
  EXPECT_NE(refusal(parallel).find("parallel axes"), std::string::npos) << refusal(parallel);
  auto millimetres = good;
  for (auto& pair : millimetres) {
    pair.camera_T_target.translation *= 1000.0;
  }
  EXPECT_NE(refusal(millimetres).find("millimetres"), std::string::npos);
  auto inverse = good;
  for (auto& pair : inverse) {
    pair.camera_T_target = pair.camera_T_target.inverse();
  }
  EXPECT_NE(refusal(inverse), "");
  auto nan = good;
  nan[4].base_T_gripper.translation.y() = std::nan("");
  EXPECT_NE(refusal(nan).find("pair 5"), std::string::npos);
}

TEST(HandEye, TheTimeOffsetOfAStreamIsFound) {
  Rig rig(11);
  std::vector<HandEyePair> pairs;
  constexpr double kLate_s = 0.013;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.05 * i;
    const auto gripper = [](double at) {
      return Pose{rotation_exp({0.4 * std::sin(1.3 * at), 0.5 * std::sin(0.9 * at + 1.0), 0.3 * std::sin(1.7 * at)}),
                  {0.1 * std::sin(at), 0.1 * std::cos(0.7 * at), 0.05 * std::sin(1.1 * at)}};
    };
    const Pose seen = rig.gripper_T_camera.inverse() * gripper(t + kLate_s).inverse() * rig.base_T_target;
    HandEyePair pair{gripper(t), seen, {}, i / 10};
    const Twist step = displacement(gripper(t - 1e-4), gripper(t + 1e-4));
    pair.gripper_twist = {step.linear / 2e-4, step.angular / 2e-4};
    pairs.push_back(pair);
  }
  HandEyeOptions options;
  options.time_offset = true;
  options.allow_repeats = true;
  options.grouped = true;
  const auto result = hand_eye(pairs, options);
  EXPECT_NEAR(result.time_offset_s, kLate_s, 5e-4);  // the pose is extrapolated with a constant twist
  EXPECT_LT(off(result.gripper_T_camera, rig.gripper_T_camera), 2e-3);
  EXPECT_GT(result.time_offset_std_s, 0.0);
}

}  // namespace
}  // namespace saras
