#include "saras/collision/proximity_monitor.hpp"

#include <gtest/gtest.h>

#include "saras/collision/repulsive_force.hpp"
#include "saras/spatial/errors.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using test::kInf;
using test::kNan;

/// One tool above a plate whose upper face is z = 0, and a second tool far away.
class Monitor : public ::testing::Test {
 protected:
  Monitor() {
    input.tools[1].capsule = {{5, 0, 1}, {5, 0, 2}, 0.0025};
    at(1.0);
  }
  void at(double distance_m) { input.tools[0].capsule = {{0, 0, distance_m + 0.0025}, {0, 0, 0.3}, 0.0025}; }
  ToolProximity step() { return monitor.step(input, 0.01).tools[0]; }
  ToolProximity step_at(double distance_m) {
    at(distance_m);
    return step();
  }

  ProximityMonitorInput input;
  ProximityMonitor monitor{
      {}, 2, {Parallelepiped(Vector3(-0.5, -0.5, -0.1), Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 0.1))}};
};

TEST_F(Monitor, StatesWithHysteresis) {
  const struct {
    double distance_mm;
    ProximityState state;
  } walk[] = {{20, ProximityState::kClear},     {10.1, ProximityState::kClear},    {9.9, ProximityState::kWarning},
              {10.9, ProximityState::kWarning}, {11.1, ProximityState::kClear},    {10.9, ProximityState::kClear},
              {2.1, ProximityState::kWarning},  {1.9, ProximityState::kCollision}, {2.9, ProximityState::kCollision},
              {3.1, ProximityState::kWarning},  {2.1, ProximityState::kWarning},   {-5, ProximityState::kCollision},
              {10.5, ProximityState::kWarning}, {30, ProximityState::kClear}};
  for (const auto& place : walk) {
    const ToolProximity tool = step_at(1e-3 * place.distance_mm);
    EXPECT_EQ(tool.state, place.state) << place.distance_mm;
    EXPECT_NEAR(tool.distance_m, 1e-3 * place.distance_mm, 1e-12);
    EXPECT_EQ(tool.partner, Partner::kRegion);
  }
}

TEST_F(Monitor, SpeedOfApproachFallsWithDistance) {
  EXPECT_NEAR(step_at(0.015).approach_speed_limit_m_s, 0.1, 1e-12);
  EXPECT_NEAR(step_at(0.008).approach_speed_limit_m_s, 0.05, 1e-12);
  EXPECT_NEAR(step_at(0.001).approach_speed_limit_m_s, 0.0, 1e-12);
  EXPECT_EQ(step_at(-0.01).approach_speed_limit_m_s, 0.0);
  EXPECT_NEAR((step_at(0.005).approach_direction + Vector3::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_EQ(step().max_speed_scale, 1.0);
  EXPECT_EQ(monitor.step(input, 0.01).status, Status::kLimited);
}

TEST_F(Monitor, UnknownIsNeverClear) {
  input.regions_known = false;
  ToolProximity tool = step_at(0.02);
  EXPECT_EQ(tool.state, ProximityState::kUnknown);
  EXPECT_TRUE(std::isnan(tool.distance_m));
  EXPECT_TRUE(tool.regions_unknown);
  EXPECT_NEAR(tool.max_speed_scale, 0.2, 1e-12);
  EXPECT_TRUE(std::isfinite(tool.known.distance_m));  // to the other tool
  EXPECT_EQ(monitor.step(input, 0.01).status, Status::kStale);

  input.regions_known = true;
  input.tools[1].known = false;
  tool = step_at(0.02);
  EXPECT_EQ(tool.state, ProximityState::kUnknown);
  EXPECT_TRUE(tool.other_tool_unknown);
  EXPECT_NEAR(tool.known.distance_m, 0.02, 1e-12);
  tool = step_at(0.005);  // what is known to be near stays so
  EXPECT_EQ(tool.state, ProximityState::kWarning);
  EXPECT_NEAR(tool.distance_m, 0.005, 1e-12);
  EXPECT_EQ(step_at(0.001).state, ProximityState::kCollision);
  EXPECT_NEAR(step().max_speed_scale, 0.2, 1e-12);

  input.tools[0].known = false;
  tool = step();
  EXPECT_EQ(tool.state, ProximityState::kUnknown);
  EXPECT_TRUE(tool.tool_unknown);
  EXPECT_EQ(tool.approach_direction, Vector3::Zero());
  EXPECT_EQ(monitor.state().levels[0], ProximityState::kCollision);  // remembered, for when it is back
}

TEST_F(Monitor, NotFiniteToolIsUnknown) {
  for (const double bad : {kNan, kInf, 1e200}) {
    at(0.02);
    input.tools[0].capsule.a.x() = bad;
    EXPECT_EQ(step().state, ProximityState::kUnknown);
  }
}

TEST_F(Monitor, InvalidTimeStepIsUnknownAndKeepsTheState) {
  step_at(0.001);
  at(0.02);
  for (const double dt : {0.0, -1.0, kNan, kInf}) {
    const ProximityMonitorOutput output = monitor.step(input, dt);
    EXPECT_EQ(output.status, Status::kInvalidTimeStep);
    EXPECT_EQ(output.tools[0].state, ProximityState::kUnknown);
    EXPECT_NEAR(output.tools[0].max_speed_scale, 0.2, 1e-12);
    EXPECT_EQ(monitor.state().levels[0], ProximityState::kCollision);
  }
}

TEST(MonitorAlone, NothingToMeetIsClear) {
  ProximityMonitor monitor({}, 1, {});
  const ProximityMonitorOutput output = monitor.step({}, 0.01);
  EXPECT_EQ(output.tools[0].state, ProximityState::kClear);
  EXPECT_EQ(output.tools[0].distance_m, kInf);
  EXPECT_EQ(output.tools[0].approach_direction, Vector3::Zero());
  EXPECT_EQ(output.tools[1].state, ProximityState::kUnknown);  // no such tool
}

TEST(MonitorConfig, NamesFieldValueAndBound) {
  const auto refused = [](auto&& spoil) {
    ProximityMonitorConfig config;
    spoil(config);
    EXPECT_THROW(config.validate(), ConfigError);
  };
  refused([](auto& c) { c.collision_m = c.warning_m; });
  refused([](auto& c) { c.collision_m = -1e-3; });
  refused([](auto& c) { c.hysteresis_m = kNan; });
  refused([](auto& c) { c.slowdown_start_m = c.slowdown_stop_m; });
  refused([](auto& c) { c.speed_limit_m_s = 0.0; });
  refused([](auto& c) { c.unknown_speed_limit_m_s = 0.11; });
  EXPECT_THROW(ProximityMonitor({}, 0, {}), ConfigError);
  EXPECT_THROW(ProximityMonitor({}, kMaxTools + 1, {}), ConfigError);
}

TEST(RepulsiveForce, PushesTheHandAwayAndNeverPulls) {
  RepulsiveForce law({});
  const Vector3 normal = -Vector3::UnitZ();
  EXPECT_EQ(law.step({0.02, normal}, 0.01).wrench.force, Vector3::Zero());
  EXPECT_EQ(law.step({0.01, normal}, 0.01).wrench.force, Vector3::Zero());
  EXPECT_NEAR(law.step({0.009, normal}, 0.01).wrench.force.z(), 0.3, 1e-12);
  const RepulsiveForceOutput deep = law.step({-0.1, normal}, 0.01);
  EXPECT_NEAR(deep.wrench.force.z(), 2.0, 1e-12);
  EXPECT_EQ(deep.status, Status::kLimited);
}

TEST(RepulsiveForce, UnknownIsZeroAndSaysSo) {
  RepulsiveForce law({});
  EXPECT_EQ(law.step({kNan, Vector3::UnitX()}, 0.01).status, Status::kStale);
  EXPECT_EQ(law.step({0.001, Vector3::Zero()}, 0.01).status, Status::kInvalidInput);
  EXPECT_EQ(law.step({0.001, Vector3::Constant(kNan)}, 0.01).status, Status::kInvalidInput);
  EXPECT_EQ(law.step({-kInf, Vector3::UnitX()}, 0.01).status, Status::kInvalidInput);
  EXPECT_EQ(law.step({0.001, Vector3::UnitX()}, 0.0).status, Status::kInvalidTimeStep);
  EXPECT_EQ(law.step({kInf, Vector3::Zero()}, 0.01).status, Status::kOk);
}

}  // namespace
}  // namespace saras
