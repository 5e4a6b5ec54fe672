// One side of the pipeline: what belongs to one hand and its arm. The tanks lie between command() and move().
#pragma once

#include "saras/csa/fixture_integrator.hpp"
#include "saras/pipeline/config.hpp"
#include "saras/pipeline/tip_port.hpp"

namespace saras {

struct PipelineSideState {
  FrameMappingState mapping;
  TransparencyState transparency;
  TwistEstimatorState tip_twist;
  DisturbanceObserverState observer;
  csa::FixtureIntegratorState integrator;
  csa::FixtureForceState fixture_force;
  TipPortState port;
  bool has_tracked = false;
  Pose tracked_pose;
  Twist tracked_twist, tracked_twist_filtered, handle_twist;
  Twist slave_twist;  ///< of the tip, filtered
  bool observed = false;
  Wrench observed_wrench;
  Wrench desired_wrench;
  Twist desired_twist;
  Vector3 hand_ahead = Vector3::Zero();  ///< of the tip, as transparency last said [m]
  bool has_set_point = false;
  Pose set_point;
  Seconds since_handle_s = 0.0;   ///< since the last new handle
  Seconds since_mapped_s = 0.0;   ///< since the last one that could be used
  Seconds since_command_s = 0.0;  ///< since the last step of transparency
  std::uint64_t seen_engagement = 0;
  bool held = false;  ///< stands until the next engagement, whatever the supervisor says
};

/// The stages in their order: engage, observe, command, (tanks), move. Each is noexcept and allocates nothing.
class PipelineSide {
 public:
  PipelineSide(const PipelineConfig& config, int side);

  /// The operating state in effect. True when a new engagement begins: new references, a new start from measured.
  bool engage(const SideInput& input, bool hold, PipelineSideOutput& output) noexcept;
  /// The arm: twist and wrench of the tip, and what its port did. Returns the account for tank_slave.
  TipPortOutput observe(const SideInput& input, Seconds dt, PipelineSideOutput& output) noexcept;
  /// The hand and what both should do to each other.
  void command(const SideInput& input, const NearnessInput& nearness, Seconds dt, PipelineSideOutput& output) noexcept;
  /// The wrench that tank_master lets through, to the hand.
  void feel(const Wrench& base_wrench, PipelineSideOutput& output) const noexcept;
  /// The twist that tank_slave lets through, to the set-point.
  void move(const SideInput& input, const NearnessInput& nearness, const Twist& twist, Seconds dt,
            PipelineSideOutput& output) noexcept;

  bool engaged() const { return engaged_; }
  bool handle_fresh(const SideInput& input) const { return state_.has_tracked && !handle_stale(input); }
  bool arm_fresh(const SideInput& input) const { return input.arm.age_s <= arm_timeout_s_ && input.arm.has_rcm; }
  NearnessInput unknown_nearness() const;

  PipelineSideState state() const noexcept;
  void reset(const PipelineSideState& state) noexcept;

 private:
  /// A handle that comes and cannot be used is as silent as one that does not come.
  bool handle_stale(const SideInput& input) const {
    return !(input.handle.age_s <= handle_timeout_s_) ||
           (state_.has_tracked && state_.since_mapped_s > handle_timeout_s_);
  }
  void map(const HandleInput& handle, PipelineSideOutput& output) noexcept;

  FrameMapping mapping_;
  Transparency transparency_;
  TwistEstimator tip_twist_;
  DisturbanceObserver observer_;
  csa::FixtureIntegrator integrator_;
  RepulsiveForce repulsion_;
  csa::FixtureForce fixtures_;
  TipPort port_;
  Quaternion touch_R_base_;
  bool observes_, pushes_, slows_;
  double unknown_scale_;
  Seconds handle_timeout_s_, arm_timeout_s_, channel_timeout_s_;
  bool engaged_ = false;
  PipelineSideState state_;  ///< without the laws' own states: those are in the laws
};

}  // namespace saras
