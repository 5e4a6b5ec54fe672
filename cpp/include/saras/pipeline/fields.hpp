// The fields of everything that a pipeline is made of, in one order for writing and reading (flight records).
//
// fields(archive, value) calls archive(field, field, …). Whoever adds a field to one of these structs adds it here: the
// replay test compares whole states. A change of any list changes the number of words, which a record's header names.
#pragma once

#include "saras/pipeline/pipeline.hpp"

namespace saras {

template <class A>
void fields(A& a, Pose& x) {
  a(x.rotation.coeffs(), x.translation);
}
template <class A>
void fields(A& a, Twist& x) {
  a(x.linear, x.angular);
}
template <class A>
void fields(A& a, Wrench& x) {
  a(x.force, x.torque);
}
template <class A>
void fields(A& a, Capsule& x) {
  a(x.a, x.b, x.radius_m);
}
template <class A>
void fields(A& a, SceneTool& x) {
  a(x.capsule, x.known);
}
template <class A>
void fields(A& a, PortLedger& x) {
  a(x.session, x.seq, x.sent_J, x.requesting, x.has_room);
}
template <class A>
void fields(A& a, LedgerMessage& x) {
  a(x.session, x.seq, x.sent_J);
}
template <class A>
void fields(A& a, LedgerReceiverState& x) {
  a(x.has_baseline, x.session, x.seq, x.seen_J, x.credited_J, x.ignored);
}

template <class A>
void fields(A& a, csa::FixtureWord& x) {
  a(x.on, x.known);
}

// ---- configurations

template <class A>
void fields(A& a, FrameMappingConfig& x) {
  a(x.mapping, x.base_T_console, x.touch_T_console, x.cutoff_hz, x.dt_max_s);
}
template <class A>
void fields(A& a, TransparencyConfig& x) {
  a(x.mode, x.scale, x.stiffness_N_m, x.damping_N_s_m, x.rotation_stiffness_Nm_rad, x.rotation_damping_Nm_s_rad,
    x.force_scale, x.torque_scale, x.force_limit_N, x.torque_limit_Nm, x.ramp_s, x.drift_gain_1_s, x.drift_limit_m_s,
    x.slave_lag_s, x.rotation_drift_gain_1_s, x.rotation_drift_limit_rad_s, x.pivoted, x.pivot_radius_min_m,
    x.dt_max_s);
}
template <class A>
void fields(A& a, TwistEstimatorConfig& x) {
  a(x.cutoff_hz, x.dt_max_s);
}
template <class A>
void fields(A& a, RepulsiveForceConfig& x) {
  a(x.start_distance_m, x.stiffness_N_m, x.force_limit_N, x.dt_max_s);
}
template <class A>
void fields(A& a, EnergyTankConfig& x) {
  a(x.initial_J, x.minimum_J, x.request_J, x.available_J, x.maximum_J, x.exchange_W, x.damping_min, x.damping_max,
    x.conjugate_rate, x.applied_limit, x.hold_s, x.dt_max_s);
}
template <class A>
void fields(A& a, VelocityIntegratorConfig& x) {
  a(x.speed_limit_m_s, x.speed_limit_rad_s, x.lead_limit_m, x.lead_limit_rad, x.cone_axis, x.cone_half_angle_rad,
    x.insertion_min_m, x.insertion_max_m, x.measured_jump_m, x.shaft_through_rcm, x.nominal_dt_s, x.dt_max_s);
}
template <class A>
void fields(A& a, DisturbanceObserverConfig& x) {
  a(x.natural_frequency_rad_s, x.damping_ratio, x.mass_kg, x.cutoff_hz, x.deadband_N, x.settle_s, x.dt_max_s);
}
template <class A>
void fields(A& a, ProximityMonitorConfig& x) {
  a(x.collision_m, x.warning_m, x.hysteresis_m, x.slowdown_start_m, x.slowdown_stop_m, x.speed_limit_m_s,
    x.unknown_speed_limit_m_s);
}
template <class A>
void fields(A& a, DistancesConfig& x) {
  a(x.enabled, x.monitor, x.radius_m, x.other_tools, x.regions, x.scene_timeout_s);
}
template <class A>
void fields(A& a, csa::TeleopFixture& x) {
  std::vector<char> name(x.fixture.name.begin(), x.fixture.name.end());
  auto kind = static_cast<int>(x.fixture.geometry.index());
  std::vector<double> numbers = csa::to_numbers(x.fixture.geometry);
  a(name, x.fixture.soft, kind, numbers, x.stiffness_N_m, x.start_m);
  if constexpr (A::reads()) {
    x.fixture.name.assign(name.begin(), name.end());
    x.fixture.geometry = csa::to_geometry(kind, numbers);
  }
}
template <class A>
void fields(A& a, csa::FixtureForceConfig& x) {
  a(x.force_limit_N, x.ramp_s, x.dt_max_s);
}
template <class A>
void fields(A& a, PipelineConfig& x) {
  a(x.mapping, x.transparency, x.slave_twist, x.repulsion, x.proximity_force, x.tank_master, x.tank_slave, x.integrator,
    x.proximity_slowdown, x.unknown_speed_m_s, x.distances, x.fixtures, x.fixture_force, x.observe, x.observer,
    x.handle_timeout_s, x.arm_timeout_s, x.channel_timeout_s, x.peer_timeout_s, x.nearness_timeout_s, x.session);
}

// ---- inputs

template <class A>
void fields(A& a, HandleInput& x) {
  a(x.is_new, x.age_s, x.simball_T_handle, x.clutch, x.ledger);
}
template <class A>
void fields(A& a, ArmInput& x) {
  a(x.is_new, x.age_s, x.interval_s, x.base_T_tip, x.target, x.has_rcm, x.rcm, x.wrench_age_s, x.exerted_wrench);
}
template <class A>
void fields(A& a, SupervisorWord& x) {
  a(x.age_s, x.state, x.engagement, x.clutch);
}
template <class A>
void fields(A& a, NearnessInput& x) {
  a(x.age_s, x.max_speed_scale, x.approach_direction, x.approach_speed_limit_m_s, x.distance_m);
}
template <class A>
void fields(A& a, SideInput& x) {
  a(x.handle, x.arm, x.channel, x.nearness, x.fixtures);
}
template <class A>
void fields(A& a, SceneInput& x) {
  a(x.age_s, x.base_known, x.world_T_base, x.others, x.regions_known, x.world_T_regions);
}
template <class A>
void fields(A& a, PipelineInput& x) {
  a(x.sides, x.scene, x.overrun, x.hold);
}

// ---- outputs

template <class A>
void fields(A& a, csa::FixtureForceOutput& x) {
  a(x.wrench, x.distance_m, x.nearest, x.closest, x.normal, x.violation_m, x.status);
}
template <class A>
void fields(A& a, PipelineSideOutput& x) {
  a(x.state, x.engagement, x.has_tracked, x.is_mapped, x.tracked_pose, x.tracked_twist, x.tracked_twist_filtered,
    x.handle_twist, x.desired_wrench, x.desired_twist, x.error, x.base_wrench, x.touch_wrench, x.twist, x.has_set_point,
    x.set_point, x.lead_m, x.wrench_known, x.tissue_wrench, x.to_guard, x.nearness, x.fixtures, x.mapping,
    x.transparency, x.integrator, x.speed_limited, x.approach_limited, x.lead_limited, x.workspace_limited,
    x.fixture_limited);
}
template <class A>
void fields(A& a, TankOutput& x) {
  a(x.energy_J, x.work_out_J, x.received_J, x.sent_J, x.vented_J, x.granted_J, x.reduction, x.scale, x.damping,
    x.requesting, x.has_room, x.status, x.to_peer);
}
template <class A>
void fields(A& a, PipelineOutput& x) {
  a(x.sides, x.tank_master, x.tank_slave, x.proximity, x.status);
}

// ---- states

template <class A>
void fields(A& a, FrameMappingState& x) {
  a(x.has_reference, x.base_T_reference, x.console_T_reference, x.base_T_console, x.console_T_previous,
    x.base_T_tracked, x.tracked_twist_filtered, x.elapsed_s);
}
template <class A>
void fields(A& a, TransparencyState& x) {
  a(x.has_reference, x.master_reference, x.slave_reference, x.lagged_master, x.ramp, x.wrench);
}
template <class A>
void fields(A& a, TwistEstimatorState& x) {
  a(x.has_previous, x.base_T_previous, x.twist_filtered);
}
template <class A>
void fields(A& a, DisturbanceObserverState& x) {
  a(x.started, x.free_position, x.free_velocity, x.error, x.error_filtered, x.error_rate_filtered, x.elapsed_s,
    x.settled_s);
}
template <class A>
void fields(A& a, VelocityIntegratorState& x) {
  a(x.started, x.set_point, x.measured_position);
}
template <class A>
void fields(A& a, csa::FixtureState& x) {
  a(x.feature);
}
template <class A>
void fields(A& a, csa::FixtureIntegratorState& x) {
  a(x.integrator, x.fixtures);
}
template <class A>
void fields(A& a, csa::FixtureForceState& x) {
  a(x.force, x.fixtures);
}
template <class A>
void fields(A& a, TipPortState& x) {
  a(x.has_last, x.base_T_tip, x.wrench, x.is_live, x.mean_wrench, x.twist);
}
template <class A>
void fields(A& a, PipelineSideState& x) {
  a(x.mapping, x.transparency, x.tip_twist, x.observer, x.integrator, x.fixture_force, x.port, x.has_tracked,
    x.tracked_pose, x.tracked_twist, x.tracked_twist_filtered, x.handle_twist, x.slave_twist, x.observed,
    x.observed_wrench, x.desired_wrench, x.desired_twist, x.hand_ahead, x.has_set_point, x.set_point, x.since_handle_s,
    x.since_mapped_s, x.since_command_s, x.seen_engagement, x.held);
}
template <class A>
void fields(A& a, EnergyTankState& x) {
  a(x.energy_J, x.granted_J, x.work_out_J, x.received_J, x.sent_J, x.vented_J, x.requesting, x.rate_locked,
    x.has_conjugate, x.applied, x.conjugate);
}
template <class A>
void fields(A& a, TankPeerState& x) {
  a(x.sent, x.received, x.credit_J, x.requesting, x.has_room);
}
template <class A>
void fields(A& a, TankNodeState& x) {
  a(x.tank, x.peers);
}
template <class A>
void fields(A& a, ProximityMonitorState& x) {
  a(x.levels);
}
template <class A>
void fields(A& a, PipelineState& x) {
  a(x.sides, x.tank_master, x.tank_slave, x.proximity);
}

}  // namespace saras
