#include "saras/model/stiffness_gp.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"
#include "support/no_allocation.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using test::kNan;
using test::RandomValues;

constexpr double kStiffness = 400.0;
constexpr Seconds kDt = 1e-3;

/// A plane z = 0 of one stiffness, pressed to and fro while the tip wanders at 10 mm/s.
StiffnessGpInput press(int tick, RandomValues& random, double surface_m = 0.0) {
  const double t = kDt * tick;
  StiffnessGpInput input;
  const double depth = 2e-3 + 1e-3 * std::sin(6.0 * t);
  input.tip_position = {0.015 * std::sin(0.7 * t), 0.015 * std::sin(0.31 * t), surface_m - depth};
  input.force = {0.0, 0.0, -kStiffness * depth};
  input.force += random.vector(0.02);
  return input;
}

TEST(StiffnessGp, FindsStiffnessAndSurfaceOfAPlane) {
  RandomValues random(1);
  StiffnessGp law;
  StiffnessGpOutput output;
  for (int i = 0; i < 20000; ++i) {
    output = law.step(press(i, random), kDt);
    ASSERT_EQ(output.verdict, SampleVerdict::kLearned) << i;
  }
  EXPECT_EQ(output.status, Status::kOk);
  EXPECT_NEAR(output.estimate.stiffness_N_m, kStiffness, 0.03 * kStiffness);
  EXPECT_NEAR(output.estimate.surface_point.z(), 0.0, 5e-5);
  EXPECT_GT(output.estimate.normal.z(), 0.999);
  EXPECT_FALSE(output.disagrees);
}

TEST(StiffnessGp, WorkAndMemoryOfASampleAreBoundedHoweverLongTheSession) {
  RandomValues random(2);
  StiffnessGpConfig config;
  config.grid.max_cells = 300;  // fills up: cells are forgotten all the time
  StiffnessGp law(config);
  const auto n = static_cast<std::uint64_t>(config.local.neighbours);
  // A build of n appends, two exchanges, the outlier gate, the estimate: each a few n^2.
  const std::uint64_t bound = n * n * n + 40 * n * n;
  for (int i = 0; i < 120000; ++i) {
    const std::uint64_t before = law.state().local.process().work();
    law.step(press(i, random), kDt);
    ASSERT_LE(law.state().local.process().work() - before, bound) << i;
    ASSERT_LE(law.state().grid.cells(), 300);
  }
  EXPECT_GT(law.state().grid.evicted(), 0u);
}

TEST(StiffnessGp, BadSamplesAreNamedAndTeachNothing) {
  RandomValues random(3);
  StiffnessGp law;
  int tick = 0;
  for (; tick < 3000; ++tick) {
    law.step(press(tick, random), kDt);
  }
  const auto taken = law.state().grid.taken();
  const auto verdict = [&](const StiffnessGpInput& input) { return law.step(input, kDt); };
  StiffnessGpInput bad = press(tick, random);
  bad.force.z() = kNan;
  EXPECT_EQ(verdict(bad).status, Status::kInvalidInput);
  bad = press(tick, random);
  bad.force *= 1000.0;  // mN for N
  EXPECT_EQ(verdict(bad).verdict, SampleVerdict::kImplausibleForce);
  bad = press(tick, random);
  bad.tip_position *= 1000.0;  // mm for m
  EXPECT_EQ(verdict(bad).verdict, SampleVerdict::kImplausiblePosition);
  verdict(press(tick, random));  // the way back is a jump too
  bad = press(tick, random);
  bad.force.z() -= 5.0;
  const StiffnessGpOutput outlier = verdict(bad);
  EXPECT_EQ(outlier.verdict, SampleVerdict::kOutlier);
  EXPECT_EQ(outlier.status, Status::kLimited);
  EXPECT_NEAR(outlier.estimate.stiffness_N_m, kStiffness, 0.1 * kStiffness);
  bad.force.setZero();
  EXPECT_EQ(verdict(bad).verdict, SampleVerdict::kNotTouching);
  EXPECT_EQ(law.state().grid.taken(), taken);
  EXPECT_EQ(verdict(press(tick, random)).verdict, SampleVerdict::kLearned);
  EXPECT_EQ(law.step(press(tick, random), -1.0).status, Status::kInvalidTimeStep);
}

TEST(StiffnessGp, ASensorThatDriftedIsNamedAndAnOffsetIsSubtracted) {
  RandomValues random(4);
  StiffnessGp law;
  const auto free_for = [&](int ticks, const Vector3& offset) {
    StiffnessGpOutput output;
    for (int i = 0; i < ticks; ++i) {
      StiffnessGpInput input;
      input.tip_position = {0.0, 0.0, 0.005};
      input.force = offset;
      input.belief = TouchBelief::kFree;
      output = law.step(input, kDt);
    }
    return output;
  };
  const Vector3 offset(0.2, -0.1, 0.1);
  EXPECT_EQ(free_for(5000, offset).verdict, SampleVerdict::kNotTouching);
  EXPECT_NEAR((law.state().bias_N - offset).norm(), 0.0, 1e-4);
  StiffnessGp without;
  for (int i = 0; i < 5000; ++i) {
    StiffnessGpInput input = press(i, random);
    const StiffnessGpOutput expected = without.step(input, kDt);
    input.force += offset;
    const StiffnessGpOutput output = law.step(input, kDt);
    if (i > 100 && expected.status == Status::kOk) {
      const double tolerance = 0.2 * expected.estimate.stiffness_std_N_m;
      ASSERT_NEAR(output.estimate.stiffness_N_m, expected.estimate.stiffness_N_m, tolerance) << i;
    }
  }
  free_for(100, offset);  // the way up is a jump
  EXPECT_EQ(free_for(5000, {0.0, 0.0, 2.0}).verdict, SampleVerdict::kSensorDrift);
}

TEST(StiffnessGp, AnOrganThatMovedIsNoticedAndLearnedAnew) {
  RandomValues random(5);
  StiffnessGpConfig config;
  StiffnessGp law(config);
  int tick = 0;
  for (; tick < 20000; ++tick) {
    law.step(press(tick, random), kDt);
  }
  bool relearned = false;
  bool noticed = false;
  StiffnessGpOutput output;
  for (; tick < 60000; ++tick) {
    output = law.step(press(tick, random, 3e-3), kDt);  // 3 mm higher
    relearned = relearned || output.verdict == SampleVerdict::kRelearned;
    noticed = noticed || output.disagrees;
  }
  EXPECT_TRUE(relearned || noticed);
  EXPECT_NEAR(output.estimate.surface_point.z(), 3e-3, 3e-4);
}

TEST(StiffnessGp, ARecordedRunReplaysFromAnyState) {
  RandomValues random(6);
  StiffnessGp law;
  std::vector<StiffnessGpInput> inputs;
  for (int i = 0; i < 4000; ++i) {
    inputs.push_back(press(i, random));
  }
  for (int i = 0; i < 2000; ++i) {
    law.step(inputs[static_cast<std::size_t>(i)], kDt);
  }
  StiffnessGp replay;
  replay.reset(law.state());
  for (int i = 2000; i < 4000; ++i) {
    const auto a = law.step(inputs[static_cast<std::size_t>(i)], kDt);
    const auto b = replay.step(inputs[static_cast<std::size_t>(i)], kDt);
    ASSERT_EQ(a.estimate.stiffness_N_m, b.estimate.stiffness_N_m);
    ASSERT_EQ(a.estimate.surface_point, b.estimate.surface_point);
  }
}

TEST(StiffnessGp, StepAllocatesNothing) {
  RandomValues random(7);
  StiffnessGpConfig config;
  config.grid.max_cells = 100;
  StiffnessGp law(config);
  StiffnessGpInput input;
  test::expect_no_allocation(law, input, {&input.tip_position.x(), &input.force.z()});
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  for (int i = 0; i < 20000; ++i) {
    const StiffnessGpInput next = press(i, random, i > 10000 ? 2e-3 : 0.0);
    const test::MallocCounter counter;
    law.step(next, kDt);
    ASSERT_EQ(counter.count(), 0u) << i;
  }
}

TEST(StiffnessGp, ConfigurationIsRefusedByName) {
  StiffnessGpConfig config;
  config.contact_force_N = 100.0;
  EXPECT_THROW(StiffnessGp{config}, ConfigError);
  config = {};
  config.local.radius_m = 1.0;
  EXPECT_THROW(StiffnessGp{config}, ConfigError);
  config = {};
  config.local.hyperparameters.noise_N = kNan;
  EXPECT_THROW(StiffnessGp{config}, ConfigError);
}

}  // namespace
}  // namespace saras
