#include "saras/contact/contact_force.hpp"

#include <gtest/gtest.h>

#include "support/no_allocation.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

TEST(ContactForce, ReactionPushesOutwardsAndTheToolInwards) {
  ContactForce law({});
  const ContactForceOutput out = law.step({true, 0.002, {0, 0, 3}, 0.0}, 0.016);
  ASSERT_TRUE(out.has_estimate);
  EXPECT_NEAR(out.reaction.z(), 0.6, 1e-12);
  EXPECT_NEAR(out.exerted.force.z(), -0.6, 1e-12);
  EXPECT_TRUE(out.exerted.torque.isZero());
}

TEST(ContactForce, NothingBadBecomesAForce) {
  test::RandomValues random(1);
  ContactForce law({});
  for (int i = 0; i < 20000; ++i) {
    const double spoilt = random.chance(0.5) ? test::kNan : random.chance(0.5) ? test::kInf : -test::kInf;
    ContactForceInput in{random.chance(0.5), random.uniform(-0.01, 0.05), random.vector(1.0),
                         random.uniform(-0.1, 0.5)};
    Seconds dt = random.uniform(0.001, 0.05);
    for (double* number : {&in.depth_m, &in.direction.x(), &in.age_s, &dt}) {
      *number = random.chance(0.1) ? spoilt : *number;
    }
    const ContactForceOutput out = law.step(in, dt);
    if (out.has_estimate) {
      EXPECT_TRUE(is_finite(out.exerted));
      EXPECT_LE(out.reaction.norm(), law.config().force_limit_N + 1e-9);
      EXPECT_LE(out.age_s, law.config().age_limit_s);
      EXPECT_EQ(out.status, Status::kOk);
    } else {
      EXPECT_FALSE(is_finite(out.exerted));
      EXPECT_NE(out.status, Status::kOk);
    }
  }
}

TEST(ContactForce, Allocation) {
  ContactForceInput in{true, 0.001, Vector3::UnitZ(), 0.0};
  test::expect_no_allocation(ContactForce({}), in, {&in.depth_m, &in.direction.x(), &in.age_s});
}

}  // namespace
}  // namespace saras
