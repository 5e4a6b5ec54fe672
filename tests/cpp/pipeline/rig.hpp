// A pipeline with two moving hands, two arms that follow, and something near.
#pragma once

#include <cmath>

#include "saras/pipeline/pipeline.hpp"
#include "support/random_values.hpp"

namespace saras::test {

/// A floor, a region kept in and a soft path near where the tips move.
inline std::vector<csa::TeleopFixture> fixtures() {
  csa::TeleopFixture floor;
  floor.fixture = {"floor", csa::PlaneFixture{Vector3(0.18, 0.0, -0.182), Vector3::UnitZ(), 0.001}, false};
  csa::TeleopFixture region;
  csa::HullFixture hull;
  hull.faces.resize(4, 4);
  hull.faces << 1, 0, 0, 0.184, -1, 0, 0, -0.176, 0, 1, 0, 0.004, 0, -1, 0, 0.004;
  region.fixture = {"region", hull, false};
  csa::TeleopFixture path;
  path.fixture = {"path", csa::PathFixture{{Vector3(0.17, 0, -0.18), Vector3(0.19, 0.01, -0.18)}, 0.001}, true};
  return {floor, region, path};
}

inline PipelineConfig pipeline_config(bool distances = true) {
  PipelineConfig config;
  config.transparency.slave_lag_s = 0.04;
  config.tank_master.damping_min.setZero();
  config.tank_master.damping_max.setZero();
  config.tank_master.hold_s = 0.012;
  config.tank_master.dt_max_s = 0.1;
  config.tank_slave.damping_min << 1e-3, 1e-3, 1e-3, 0, 0, 0;
  config.tank_slave.damping_max << 3e-3, 3e-3, 3e-3, 0, 0, 0;
  config.tank_slave.conjugate_rate << 400, 400, 400, 40, 40, 40;
  config.tank_slave.applied_limit << 0.1, 0.1, 0.1, 1, 1, 1;
  config.tank_slave.hold_s = 0.03;
  config.tank_slave.dt_max_s = 0.1;
  for (VelocityIntegratorConfig& integrator : config.integrator) {
    integrator.shaft_through_rcm = true;
    integrator.dt_max_s = 0.1;
  }
  config.proximity_force = config.proximity_slowdown = true;
  config.distances.enabled = distances;
  config.distances.other_tools = distances ? 2 : 0;
  if (distances) {
    const Parallelepiped box({0.1, -0.1, -0.5}, {0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.25});
    config.distances.regions = {box.corners()};
    config.fixtures[0] = fixtures();
    config.fixtures[1] = {config.fixtures[0][1]};
  }
  return config;
}

/// Inputs of a run, tick by tick. Arms bring a sample every tenth tick, hands each tick.
class PipelineRig {
 public:
  explicit PipelineRig(unsigned seed) : random_(seed) {
    for (int i = 0; i < kSides; ++i) {
      SideInput& side = input_.sides[static_cast<std::size_t>(i)];
      side.arm.base_T_tip = {Quaternion(0, 1, 0, 0), Vector3(0.18, 0.0, -0.18)};
      side.arm.rcm = Vector3(0.18, 0.0, -0.10);
      side.arm.has_rcm = true;
      side.channel.state = ChannelState::kEngaged;
      side.channel.engagement = 1;
      side.handle.ledger.session = 7;
      input_.scene.base_known[static_cast<std::size_t>(i)] = true;
    }
    input_.scene.world_T_base[1].translation.x() = 0.3;
    input_.scene.regions_known = true;
    for (SceneTool& tool : input_.scene.others) {
      tool = {{Vector3(0.5, 0.2, -0.2), Vector3(0.5, 0.2, 0.0), 0.004}, true};
    }
  }

  const PipelineInput& next() {
    ++tick_;
    const double t = 0.001 * tick_;
    for (int i = 0; i < kSides; ++i) {
      SideInput& side = input_.sides[static_cast<std::size_t>(i)];
      side.handle.is_new = true;
      side.handle.age_s = 0.0;
      side.handle.simball_T_handle.translation = {0.02 * std::cos(2 * t + i), 0.02 * std::sin(2 * t), -0.22};
      side.handle.ledger.seq = static_cast<std::uint64_t>(tick_);
      side.handle.ledger.has_room = true;
      side.channel.age_s = side.arm.wrench_age_s = 0.0;
      side.arm.is_new = tick_ % 10 == 0;
      side.arm.age_s = 0.001 * (tick_ % 10);
      side.arm.interval_s = 0.01;
      if (side.arm.is_new) {
        side.arm.base_T_tip.translation +=
            0.2 * (set_point_[static_cast<std::size_t>(i)] - side.arm.base_T_tip.translation);
        side.arm.exerted_wrench.force = random_.vector(0.5);
      }
      side.nearness = {0.0, 0.8, Vector3(0, 0, -1), 0.05, 0.008};
    }
    input_.scene.age_s = 0.0;
    return input_;
  }
  /// The arms follow from here on.
  void follow(const PipelineOutput& output) {
    for (std::size_t i = 0; i < kSides; ++i) {
      set_point_[i] = output.sides[i].has_set_point ? output.sides[i].set_point.translation
                                                    : input_.sides[i].arm.base_T_tip.translation;
    }
  }
  PipelineInput& input() { return input_; }
  RandomValues& random() { return random_; }

 private:
  RandomValues random_;
  int tick_ = 0;
  PipelineInput input_;
  std::array<Vector3, kSides> set_point_{Vector3(0.18, 0.0, -0.18), Vector3(0.18, 0.0, -0.18)};
};

}  // namespace saras::test
