// step() of every law allocates nothing, whatever the input. A new law is one test of two lines here.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "saras/teleop/disturbance_observer.hpp"
#include "saras/teleop/energy_tank.hpp"
#include "saras/teleop/frame_mapping.hpp"
#include "saras/teleop/transparency.hpp"
#include "saras/teleop/twist_estimator.hpp"
#include "saras/teleop/velocity_integrator.hpp"
#include "support/no_allocation.hpp"

namespace saras {
namespace {

using test::expect_no_allocation;

TEST(Allocation, CounterSeesEveryWayToAllocate) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  const test::MallocCounter counter;
  const auto number = std::make_unique<int>(1);
  EXPECT_EQ(counter.count(), 1u);
  std::vector<double> numbers(3);
  EXPECT_EQ(counter.count(), 2u);
  Eigen::VectorXd vector(3);
  EXPECT_EQ(counter.count(), 3u);
  struct alignas(64) Aligned {
    double value[8];
  };
  const auto aligned = std::make_unique<Aligned>();
  EXPECT_EQ(counter.count(), 4u);
}

TEST(Allocation, TwistEstimator) {
  TwistEstimatorInput in;
  expect_no_allocation(TwistEstimator({}), in, {&in.base_T_body.translation.x()});
}
TEST(Allocation, FrameMapping) {
  FrameMappingInput in;
  expect_no_allocation(FrameMapping({}), in, {&in.console_T_handle.translation.x(), &in.base_wrench.force.x()});
}
TEST(Allocation, Transparency) {
  TransparencyInput in;
  expect_no_allocation(Transparency({}), in, {&in.master_pose.translation.x(), &in.slave_pose.translation.z()});
}
TEST(Allocation, VelocityIntegrator) {
  VelocityIntegratorInput in;
  expect_no_allocation(VelocityIntegrator({}), in, {&in.twist.linear.x(), &in.measured_pose.translation.z()});
}
TEST(Allocation, VelocityIntegratorPivoted) {
  VelocityIntegratorInput in;
  VelocityIntegratorConfig config;
  config.shaft_through_rcm = true;
  expect_no_allocation(VelocityIntegrator(config), in, {&in.twist.linear.x(), &in.twist.angular.z()});
}
TEST(Allocation, DisturbanceObserver) {
  DisturbanceObserverInput in;
  expect_no_allocation(DisturbanceObserver({}), in, {&in.set_point.x()});
}
TEST(Allocation, EnergyTank) {
  EnergyTankInput in{ChannelArray::Zero(6, 2), ChannelArray::Zero(6, 2), ChannelArray(6, 0)};
  expect_no_allocation(EnergyTank({}, 2), in, {in.desired.data(), in.conjugate.data()});
}

}  // namespace
}  // namespace saras
