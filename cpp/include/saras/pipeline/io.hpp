// What goes into the pipeline and comes out of it each tick: plain values of both sides.
//
// Ages are those of the newest information at the time of the step, judged by the pipeline's own limits: whoever fills
// them in reads clocks, the pipeline does not.
#pragma once

#include <array>
#include <limits>

#include "saras/collision/proximity_monitor.hpp"
#include "saras/csa/fixture_force.hpp"
#include "saras/net/touchball_packet.hpp"
#include "saras/spatial/law.hpp"
#include "saras/teleop/energy_ledger.hpp"
#include "saras/teleop/energy_tank.hpp"

namespace saras {

/// left, right: the order of all arrays here and of the tanks' channels.
inline constexpr int kSides = 2;
/// Tools beside the two SARAS instruments that the distances take in.
inline constexpr int kMaxOtherTools = 6;

inline constexpr Seconds kNever = std::numeric_limits<double>::infinity();  ///< age of what never came

/// The newest datagram of a console, as far as it is about one handle.
struct HandleInput {
  bool is_new = false;  ///< came since the last step, with a valid reading
  Seconds age_s = kNever;
  Pose simball_T_handle;
  bool clutch = false;
  PortLedger ledger;  ///< the port guard's, to tank_master
};

/// The newest sample of an arm, base frame of the arm.
struct ArmInput {
  bool is_new = false;  ///< came since the last step
  Seconds age_s = kNever;
  Seconds interval_s = 0.0;  ///< of a new one: since the sample that the pipeline saw before, by their stamps
  Pose base_T_tip;
  Vector3 target = Vector3::Zero();  ///< tip position that its servo follows; read with PipelineConfig::observe
  bool has_rcm = false;
  Vector3 rcm = Vector3::Zero();  ///< trocar
  Seconds wrench_age_s = kNever;
  Wrench exerted_wrench;  ///< on the tissue: sensor, contact force or the arm's own observer
};

/// What the supervisor says of a side.
struct SupervisorWord {
  Seconds age_s = kNever;
  ChannelState state = ChannelState::kWaiting;
  std::uint64_t engagement = 0;
  bool clutch = false;
};

/// What an outside monitor says of a side's tool, in the arm's base frame; not read when the pipeline has its own.
struct NearnessInput {
  Seconds age_s = kNever;
  double max_speed_scale = 0.0;
  Vector3 approach_direction = Vector3::Zero();
  double approach_speed_limit_m_s = std::numeric_limits<double>::infinity();
  double distance_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN: unknown
};

struct SideInput {
  HandleInput handle;
  ArmInput arm;
  SupervisorWord channel;
  NearnessInput nearness;
  csa::FixtureWord fixtures;  ///< of PipelineConfig::fixtures
};

/// Where everything is that the tools could meet, in the world; read with PipelineConfig::distances.
struct SceneInput {
  Seconds age_s = kNever;
  std::array<bool, kSides> base_known{};
  std::array<Pose, kSides> world_T_base;
  std::array<SceneTool, kMaxOtherTools> others;  ///< tools of other robots; as many as configured
  bool regions_known = false;
  Pose world_T_regions;
};

struct PipelineInput {
  std::array<SideInput, kSides> sides;
  SceneInput scene;
  bool overrun = false;  ///< the loop was late: the integrators take one nominal period at most
  bool hold = false;     ///< the loop was too late: both sides stand until their next engagement
};

struct PipelineSideOutput {
  ChannelState state = ChannelState::kWaiting;  ///< in effect: HOLD when the supervisor is silent or the loop was late
  std::uint64_t engagement = 0;
  bool has_tracked = false;  ///< a handle was mapped since the start
  bool is_mapped = false;    ///< in this step: the tracked values are new
  Pose tracked_pose;         ///< base_T_tracked
  Twist tracked_twist, tracked_twist_filtered, handle_twist;
  Wrench desired_wrench;             ///< on the hand, of transparency
  Twist desired_twist;               ///< of the tip, of transparency
  Vector6 error = Vector6::Zero();   ///< slave - mapped master
  Wrench base_wrench, touch_wrench;  ///< on the hand, what passivity lets through
  Twist twist;                       ///< of the tip, what passivity lets through
  bool has_set_point = false;        ///< and the arm is there to hold it
  Pose set_point;                    ///< base_T_tip
  double lead_m = 0.0;
  bool wrench_known = false;
  Wrench tissue_wrench;    ///< zero when not known
  PortLedger to_guard;     ///< tank_master's, to the port guard
  NearnessInput nearness;  ///< as used; age_s is not told
  csa::FixtureForceOutput fixtures;
  Status mapping = Status::kWaiting, transparency = Status::kWaiting, integrator = Status::kWaiting;
  bool speed_limited = false, approach_limited = false, lead_limited = false, workspace_limited = false,
       fixture_limited = false;
};

/// Of one tank after the step; cumulative joules since the start.
struct TankOutput {
  double energy_J = 0.0, work_out_J = 0.0, received_J = 0.0, sent_J = 0.0, vented_J = 0.0, granted_J = 0.0;
  double reduction = 0.0, scale = 1.0;
  Vector6 damping = Vector6::Zero();
  bool requesting = false, has_room = true;
  Status status = Status::kWaiting;
  LedgerMessage to_peer;  ///< to the other tank
};

struct PipelineOutput {
  std::array<PipelineSideOutput, kSides> sides;
  TankOutput tank_master, tank_slave;
  Status proximity = Status::kWaiting;  ///< of the distances, when the pipeline takes them
  Status status = Status::kOk;          ///< the worst of transparency and integrators of the engaged sides
};

}  // namespace saras
