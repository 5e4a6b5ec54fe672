// Both sides in one step: from the hands' poses to the arms' set-points and back to the wrenches on the hands.
//
// The same laws in the same order as the nodes of the separate graph, as one value: no topic lies between them, and a
// recorded run of the whole replays bit for bit.
#pragma once

#include <memory>
#include <optional>

#include "saras/pipeline/side.hpp"
#include "saras/pipeline/tank_exchange.hpp"

namespace saras {

struct PipelineState {
  std::array<PipelineSideState, kSides> sides;
  TankNodeState tank_master, tank_slave;
  ProximityMonitorState proximity;
};

/// Order of a step: engagements (each grants both tanks their charge), distances, arms, hands and transparency,
/// tank_master, tank_slave, integrators. tank_master's peers are both port guards and tank_slave; between the two tanks
/// energy travels by the same ledgers as over a network, towards tank_slave within the step, back in the next one.
///
/// A step belongs to a new handle pose (HandleInput::is_new), or to a time-out. A side without one keeps its last
/// command until its handle is stale; its twists are means over the whole interval between two poses.
///
/// dt not finite or not positive: no wrench, no twist, the last set-points; state as it was (INVALID_TIME_STEP). A long
/// dt is each law's own matter (dt_max_s). overrun: the integrators take nominal_dt_s at most.
class Pipeline {
 public:
  explicit Pipeline(PipelineConfig config);
  PipelineOutput step(const PipelineInput& input, Seconds dt) noexcept;
  /// Without an argument: as constructed. Throws ConfigError for a state that is none of this pipeline.
  void reset();
  void reset(const PipelineState& state);
  /// Gathered at each call.
  const PipelineState& state() const;
  const PipelineConfig& config() const { return config_; }
  /// Distances of the last step, when the pipeline takes them: the SARAS instruments, then the other tools.
  const ProximityMonitorOutput& distances() const { return distances_; }
  int tools() const { return monitor_ ? monitor_->tools() : 0; }
  /// (tip, trocar, radius) of each tool as it was taken in the last step, world.
  const std::array<SceneTool, kMaxTools>& capsules() const { return capsules_.tools; }

 private:
  void look(const PipelineInput& input, Seconds dt, PipelineOutput& output) noexcept;
  NearnessInput nearness(const PipelineInput& input, int side) const noexcept;
  void master(const PipelineInput& input, Seconds dt, PipelineOutput& output) noexcept;
  void slave(const std::array<TipPortOutput, kSides>& ports, Seconds dt, PipelineOutput& output) noexcept;

  PipelineConfig config_;
  std::array<PipelineSide, kSides> sides_;
  TankNode tank_master_, tank_slave_;
  std::optional<ProximityMonitor> monitor_;
  ProximityMonitorInput capsules_;
  ProximityMonitorOutput distances_;
  mutable PipelineState state_;
};

static_assert(has_law_shape<Pipeline, PipelineInput, PipelineState>());

}  // namespace saras
