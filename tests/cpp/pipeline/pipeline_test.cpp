#include "saras/pipeline/pipeline.hpp"

#include <gtest/gtest.h>

#include "pipeline/rig.hpp"
#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

constexpr Seconds kDt = 0.001;
/// tank_slave's compliance under the rig's forces: an engaged arm yields, also when its hand is silent.
constexpr double kMostYielding = 3e-3 * 0.9;

bool same(const Pose& a, const Pose& b) {
  return a.rotation.coeffs() == b.rotation.coeffs() && a.translation == b.translation;
}

void expect_same(const PipelineOutput& a, const PipelineOutput& b) {
  for (std::size_t i = 0; i < kSides; ++i) {
    EXPECT_TRUE(same(a.sides[i].set_point, b.sides[i].set_point));
    EXPECT_TRUE(same(a.sides[i].tracked_pose, b.sides[i].tracked_pose));
    EXPECT_EQ(to_vector(a.sides[i].touch_wrench), to_vector(b.sides[i].touch_wrench));
    EXPECT_EQ(to_vector(a.sides[i].twist), to_vector(b.sides[i].twist));
    EXPECT_EQ(a.sides[i].to_guard.sent_J, b.sides[i].to_guard.sent_J);
  }
  EXPECT_EQ(a.tank_master.energy_J, b.tank_master.energy_J);
  EXPECT_EQ(a.tank_slave.energy_J, b.tank_slave.energy_J);
}

TEST(Pipeline, SetPointsFollowTheHandsHalfAsFar) {
  Pipeline pipeline(test::pipeline_config(false));
  test::PipelineRig rig(1);
  Vector3 lowest = Vector3::Constant(1.0);
  Vector3 highest = Vector3::Constant(-1.0);
  for (int k = 0; k < 6000; ++k) {
    PipelineInput input = rig.next();
    for (SideInput& side : input.sides) {
      side.arm.exerted_wrench = {};
      side.nearness.approach_speed_limit_m_s = 1.0;
      side.nearness.max_speed_scale = 1.0;
      side.nearness.distance_m = 0.1;
    }
    const PipelineOutput output = pipeline.step(input, kDt);
    rig.follow(output);
    if (k > 100) {
      ASSERT_TRUE(output.sides[0].has_set_point);
      lowest = lowest.cwiseMin(output.sides[0].set_point.translation);
      highest = highest.cwiseMax(output.sides[0].set_point.translation);
      ASSERT_EQ(output.sides[0].state, ChannelState::kEngaged);
    }
  }
  EXPECT_NEAR((highest - lowest).x(), 0.02, 0.002);
  EXPECT_NEAR((highest - lowest).y(), 0.02, 0.002);
}

TEST(Pipeline, AStateIsAValue) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const PipelineConfig config = test::pipeline_config(seed % 2 == 0);
    Pipeline one(config);
    Pipeline other(config);
    test::PipelineRig rig(seed);
    for (int k = 0; k < 400; ++k) {
      PipelineInput input = rig.next();
      input.overrun = rig.random().chance(0.05);
      input.hold = rig.random().chance(0.005);
      input.sides[0].handle.is_new = rig.random().chance(0.9);
      input.sides[1].handle.age_s = rig.random().chance(0.1) ? 1.0 : 0.0;
      input.sides[0].channel.engagement = 1 + static_cast<std::uint64_t>(k / 100);
      const double dt = rig.random().uniform(5e-4, 2e-3);
      if (k % 37 == 0) {
        Pipeline copy(config);
        copy.reset(one.state());
        other = std::move(copy);
      }
      const PipelineOutput output = one.step(input, dt);
      expect_same(output, other.step(input, dt));
      rig.follow(output);
    }
    EXPECT_GT(one.state().tank_master.tank.granted_J, one.config().tank_master.minimum_J);
  }
}

TEST(Pipeline, AnInvalidTimeStepChangesNothing) {
  Pipeline pipeline(test::pipeline_config());
  test::PipelineRig rig(3);
  for (int k = 0; k < 200; ++k) {
    rig.follow(pipeline.step(rig.next(), kDt));
  }
  Pipeline untouched = pipeline;
  const PipelineInput input = rig.next();
  for (const double dt : {0.0, -1.0, test::kNan, test::kInf}) {
    const PipelineOutput output = pipeline.step(input, dt);
    EXPECT_EQ(output.status, Status::kInvalidTimeStep);
    EXPECT_EQ(to_vector(output.sides[0].touch_wrench), Vector6::Zero());
    EXPECT_EQ(to_vector(output.sides[0].twist), Vector6::Zero());
  }
  expect_same(pipeline.step(input, kDt), untouched.step(input, kDt));
}

TEST(Pipeline, HoldLastsUntilTheNextEngagement) {
  Pipeline pipeline(test::pipeline_config());
  test::PipelineRig rig(4);
  for (int k = 0; k < 300; ++k) {
    rig.follow(pipeline.step(rig.next(), kDt));
  }
  PipelineInput held = rig.next();
  held.hold = true;
  const Pose stopped = pipeline.step(held, kDt).sides[0].set_point;
  for (int k = 0; k < 300; ++k) {
    const PipelineOutput output = pipeline.step(rig.next(), kDt);
    for (const PipelineSideOutput& side : output.sides) {
      EXPECT_EQ(side.state, ChannelState::kHold);
      EXPECT_EQ(to_vector(side.twist), Vector6::Zero());
    }
    EXPECT_TRUE(same(output.sides[0].set_point, stopped));
    if (k > 150) {
      EXPECT_EQ(to_vector(output.sides[0].touch_wrench), Vector6::Zero()) << "the force has faded";
    }
  }
  PipelineInput engaged = rig.next();
  engaged.sides[0].channel.engagement = 2;
  const PipelineOutput output = pipeline.step(engaged, kDt);
  EXPECT_EQ(output.sides[0].state, ChannelState::kEngaged);
  EXPECT_EQ(output.sides[1].state, ChannelState::kHold) << "the other side was not engaged again";
}

TEST(Pipeline, OfAnOverrunTheIntegratorTakesOnePeriod) {
  PipelineConfig config = test::pipeline_config(false);
  for (VelocityIntegratorConfig& integrator : config.integrator) {
    integrator.nominal_dt_s = 0.001;
  }
  Pipeline pipeline(config);
  test::PipelineRig rig(5);
  Vector3 before = Vector3::Zero();
  for (int k = 0; k < 500; ++k) {
    const PipelineOutput output = pipeline.step(rig.next(), kDt);
    rig.follow(output);
    before = output.sides[0].set_point.translation;
  }
  PipelineInput input = rig.next();
  input.overrun = true;
  const PipelineOutput output = pipeline.step(input, 0.05);
  EXPECT_LE((output.sides[0].set_point.translation - before).norm(), 0.1 * 0.001 + 1e-12);
}

/// What a silent part must lead to, in the same step as its age passes the limit.
struct Silence {
  const char* name;
  void (*make)(SideInput&);
};

class Silent : public testing::TestWithParam<Silence> {};

TEST_P(Silent, StopsItsSideAndLeavesTheOther) {
  Pipeline pipeline(test::pipeline_config(false));
  test::PipelineRig rig(6);
  for (int k = 0; k < 300; ++k) {
    rig.follow(pipeline.step(rig.next(), kDt));
  }
  PipelineOutput output;
  for (int k = 0; k < 150; ++k) {
    PipelineInput input = rig.next();
    GetParam().make(input.sides[0]);
    output = pipeline.step(input, kDt);
    EXPECT_EQ(to_vector(output.sides[0].desired_twist), Vector6::Zero()) << GetParam().name;
    EXPECT_LE(to_vector(output.sides[0].twist).norm(), kMostYielding) << GetParam().name;
  }
  EXPECT_EQ(to_vector(output.sides[0].touch_wrench), Vector6::Zero()) << GetParam().name;
  EXPECT_GT(to_vector(output.sides[1].twist).norm(), 0.0) << "the other side goes on";
}

INSTANTIATE_TEST_SUITE_P(, Silent,
                         testing::Values(Silence{"handle",
                                                 [](SideInput& side) {
                                                   side.handle.is_new = false;
                                                   side.handle.age_s = 0.2;
                                                 }},
                                         Silence{"arm",
                                                 [](SideInput& side) {
                                                   side.arm.is_new = false;
                                                   side.arm.age_s = 0.2;
                                                 }},
                                         Silence{"supervisor", [](SideInput& side) { side.channel.age_s = 1.0; }},
                                         Silence{"hold",
                                                 [](SideInput& side) { side.channel.state = ChannelState::kHold; }}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Pipeline, AnUnknownWrenchMovesNothing) {
  Pipeline pipeline(test::pipeline_config(false));
  test::PipelineRig rig(7);
  for (int k = 0; k < 300; ++k) {
    rig.follow(pipeline.step(rig.next(), kDt));
  }
  PipelineInput input = rig.next();
  input.sides[0].arm.wrench_age_s = 0.2;
  const PipelineOutput output = pipeline.step(input, kDt);
  EXPECT_FALSE(output.sides[0].wrench_known);
  EXPECT_EQ(to_vector(output.sides[0].twist), Vector6::Zero());
}

TEST(Pipeline, WhatIsUnknownIsSlow) {
  PipelineConfig config = test::pipeline_config(true);
  Pipeline pipeline(config);
  test::PipelineRig rig(8);
  for (int k = 0; k < 400; ++k) {
    PipelineInput input = rig.next();
    input.scene.age_s = 1.0;
    const PipelineOutput output = pipeline.step(input, kDt);
    rig.follow(output);
    EXPECT_EQ(output.proximity, Status::kStale);
    EXPECT_NEAR(output.sides[0].nearness.max_speed_scale, 0.2, 1e-12);
    EXPECT_TRUE(std::isnan(output.sides[0].nearness.distance_m));
  }
}

TEST(Pipeline, AHandleThatCannotBeUsedGrowsStale) {
  Pipeline pipeline(test::pipeline_config(false));
  test::PipelineRig rig(9);
  for (int k = 0; k < 300; ++k) {
    rig.follow(pipeline.step(rig.next(), kDt));
  }
  PipelineOutput output;
  for (int k = 0; k < 200; ++k) {
    PipelineInput input = rig.next();
    input.sides[0].handle.simball_T_handle.translation.x() = test::kNan;
    output = pipeline.step(input, kDt);
  }
  EXPECT_EQ(output.sides[0].mapping, Status::kInvalidInput);
  EXPECT_EQ(to_vector(output.sides[0].desired_twist), Vector6::Zero());
  EXPECT_LE(to_vector(output.sides[0].twist).norm(), kMostYielding);
  EXPECT_EQ(to_vector(output.sides[0].touch_wrench), Vector6::Zero());
}

TEST(Pipeline, RefusesWhatItsLawsRefuse) {
  PipelineConfig config = test::pipeline_config();
  config.integrator[1].speed_limit_m_s = -1.0;
  EXPECT_THROW(Pipeline{config}, ConfigError);
  config = test::pipeline_config();
  config.handle_timeout_s = test::kNan;
  EXPECT_THROW(Pipeline{config}, ConfigError);
  config = test::pipeline_config();
  config.distances.other_tools = kMaxOtherTools + 1;
  EXPECT_THROW(Pipeline{config}, ConfigError);
  config = test::pipeline_config();
  config.mapping[0].mapping = Mapping::kEndoscope;
  EXPECT_THROW(Pipeline{config}, ConfigError);
}

}  // namespace
}  // namespace saras
