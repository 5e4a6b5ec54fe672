#include "saras/console/simulated_handle.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

TEST(SimulatedHandle, StartsAtHome) {
  SimulatedHandle handle;
  const auto output = handle.step({}, 1e-3);
  EXPECT_TRUE(output.valid);
  EXPECT_LT((output.joints - handle.config().home_joints).norm(), 1e-9);
}

TEST(SimulatedHandle, AForceMovesItAgainstTheHandAndTheTouchFrameIsTurned) {
  SimulatedHandle handle;
  SimulatedHandleInput input;
  input.wrench.force = Vector3(2.0, 0.0, 0.0);
  SimulatedHandleOutput output;
  for (int i = 0; i < 3000; ++i) {
    output = handle.step(input, 1e-3);
  }
  const Vector3 moved = handle.state().hand.position - SimballHandle().forward(handle.config().home_joints).translation;
  EXPECT_NEAR(moved.x(), -2.0 / handle.config().hand.stiffness_N_m, 1e-5);
  EXPECT_NEAR(output.work_J, 2.0 * 0.01, 1e-4);  // force times way
}

TEST(SimulatedHandle, TheForceEndsWithTheWatchdog) {
  SimulatedHandle pushed;
  SimulatedHandle stalled;
  SimulatedHandleInput input;
  input.wrench.force = Vector3(3.0, 0.0, 0.0);
  pushed.step(input, 0.002);
  EXPECT_EQ(stalled.step(input, 0.080).work_J, pushed.state().work_J);
}

TEST(SimulatedHandle, ALongStallIsNotSimulated) {
  SimulatedHandle a;
  SimulatedHandle b;
  SimulatedHandleInput input;
  input.intended_offset = Vector3(0.02, 0.0, 0.0);
  a.step(input, 30.0);
  b.step(input, 0.1);
  EXPECT_EQ(a.state().hand.position, b.state().hand.position);
}

TEST(SimulatedHandle, ConfigIsChecked) {
  SimulatedHandleConfig config;
  config.workspace_radius_m = 0.2;  // would let the handle through the pivot
  EXPECT_THROW(SimulatedHandle{config}, ConfigError);
}

}  // namespace
}  // namespace saras
