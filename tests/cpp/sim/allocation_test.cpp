// step() of every simulated peer allocates nothing, whatever the input; neither does the channel.
#include <gtest/gtest.h>

#include "saras/sim/channel.hpp"
#include "saras/sim/operator.hpp"
#include "saras/sim/servo_arm.hpp"
#include "saras/sim/tissue.hpp"
#include "support/no_allocation.hpp"

namespace saras {
namespace {

using test::expect_no_allocation;

TEST(Allocation, Operator) {
  OperatorInput in;
  expect_no_allocation(Operator({}), in, {&in.force.x(), &in.intended_position.z(), &in.intended_roll});
}
TEST(Allocation, Tissue) {
  TissueInput in;
  in.tip_position.z() = -0.01;
  TissueConfig config;
  config.force_noise_N = 0.1;
  expect_no_allocation(Tissue(config), in, {&in.tip_position.z(), &in.tip_velocity.x()});
}
TEST(Allocation, ServoArmPivot) {
  const ServoArm arm;
  ServoArmInput in;
  in.target_tip = arm.kinematics().forward(arm.state().q).translation;
  in.rcm = Eigen::Map<const Vector3>(mesa::kNominalRcm.data());
  expect_no_allocation(arm, in, {&in.target_tip.x(), &in.reaction_force.z(), &in.rcm.y()});
}
TEST(Allocation, ServoArmParallel) {
  const ServoArm arm;
  ServoArmInput in;
  in.target_tip = arm.kinematics().forward(arm.state().q).translation;
  in.mode = ArmMode::kParallel;
  expect_no_allocation(arm, in, {&in.target_tip.x(), &in.reaction_force.z()});
}
TEST(Allocation, Channel) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  ChannelConfig config;
  config.delay_s = 0.1;
  config.duplicate = 0.5;
  config.reorder = 0.5;
  config.capacity = 50;
  Channel channel(config);
  const test::MallocCounter counter;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    std::uint64_t id = 0;
    channel.send(i, static_cast<double>(i) * 1e-3);
    while (channel.receive(static_cast<double>(i) * 1e-3, id)) {
    }
  }
  EXPECT_EQ(counter.count(), 0u);
}

}  // namespace
}  // namespace saras
