// What the console steps at device rate allocates nothing, whatever the input.
#include <gtest/gtest.h>

#include "saras/console/port_guard.hpp"
#include "saras/console/simulated_handle.hpp"
#include "support/no_allocation.hpp"

namespace saras {
namespace {

TEST(ConsoleAllocation, PortGuard) {
  PortGuardInput in;
  in.active = in.has_pose = true;
  test::expect_no_allocation(PortGuard{}, in, {&in.simball_T_handle.translation.x(), &in.wrench.force.y(), &in.work_J});
}

TEST(ConsoleAllocation, SimulatedHandle) {
  SimulatedHandleInput in;
  test::expect_no_allocation(SimulatedHandle{}, in, {&in.intended_offset.x(), &in.wrench.force.z()});
}

}  // namespace
}  // namespace saras
