// Parameters of the whole pipeline: each law's own, and how old what it reads may be.
#pragma once

#include <array>
#include <vector>

#include "saras/collision/proximity_monitor.hpp"
#include "saras/collision/repulsive_force.hpp"
#include "saras/csa/fixture_force.hpp"
#include "saras/pipeline/io.hpp"
#include "saras/teleop/disturbance_observer.hpp"
#include "saras/teleop/energy_tank.hpp"
#include "saras/teleop/frame_mapping.hpp"
#include "saras/teleop/transparency.hpp"
#include "saras/teleop/twist_estimator.hpp"
#include "saras/teleop/velocity_integrator.hpp"

namespace saras {

/// The distances that the pipeline takes itself: both SARAS instruments, other tools, forbidden regions.
struct DistancesConfig {
  bool enabled = false;            ///< else NearnessInput is read
  ProximityMonitorConfig monitor;  ///< thresholds and speeds
  double radius_m = 0.0025;        ///< of a SARAS instrument's shaft
  int other_tools = 0;             ///< 0 … kMaxOtherTools
  std::vector<Corners> regions;    ///< in their own frame
  Seconds scene_timeout_s = 0.1;   ///< an older SceneInput is unknown
};

struct PipelineConfig {
  std::array<FrameMappingConfig, kSides> mapping;
  TransparencyConfig transparency;
  TwistEstimatorConfig slave_twist;
  RepulsiveForceConfig repulsion;
  bool proximity_force = false;  ///< push the hand away from what its tool comes near to
  EnergyTankConfig tank_master;  ///< bills no port: the port guards do
  EnergyTankConfig tank_slave;
  std::array<VelocityIntegratorConfig, kSides> integrator;
  bool proximity_slowdown = false;                           ///< bound the speed near things and while they are unknown
  std::array<double, kSides> unknown_speed_m_s{0.02, 0.02};  ///< with it, while the nearness is unknown
  DistancesConfig distances;
  std::array<std::vector<csa::TeleopFixture>, kSides> fixtures;  ///< virtual ones, each in its arm's base frame
  csa::FixtureForceConfig fixture_force;
  bool observe = false;  ///< wrench on the tissue from the observer; else from ArmInput
  DisturbanceObserverConfig observer;
  Seconds handle_timeout_s = 0.06;    ///< an older handle is stale
  Seconds arm_timeout_s = 0.1;        ///< an older pose or wrench of the arm is unknown
  Seconds channel_timeout_s = 0.35;   ///< a supervisor silent for longer means HOLD
  Seconds peer_timeout_s = 0.2;       ///< a port guard silent for longer asks for nothing and has no room
  Seconds nearness_timeout_s = 0.15;  ///< an older NearnessInput is unknown
  std::uint64_t session = 1;          ///< of the tanks' ledgers: larger for every restart

  void validate() const;  ///< throws ConfigError
};

}  // namespace saras
