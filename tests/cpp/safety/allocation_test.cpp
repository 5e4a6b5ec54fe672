// step() of every law of this room allocates nothing, whatever the input.
#include <gtest/gtest.h>

#include "saras/safety/lease.hpp"
#include "saras/safety/supervisor.hpp"
#include "support/no_allocation.hpp"

namespace saras {
namespace {

using test::expect_no_allocation;

TEST(SafetyAllocation, Lease) {
  LeaseInput in;
  in.operators[0] = {true, true, false, false, false, 2};
  expect_no_allocation(Lease(), in, {});
}
TEST(SafetyAllocation, Supervisor) {
  SupervisorInput in;
  in.estop = false;
  in.channels[0] = {true, false, true, false, false, false, 1, 1};
  in.channels[1] = {true, true, true, true, false, false, 1, 2};
  expect_no_allocation(Supervisor(), in, {});
  in.channels[1].holder = 9;  // refused input
  in.estop = true;
  expect_no_allocation(Supervisor(), in, {});
}

}  // namespace
}  // namespace saras
