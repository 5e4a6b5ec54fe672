// Stale, non-finite, late and stalled input of FrameMapping, and refused configurations.
#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"
#include "saras/teleop/frame_mapping.hpp"
#include "support/random_values.hpp"
#include "teleop/frame_mapping_rig.hpp"

namespace saras {
namespace {

using test::distance;
using test::kDt;
using test::kInf;
using test::kNan;
using test::random_config;
using test::RandomValues;
using test::swing;

TEST(FrameMappingFaults, FailedLookupPublishesNothing) {
  RandomValues random(3);
  FrameMapping mapping(random_config(random));
  FrameMappingInput input;
  mapping.step(input, kDt);
  const Pose tracked = mapping.state().base_T_tracked;
  input.stale = true;
  input.console_T_handle = swing(1.0);
  auto output = mapping.step(input, kDt);
  EXPECT_EQ(output.status, Status::kStale);
  EXPECT_FALSE(output.has_pose);
  EXPECT_FALSE(output.has_wrench);
  input.stale = false;
  input.console_T_handle.translation.x() = kInf;
  output = mapping.step(input, kDt);
  EXPECT_EQ(output.status, Status::kInvalidInput);
  EXPECT_FALSE(output.has_pose);
  EXPECT_EQ(distance(mapping.state().base_T_tracked, tracked), 0.0);
}

TEST(FrameMappingFaults, TwistAfterMissedTicksIsTheMeanOverAllOfThem) {
  FrameMapping mapping({});
  FrameMappingInput input;
  mapping.step(input, kDt);
  input.stale = true;
  for (int i = 0; i < 3; ++i) {
    mapping.step(input, kDt);
  }
  input.stale = false;
  input.console_T_handle.translation.x() = 0.004;
  const auto output = mapping.step(input, kDt);
  EXPECT_NEAR(output.interval_s, 0.04, 1e-12);
  EXPECT_NEAR(output.handle_twist.linear.x(), 0.1, 1e-12);
}

TEST(FrameMappingFaults, GapReferencesAnewAndStillBillsTheHandle) {
  FrameMapping mapping({});
  FrameMappingInput input;
  mapping.step(input, kDt);
  input.console_T_handle.translation.x() = 0.3;
  auto output = mapping.step(input, 2.0);
  EXPECT_EQ(output.status, Status::kInvalidTimeStep);
  EXPECT_TRUE(output.gap);
  EXPECT_TRUE(output.has_pose);
  EXPECT_EQ(output.tracked_pose.translation.x(), 0.0);
  EXPECT_EQ(to_vector(output.tracked_twist), Vector6::Zero());
  EXPECT_NEAR(output.handle_twist.linear.x() * output.interval_s, 0.3, 1e-12);
  input.console_T_handle.translation.x() = 0.301;
  output = mapping.step(input, kDt);
  EXPECT_EQ(output.status, Status::kOk);
  EXPECT_NEAR(output.tracked_pose.translation.x(), 0.001, 1e-12);
}

TEST(FrameMappingFaults, TimeStepThatIsNoneIsRefused) {
  FrameMapping mapping({});
  FrameMappingInput input;
  mapping.step(input, kDt);
  for (const Seconds dt : {0.0, -1.0, kNan, kInf}) {
    const auto output = mapping.step(input, dt);
    EXPECT_EQ(output.status, Status::kInvalidTimeStep);
    EXPECT_FALSE(output.has_pose);
  }
}

TEST(FrameMappingFaults, WrenchNotFiniteIsWithheldAndThePoseGoesOn) {
  FrameMapping mapping({});
  FrameMappingInput input;
  mapping.step(input, kDt);
  input.base_wrench.force.x() = kNan;
  input.console_T_handle.translation.x() = 0.001;
  const auto output = mapping.step(input, kDt);
  EXPECT_EQ(output.status, Status::kInvalidInput);
  EXPECT_TRUE(output.has_pose);
  EXPECT_FALSE(output.has_wrench);
  EXPECT_TRUE(is_finite(output.touch_wrench));
}

TEST(FrameMappingFaults, EndoscopeMappingWithoutEndoscopeIsStale) {
  FrameMappingConfig config;
  config.mapping = Mapping::kEndoscope;
  FrameMapping mapping(config);
  const auto output = mapping.step({}, kDt);
  EXPECT_EQ(output.status, Status::kStale);
  EXPECT_FALSE(output.has_pose);
  EXPECT_FALSE(output.has_wrench);
}

TEST(FrameMappingFaults, AnySequenceOfFaultsStaysFiniteAndNeverOutrunsTheHandle) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    RandomValues random(seed);
    FrameMapping mapping(random_config(random));
    FrameMappingInput input;
    mapping.step(input, kDt);
    Pose previous = mapping.state().base_T_tracked;
    Vector3 handle = Vector3::Zero();
    Vector3 last_seen = handle;
    for (int i = 0; i < 100; ++i) {
      handle += random.vector(0.005);
      input = {};
      input.console_T_handle.translation = handle;
      input.clutch = random.chance(0.2);
      input.stale = random.chance(0.1);
      if (random.chance(0.1)) {
        input.console_T_handle.translation.y() = random.chance(0.5) ? kNan : 1e308;
      }
      if (random.chance(0.1)) {
        input.console_T_handle.rotation.coeffs() *= random.chance(0.5) ? -1.0 : 0.0;
      }
      const double dts[] = {kDt, kDt, kDt, 0.0, kNan, 3.0};
      const auto output = mapping.step(input, dts[static_cast<int>(random.uniform(0, 6))]);
      ASSERT_TRUE(is_valid(output.tracked_pose));
      ASSERT_TRUE(is_finite(output.tracked_twist) && is_finite(output.handle_twist) &&
                  is_finite(output.tracked_twist_filtered) && is_finite(output.touch_wrench));
      const double moved = (output.tracked_pose.translation - previous.translation).norm();
      if (output.has_pose) {
        EXPECT_LE(moved, (input.console_T_handle.translation - last_seen).norm() * (1 + 1e-9) + 1e-12);
        last_seen = input.console_T_handle.translation;
        previous = output.tracked_pose;
      } else {
        EXPECT_EQ(moved, 0.0);
      }
    }
  }
}

TEST(FrameMappingFaults, RefusesBadConfiguration) {
  FrameMappingConfig config;
  config.base_T_console.rotation.coeffs() *= 2.0;
  EXPECT_THROW(FrameMapping{config}, ConfigError);
  config = {};
  config.cutoff_hz = -1.0;
  EXPECT_THROW(FrameMapping{config}, ConfigError);
  config = {};
  config.dt_max_s = 0.0;
  EXPECT_THROW(FrameMapping{config}, ConfigError);
}

}  // namespace
}  // namespace saras
