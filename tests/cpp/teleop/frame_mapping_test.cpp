#include "saras/teleop/frame_mapping.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saras/spatial/rotation.hpp"
#include "support/random_values.hpp"
#include "teleop/frame_mapping_rig.hpp"

namespace saras {
namespace {

using test::distance;
using test::kDt;
using test::random_config;
using test::RandomValues;
using test::swing;

TEST(FrameMapping, StartsAtTheMappedHandleAndFollowsItInBaseAxes) {
  RandomValues random(1);
  const auto config = random_config(random);
  FrameMapping mapping(config);
  FrameMappingInput input;
  input.console_T_handle = swing(0.0);
  auto output = mapping.step(input, kDt);
  EXPECT_EQ(output.status, Status::kWaiting);
  EXPECT_FALSE(output.has_pose);
  for (int i = 1; i < 1000; ++i) {
    input.console_T_handle = swing(i * kDt);
    output = mapping.step(input, kDt);
    ASSERT_EQ(output.status, Status::kOk);
    EXPECT_LT(distance(output.tracked_pose, config.base_T_console * input.console_T_handle), 1e-12);
  }
}

TEST(FrameMapping, ThousandClutchesLeaveNoDrift) {
  FrameMapping mapping({});
  FrameMappingInput input;
  mapping.step(input, kDt);
  Pose before;
  for (int i = 0; i < 1000; ++i) {
    // A closed loop without clutch, then a clutch at the start pose.
    for (int k = 1; k <= 10; ++k) {
      input.console_T_handle = k < 10 ? swing(k * 0.3) : Pose{};
      input.clutch = false;
      mapping.step(input, kDt);
    }
    input.clutch = true;
    before = mapping.step(input, kDt).tracked_pose;
  }
  EXPECT_LT(distance(before, Pose{}), 1e-11);
}

TEST(FrameMapping, TrackedTwistIsExactlyTheMotionOfTheTrackedPose) {
  RandomValues random(2);
  FrameMapping mapping(random_config(random));
  FrameMappingInput input;
  mapping.step(input, kDt);
  Pose previous = mapping.state().base_T_tracked;
  double t = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const Seconds dt = random.uniform(1e-3, 0.09);
    t += dt;
    input.console_T_handle = swing(t);
    input.clutch = random.chance(0.3);
    const auto output = mapping.step(input, dt);
    ASSERT_TRUE(output.has_pose);
    EXPECT_LT(distance(add_delta(previous, output.tracked_twist, dt), output.tracked_pose), 1e-11);
    previous = output.tracked_pose;
  }
}

TEST(FrameMapping, ClutchToggledAtPeakSpeedGivesNoStep) {
  FrameMapping mapping({});
  FrameMappingInput input;
  constexpr double kSpeed = 0.5;
  mapping.step(input, kDt);
  double previous = 0.0;
  for (int i = 1; i < 200; ++i) {
    input.console_T_handle.translation.x() = kSpeed * i * kDt;
    input.clutch = (i / 7) % 2 == 1;
    const auto output = mapping.step(input, kDt);
    const double step = output.tracked_pose.translation.x() - previous;
    EXPECT_NEAR(step, input.clutch ? 0.0 : kSpeed * kDt, 1e-12);
    EXPECT_NEAR(output.handle_twist.linear.x(), kSpeed, 1e-9);
    previous = output.tracked_pose.translation.x();
  }
}

TEST(FrameMapping, TrackedTwistIsZeroUnderClutchAndHandleTwistIsTrue) {
  FrameMapping mapping({});
  FrameMappingInput input;
  mapping.step(input, kDt);
  input.console_T_handle.translation.y() = 0.002;
  input.clutch = true;
  const auto output = mapping.step(input, kDt);
  EXPECT_EQ(to_vector(output.tracked_twist), Vector6::Zero());
  EXPECT_NEAR(output.handle_twist.linear.y(), 0.2, 1e-12);
}

TEST(FrameMapping, WrenchIsRotatedOnly) {
  RandomValues random(4);
  const auto config = random_config(random);
  FrameMapping mapping(config);
  FrameMappingInput input;
  input.base_wrench = random.wrench(3.0, 0.1);
  const auto output = mapping.step(input, kDt);
  const Eigen::Matrix3d touch_R_base = config.touch_T_console.rotation.toRotationMatrix() *
                                       config.base_T_console.rotation.toRotationMatrix().transpose();
  EXPECT_LT((output.touch_wrench.force - touch_R_base * input.base_wrench.force).norm(), 1e-12);
  EXPECT_LT((output.touch_wrench.torque - touch_R_base * input.base_wrench.torque).norm(), 1e-12);
}

TEST(FrameMapping, PowerIsTheSameInBothFrames) {
  RandomValues random(5);
  FrameMappingConfig config;
  config.mapping = Mapping::kEndoscope;
  FrameMapping mapping(config);
  FrameMappingInput input;
  input.base_T_console = random.pose(1.0);
  mapping.step(input, kDt);
  Pose previous = input.console_T_handle;
  for (int i = 1; i < 200; ++i) {
    input.base_T_console = random.pose(1.0);
    input.base_wrench = random.wrench(3.0, 0.1);
    input.console_T_handle = swing(i * kDt);
    const auto output = mapping.step(input, kDt);
    const Twist moved = displacement(previous, input.console_T_handle);
    EXPECT_NEAR(dot(input.base_wrench, output.handle_twist) * kDt, dot(output.touch_wrench, moved), 1e-12);
    previous = input.console_T_handle;
  }
}

TEST(FrameMapping, WrenchTransformFollowsTheLiveMapping) {
  FrameMappingConfig config;
  config.mapping = Mapping::kEndoscope;
  FrameMapping mapping(config);
  FrameMappingInput input;
  input.base_wrench.force = Vector3::UnitX();
  input.base_T_console = Pose{};
  mapping.step(input, kDt);
  input.base_T_console = Pose{rotation_exp(Vector3(0, 0, M_PI_2)), Vector3::Zero()};
  EXPECT_LT((mapping.step(input, kDt).touch_wrench.force - Vector3(0, -1, 0)).norm(), 1e-12);
}

TEST(FrameMapping, MovingEndoscopeGivesNoStepAndMotionFollowsThePicture) {
  FrameMappingConfig config;
  config.mapping = Mapping::kEndoscope;
  FrameMapping mapping(config);
  FrameMappingInput input;
  input.base_T_console = Pose{};
  mapping.step(input, kDt);
  Pose previous = mapping.state().base_T_tracked;
  for (int i = 1; i < 500; ++i) {
    const double angle = 0.01 * i;
    input.base_T_console = Pose{rotation_exp(Vector3(0, 0, angle)), Vector3(0.01 * i, 0, 0)};
    input.console_T_handle.translation.x() = 0.001 * i;
    const auto output = mapping.step(input, kDt);
    ASSERT_TRUE(output.has_pose);
    const Vector3 step = output.tracked_pose.translation - previous.translation;
    EXPECT_LT((step - 0.001 * Vector3(std::cos(angle), std::sin(angle), 0)).norm(), 1e-12);
    EXPECT_LT(displacement(previous, output.tracked_pose).angular.norm(), 1e-12);
    previous = output.tracked_pose;
  }
}

}  // namespace
}  // namespace saras
