#include "saras/pipeline/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr int kSlavePeer = kSides;  // among tank_master's peers, behind the port guards

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::vector<Parallelepiped> shapes(const std::vector<Corners>& regions) {
  std::vector<Parallelepiped> shapes;
  shapes.reserve(regions.size());
  for (const Corners& corners : regions) {
    shapes.push_back(Parallelepiped::from_corners(corners));
  }
  return shapes;
}

EnergyTankInput tank_input() noexcept {
  EnergyTankInput input;
  input.desired = input.conjugate = ChannelArray::Zero(6, kSides);
  input.measured.resize(6, 0);
  input.has_work = true;
  return input;
}

}  // namespace

void PipelineConfig::validate() const {
  for (int side = 0; side < kSides; ++side) {
    mapping[at(side)].validate();
    integrator[at(side)].validate();
    csa::fixture_set(fixtures[at(side)]);
    validate::in_range("unknown_speed_m_s", unknown_speed_m_s[at(side)], 0.0, integrator[at(side)].speed_limit_m_s);
  }
  transparency.validate();
  fixture_force.validate();
  slave_twist.validate();
  repulsion.validate();
  tank_master.validate();
  tank_slave.validate();
  observer.validate();
  if (distances.enabled) {
    distances.monitor.validate();
  }
  validate::in_range("radius_m", distances.radius_m, 0.0, 0.1);
  validate::in_range("other_tools", distances.other_tools, 0, kMaxOtherTools);
  validate::positive("scene_timeout_s", distances.scene_timeout_s);
  validate::positive("handle_timeout_s", handle_timeout_s);
  validate::positive("arm_timeout_s", arm_timeout_s);
  validate::positive("channel_timeout_s", channel_timeout_s);
  validate::positive("peer_timeout_s", peer_timeout_s);
  validate::positive("nearness_timeout_s", nearness_timeout_s);
  for (const FrameMappingConfig& config : mapping) {
    if (config.mapping != Mapping::kStatic) {
      throw ConfigError("mapping = endoscope: must be static until something gives the camera's frames");
    }
  }
}

Pipeline::Pipeline(PipelineConfig config)
    : config_((config.validate(), std::move(config))),
      sides_{PipelineSide(config_, 0), PipelineSide(config_, 1)},
      tank_master_(config_.tank_master, kSides + 1, config_.session),
      tank_slave_(config_.tank_slave, 1, config_.session) {
  if (config_.distances.enabled) {
    monitor_.emplace(config_.distances.monitor, kSides + config_.distances.other_tools,
                     shapes(config_.distances.regions));
  }
}

PipelineOutput Pipeline::step(const PipelineInput& input, Seconds dt) noexcept {
  PipelineOutput output;
  if (!(std::isfinite(dt) && dt > 0.0)) {
    output.status = Status::kInvalidTimeStep;
    for (int i = 0; i < kSides; ++i) {
      const PipelineSideState side = sides_[at(i)].state();
      output.sides[at(i)].has_set_point = side.has_set_point;
      output.sides[at(i)].set_point = side.set_point;
      output.sides[at(i)].state = ChannelState::kHold;
    }
    return output;
  }
  bool begins = false;
  for (int i = 0; i < kSides; ++i) {
    begins = sides_[at(i)].engage(input.sides[at(i)], input.hold, output.sides[at(i)]) || begins;
  }
  if (begins) {
    tank_master_.grant_charge();
    tank_slave_.grant_charge();
  }
  look(input, dt, output);
  std::array<TipPortOutput, kSides> ports;
  std::array<NearnessInput, kSides> near;
  for (int i = 0; i < kSides; ++i) {
    near[at(i)] = nearness(input, i);
    ports[at(i)] = sides_[at(i)].observe(input.sides[at(i)], dt, output.sides[at(i)]);
    sides_[at(i)].command(input.sides[at(i)], near[at(i)], dt, output.sides[at(i)]);
  }
  master(input, dt, output);
  slave(ports, dt, output);
  for (int i = 0; i < kSides; ++i) {
    PipelineSideOutput& out = output.sides[at(i)];
    const Seconds nominal_s = config_.integrator[at(i)].nominal_dt_s;
    sides_[at(i)].move(input.sides[at(i)], near[at(i)], out.twist, input.overrun ? std::min(dt, nominal_s) : dt, out);
    if (out.state == ChannelState::kEngaged) {
      output.status = std::max({output.status, out.transparency, out.integrator});
    }
  }
  return output;
}

void Pipeline::look(const PipelineInput& input, Seconds dt, PipelineOutput& output) noexcept {
  if (!monitor_) {
    return;
  }
  const SceneInput& scene = input.scene;
  const bool fresh = scene.age_s <= config_.distances.scene_timeout_s;
  for (int i = 0; i < kSides; ++i) {
    SceneTool& tool = capsules_.tools[at(i)];
    const ArmInput& arm = input.sides[at(i)].arm;
    const Pose& world_T_base = scene.world_T_base[at(i)];
    tool.known = fresh && scene.base_known[at(i)] && sides_[at(i)].arm_fresh(input.sides[at(i)]) &&
                 is_valid(world_T_base) && is_valid(arm.base_T_tip);
    tool.capsule = {world_T_base * arm.base_T_tip.translation, world_T_base * arm.rcm, config_.distances.radius_m};
  }
  for (int i = 0; i < config_.distances.other_tools; ++i) {
    SceneTool& tool = capsules_.tools[at(kSides + i)];
    tool = scene.others[at(i)];
    tool.known = tool.known && fresh;
  }
  capsules_.base_T_regions = scene.world_T_regions;
  capsules_.regions_known = fresh && scene.regions_known;
  distances_ = monitor_->step(capsules_, dt);
  output.proximity = distances_.status;
}

NearnessInput Pipeline::nearness(const PipelineInput& input, int side) const noexcept {
  const NearnessInput unknown = sides_[at(side)].unknown_nearness();
  NearnessInput near = unknown;
  if (monitor_) {
    const ToolProximity& tool = distances_.tools[at(side)];
    near.max_speed_scale = tool.max_speed_scale;
    if (tool.approach_direction.allFinite()) {
      near.approach_direction = input.scene.world_T_base[at(side)].rotation.conjugate() * tool.approach_direction;
      near.approach_speed_limit_m_s = tool.approach_speed_limit_m_s;
      near.distance_m = tool.known.distance_m;
    }
    return is_finite(near.approach_direction) ? near : unknown;
  }
  const NearnessInput& given = input.sides[at(side)].nearness;
  const bool usable = given.age_s <= config_.nearness_timeout_s && given.max_speed_scale >= 0.0 &&
                      given.max_speed_scale <= 1.0 && given.approach_speed_limit_m_s >= 0.0 &&
                      given.approach_direction.allFinite();
  return usable ? given : unknown;
}

void Pipeline::master(const PipelineInput& input, Seconds dt, PipelineOutput& output) noexcept {
  EnergyTankInput in = tank_input();
  in.conjugate_stale = true;
  for (int i = 0; i < kSides; ++i) {
    const SideInput& side = input.sides[at(i)];
    const PortLedger& ledger = side.handle.ledger;
    if (side.handle.is_new) {
      tank_master_.receive(i, {ledger.session, ledger.seq, ledger.sent_J}, ledger.requesting, ledger.has_room);
    } else if (!(side.handle.age_s <= config_.peer_timeout_s)) {
      tank_master_.forget_wishes(i);
    }
    if (sides_[at(i)].handle_fresh(side)) {
      in.desired.col(i) = to_vector(output.sides[at(i)].desired_wrench);
      in.conjugate.col(i) = to_vector(output.sides[at(i)].handle_twist);
      in.conjugate_stale = false;
    }
  }
  const EnergyTankOutput out = tank_master_.step(in, dt);
  for (int i = 0; i < kSides; ++i) {
    sides_[at(i)].feel(to_wrench(out.applied.col(i)), output.sides[at(i)]);
    const LedgerMessage message = tank_master_.next_message(i);
    output.sides[at(i)].to_guard = {message.session, message.seq, message.sent_J, out.requesting, out.has_room};
  }
  const LedgerMessage message = tank_master_.next_message(kSlavePeer);
  tank_slave_.receive(0, message, out.requesting, out.has_room);
  output.tank_master = tank_master_.output(out);
}

void Pipeline::slave(const std::array<TipPortOutput, kSides>& ports, Seconds dt, PipelineOutput& output) noexcept {
  EnergyTankInput in = tank_input();
  in.measured = ChannelArray::Zero(6, kSides);
  in.conjugate_stale = true;
  std::array<bool, kSides> live{};
  for (int i = 0; i < kSides; ++i) {
    const TipPortOutput& port = ports[at(i)];
    in.work_J += port.work_J;
    live[at(i)] = port.live && sides_[at(i)].engaged();
    if (live[at(i)]) {
      in.desired.col(i) = to_vector(output.sides[at(i)].desired_twist);
      in.conjugate.col(i) = to_vector(port.mean_wrench);
      in.measured.col(i) = to_vector(port.twist);
      in.conjugate_stale = false;
    }
  }
  const EnergyTankOutput out = tank_slave_.step(in, dt);
  for (int i = 0; i < kSides; ++i) {
    output.sides[at(i)].twist = live[at(i)] ? to_twist(out.applied.col(i)) : Twist{};
  }
  const LedgerMessage message = tank_slave_.next_message(0);
  tank_master_.receive(kSlavePeer, message, out.requesting, out.has_room);
  output.tank_slave = tank_slave_.output(out);
}

const PipelineState& Pipeline::state() const {
  for (int i = 0; i < kSides; ++i) {
    state_.sides[at(i)] = sides_[at(i)].state();
  }
  state_.tank_master = tank_master_.state();
  state_.tank_slave = tank_slave_.state();
  state_.proximity = monitor_ ? monitor_->state() : ProximityMonitorState{};
  return state_;
}

void Pipeline::reset() { reset(Pipeline(config_).state()); }

void Pipeline::reset(const PipelineState& state) {
  tank_master_.reset(state.tank_master);
  tank_slave_.reset(state.tank_slave);
  for (int i = 0; i < kSides; ++i) {
    sides_[at(i)].reset(state.sides[at(i)]);
  }
  if (monitor_) {
    monitor_->reset(state.proximity);
  }
}

}  // namespace saras
