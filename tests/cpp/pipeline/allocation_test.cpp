// A step of the whole pipeline allocates nothing, whatever the input.
#include <gtest/gtest.h>

#include "pipeline/rig.hpp"
#include "support/no_allocation.hpp"

namespace saras {
namespace {

class Distances : public testing::TestWithParam<bool> {};

TEST_P(Distances, PipelineAllocatesNothing) {
  PipelineConfig config = test::pipeline_config(GetParam());
  config.observe = GetParam();
  test::PipelineRig rig(1);
  PipelineInput in = rig.next();
  in.sides[0].arm.is_new = true;
  test::expect_no_allocation(Pipeline(config), in,
                             {&in.sides[0].handle.simball_T_handle.translation.x(), &in.sides[1].arm.age_s,
                              &in.sides[0].arm.exerted_wrench.force.x(), &in.sides[0].arm.base_T_tip.translation.y()});
}

TEST_P(Distances, PipelineAllocatesNothingInALongRun) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  Pipeline pipeline(test::pipeline_config(GetParam()));
  test::PipelineRig rig(2);
  for (int k = 0; k < 2000; ++k) {
    PipelineInput input = rig.next();
    input.hold = k == 1500;
    input.sides[1].handle.age_s = k > 1000 ? 1.0 : 0.0;
    const test::MallocCounter counter;
    const PipelineOutput output = pipeline.step(input, 0.001);
    ASSERT_EQ(counter.count(), 0u) << "tick " << k;
    rig.follow(output);
  }
}

INSTANTIATE_TEST_SUITE_P(, Distances, testing::Bool());

}  // namespace
}  // namespace saras
