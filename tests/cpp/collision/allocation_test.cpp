// Nothing of the room that runs each tick allocates, whatever the input.
#include <gtest/gtest.h>

#include "saras/collision/proximity_monitor.hpp"
#include "saras/collision/repulsive_force.hpp"
#include "support/no_allocation.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

std::vector<Parallelepiped> regions(int count) {
  test::RandomValues random(4);
  std::vector<Parallelepiped> regions;
  for (int i = 0; i < count; ++i) {
    const Vector3 skew(i % 2 ? 0.0 : 0.01, 0, 0.02);
    regions.emplace_back(random.vector(0.2), Vector3(0.02, 0, 0), Vector3(0, 0.02, 0), skew);
  }
  return regions;
}

TEST(CollisionAllocation, ProximityMonitor) {
  ProximityMonitorInput in;
  for (int i = 0; i < 5; ++i) {
    in.tools[static_cast<std::size_t>(i)].capsule = {Vector3(0.1 * i, 0, 0), Vector3(0, 0, 0.3), 0.0025};
  }
  test::expect_no_allocation(
      ProximityMonitor({}, 5, regions(500)), in,
      {&in.tools[0].capsule.a.x(), &in.tools[3].capsule.b.y(), &in.base_T_regions.translation.z()});
}
TEST(CollisionAllocation, RepulsiveForce) {
  RepulsiveForceInput in{0.001, Vector3::UnitX()};
  test::expect_no_allocation(RepulsiveForce({}), in, {&in.distance_m});
}
TEST(CollisionAllocation, Distances) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  test::RandomValues random(5);
  const std::vector<Parallelepiped> boxes = regions(20);
  double sum = 0.0;
  const test::MallocCounter counter;
  for (int i = 0; i < 500; ++i) {
    const Capsule a{random.vector(0.3), random.vector(0.3), 0.01};
    const Capsule b{random.vector(0.3), i % 3 ? random.vector(0.3) : a.b, 0.01};
    sum += distance(a, b).distance_m + distance(a, boxes[static_cast<std::size_t>(i % 20)]).distance_m;
  }
  const std::size_t allocations = counter.count();
  EXPECT_EQ(allocations, 0u);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace saras
