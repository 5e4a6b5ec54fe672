#include "saras/pipeline/side.hpp"

#include <algorithm>
#include <cmath>

namespace saras {
namespace {

Wrench unknown_wrench() { return to_wrench(Vector6::Constant(std::numeric_limits<double>::quiet_NaN())); }

}  // namespace

PipelineSide::PipelineSide(const PipelineConfig& config, int side)
    : mapping_(config.mapping[static_cast<std::size_t>(side)]),
      transparency_(config.transparency),
      tip_twist_(config.slave_twist),
      observer_(config.observer),
      integrator_(config.integrator[static_cast<std::size_t>(side)], config.fixtures[static_cast<std::size_t>(side)]),
      repulsion_(config.repulsion),
      fixtures_(config.fixture_force, config.fixtures[static_cast<std::size_t>(side)]),
      touch_R_base_(mapping_.config().touch_T_console.rotation * mapping_.config().base_T_console.rotation.conjugate()),
      observes_(config.observe),
      pushes_(config.proximity_force),
      slows_(config.proximity_slowdown),
      unknown_scale_(config.unknown_speed_m_s[static_cast<std::size_t>(side)] / integrator_.config().speed_limit_m_s),
      handle_timeout_s_(config.handle_timeout_s),
      arm_timeout_s_(config.arm_timeout_s),
      channel_timeout_s_(config.channel_timeout_s) {}

bool PipelineSide::engage(const SideInput& input, bool hold, PipelineSideOutput& output) noexcept {
  const SupervisorWord& channel = input.channel;
  ChannelState state = channel.state;
  if (!(channel.age_s <= channel_timeout_s_)) {
    state = channel.age_s == kNever ? ChannelState::kWaiting : ChannelState::kHold;
  }
  const bool begins = state == ChannelState::kEngaged && channel.engagement != state_.seen_engagement;
  if (begins) {
    state_.seen_engagement = channel.engagement;
    state_.held = false;
    transparency_.reset();
    integrator_.reset();
  }
  state_.held = state_.held || hold;
  if (state_.held && state == ChannelState::kEngaged) {
    state = ChannelState::kHold;
  }
  engaged_ = state == ChannelState::kEngaged;
  output.state = state;
  output.engagement = channel.engagement;
  return begins && engaged_;
}

TipPortOutput PipelineSide::observe(const SideInput& input, Seconds dt, PipelineSideOutput& output) noexcept {
  const ArmInput& arm = input.arm;
  const bool fresh = arm.age_s <= arm_timeout_s_;
  // Without stamps a new sample spans the tick.
  const Seconds interval_s = arm.interval_s > 0.0 ? arm.interval_s : dt;
  if (arm.is_new) {
    if (arm.interval_s > arm_timeout_s_) {
      tip_twist_.reset();  // a gap: no twist over it
    }
    state_.slave_twist = tip_twist_.step({arm.base_T_tip}, interval_s).twist_filtered;
    if (observes_) {
      const DisturbanceObserverOutput observed =
          observer_.step({arm.target, arm.base_T_tip.translation, false}, interval_s);
      state_.observed = observed.has_wrench;
      state_.observed_wrench = observed.wrench;
    }
  }
  const Wrench wrench = observes_ ? state_.observed_wrench : arm.exerted_wrench;
  const bool known = fresh && is_valid(arm.base_T_tip) && is_finite(wrench) &&
                     (observes_ ? state_.observed : arm.wrench_age_s <= arm_timeout_s_);
  output.wrench_known = known;
  output.tissue_wrench = known ? wrench : Wrench{};
  return port_.step(known, arm.is_new, arm.base_T_tip, wrench, interval_s);
}

void PipelineSide::map(const HandleInput& handle, PipelineSideOutput& output) noexcept {
  const FrameMappingOutput mapped =
      mapping_.step({handle.simball_T_handle, handle.clutch, Wrench{}, std::nullopt, false}, state_.since_handle_s);
  state_.since_handle_s = 0.0;
  output.mapping = mapped.status;
  output.is_mapped = mapped.has_pose;
  if (mapped.has_pose) {
    state_.since_mapped_s = 0.0;
    state_.has_tracked = true;
    state_.tracked_pose = mapped.tracked_pose;
    state_.tracked_twist = mapped.tracked_twist;
    state_.tracked_twist_filtered = mapped.tracked_twist_filtered;
    state_.handle_twist = mapped.handle_twist;
  }
}

void PipelineSide::command(const SideInput& input, const NearnessInput& nearness, Seconds dt,
                           PipelineSideOutput& output) noexcept {
  state_.since_handle_s += dt;
  state_.since_mapped_s += dt;
  state_.since_command_s += dt;
  output.mapping = Status::kOk;
  if (input.handle.is_new) {
    map(input.handle, output);
  }
  const bool stale = handle_stale(input);
  if (stale && !input.handle.is_new) {
    output.mapping = Status::kStale;
  }
  output.has_tracked = state_.has_tracked;
  output.tracked_pose = state_.tracked_pose;
  output.tracked_twist = state_.tracked_twist;
  output.tracked_twist_filtered = state_.tracked_twist_filtered;
  output.handle_twist = state_.handle_twist;
  csa::FixtureForceInput at;
  at.base_T_tip = input.arm.base_T_tip;
  at.hand_ahead = state_.hand_ahead;
  at.word = {input.fixtures.on, input.fixtures.known && arm_fresh(input)};
  output.fixtures = fixtures_.step(at, dt);

  if (!state_.has_tracked || input.arm.age_s == kNever || !input.arm.has_rcm) {
    state_.desired_wrench = {};
    state_.desired_twist = {};
    state_.hand_ahead.setZero();
  } else if (output.is_mapped || stale || !engaged_) {
    // Between two datagrams the last command is kept; a side that is let go does not wait for the next one.
    TransparencyInput in;
    in.master_pose = state_.tracked_pose;
    in.master_twist = state_.tracked_twist;
    in.master_twist_filtered = state_.tracked_twist_filtered;
    in.slave_pose = input.arm.base_T_tip;
    in.slave_twist = state_.slave_twist;
    in.tissue_wrench = output.wrench_known ? output.tissue_wrench : unknown_wrench();
    in.rcm = input.arm.rcm;
    // Pressed as the console or as the supervisor says it: whichever comes first, and whichever goes last.
    in.clutch = input.handle.clutch || (input.channel.clutch && input.channel.age_s <= channel_timeout_s_);
    in.stale = stale || !arm_fresh(input) || !engaged_;
    if (pushes_) {
      in.guidance_wrench =
          repulsion_.step({nearness.distance_m, nearness.approach_direction}, state_.since_command_s).wrench;
    }
    in.guidance_wrench.force += output.fixtures.wrench.force;
    const TransparencyOutput out = transparency_.step(in, state_.since_command_s);
    state_.since_command_s = 0.0;
    state_.desired_wrench = out.desired_wrench;
    state_.desired_twist = out.desired_twist;
    state_.hand_ahead = -out.error.head<3>();
    output.error = out.error;
    output.transparency = out.status;
  } else {
    output.transparency = Status::kOk;
  }
  output.desired_wrench = state_.desired_wrench;
  output.desired_twist = state_.desired_twist;
}

void PipelineSide::feel(const Wrench& base_wrench, PipelineSideOutput& output) const noexcept {
  output.base_wrench = base_wrench;
  output.touch_wrench = touch_R_base_ * base_wrench;
}

void PipelineSide::move(const SideInput& input, const NearnessInput& nearness, const Twist& twist, Seconds dt,
                        PipelineSideOutput& output) noexcept {
  output.twist = twist;
  output.nearness = nearness;
  const bool arm_is_there = arm_fresh(input);
  if (arm_is_there && engaged_) {
    csa::FixtureIntegratorInput guarded;
    guarded.word = input.fixtures;
    VelocityIntegratorInput& in = guarded.motion;
    in.twist = twist;
    in.measured_pose = input.arm.base_T_tip;
    in.rcm = input.arm.rcm;
    if (slows_) {
      in.max_speed_scale = nearness.max_speed_scale;
      in.approach_direction = nearness.approach_direction;
      in.approach_speed_limit_m_s = nearness.approach_speed_limit_m_s;
    }
    const VelocityIntegratorOutput out = integrator_.step(guarded, dt);
    state_.has_set_point = out.has_set_point;
    state_.set_point = out.set_point;
    output.integrator = out.status;
    output.lead_m = out.lead_m;
    output.speed_limited = out.speed_limited;
    output.approach_limited = out.approach_limited;
    output.lead_limited = out.lead_limited;
    output.workspace_limited = out.cone_limited || out.insertion_limited;
    output.fixture_limited = out.fixture_limited;
  }
  // For a silent arm there is no set-point; a side that stands repeats the last one.
  output.has_set_point = arm_is_there && state_.has_set_point;
  output.set_point = state_.set_point;
}

NearnessInput PipelineSide::unknown_nearness() const {
  NearnessInput nearness;
  nearness.max_speed_scale = unknown_scale_;
  return nearness;
}

PipelineSideState PipelineSide::state() const noexcept {
  PipelineSideState state = state_;
  state.mapping = mapping_.state();
  state.transparency = transparency_.state();
  state.tip_twist = tip_twist_.state();
  state.observer = observer_.state();
  state.integrator = integrator_.state();
  state.fixture_force = fixtures_.state();
  state.port = port_.state();
  return state;
}

void PipelineSide::reset(const PipelineSideState& state) noexcept {
  state_ = state;
  mapping_.reset(state.mapping);
  transparency_.reset(state.transparency);
  tip_twist_.reset(state.tip_twist);
  observer_.reset(state.observer);
  integrator_.reset(state.integrator);
  fixtures_.reset(state.fixture_force);
  port_.reset(state.port);
}

}  // namespace saras
