#include "saras/teleop/frame_mapping.hpp"

#include <cmath>

#include "saras/spatial/low_pass.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

bool same(const Pose& a, const Pose& b) {
  return a.rotation.coeffs() == b.rotation.coeffs() && a.translation == b.translation;
}

/// The tracked pose for a handle pose: the closed form of the header.
Pose track(const FrameMappingState& state, const Pose& console_T_handle) {
  const Quaternion base_R_console = state.base_T_console.rotation;
  const Quaternion console_turn = console_T_handle.rotation * state.console_T_reference.rotation.conjugate();
  Pose base_T_tracked;
  base_T_tracked.rotation =
      (base_R_console * console_turn * base_R_console.conjugate() * state.base_T_reference.rotation).normalized();
  base_T_tracked.translation = state.base_T_reference.translation +
                               base_R_console * (console_T_handle.translation - state.console_T_reference.translation);
  return base_T_tracked;
}

}  // namespace

void FrameMappingConfig::validate() const {
  validate::pose("base_T_console", base_T_console);
  validate::pose("touch_T_console", touch_T_console);
  validate::positive("cutoff_hz", cutoff_hz);
  validate::positive("dt_max_s", dt_max_s);
}

FrameMapping::FrameMapping(FrameMappingConfig config) : config_(config) { config_.validate(); }

FrameMappingOutput FrameMapping::step(const FrameMappingInput& input, Seconds dt) noexcept {
  FrameMappingOutput output;
  output.tracked_pose = state_.base_T_tracked;
  output.tracked_twist_filtered = state_.tracked_twist_filtered;

  const bool is_static = config_.mapping == Mapping::kStatic;
  const bool missing = !is_static && !input.base_T_console;
  const Pose base_T_console = is_static ? config_.base_T_console : input.base_T_console.value_or(Pose{});
  if (input.stale || missing) {
    output.status = Status::kStale;
  } else if (!is_valid(base_T_console)) {
    output.status = Status::kInvalidInput;
  } else {
    map_wrench(input, base_T_console, output);
    map_pose(input, base_T_console, dt, output);
  }
  if (!output.has_pose && state_.has_reference && std::isfinite(dt) && dt > 0.0 && output.status != Status::kWaiting) {
    state_.elapsed_s += dt;
  }
  if (output.status == Status::kOk && !output.has_wrench) {
    output.status = Status::kInvalidInput;
  }
  return output;
}

void FrameMapping::map_wrench(const FrameMappingInput& input, const Pose& base_T_console,
                              FrameMappingOutput& output) const {
  const Quaternion touch_R_base = config_.touch_T_console.rotation * base_T_console.rotation.conjugate();
  const Wrench touch_wrench = touch_R_base * input.base_wrench;
  output.has_wrench = is_finite(touch_wrench);
  if (output.has_wrench) {
    output.touch_wrench = touch_wrench;
  }
}

void FrameMapping::map_pose(const FrameMappingInput& input, const Pose& base_T_console, Seconds dt,
                            FrameMappingOutput& output) {
  if (!is_valid(input.console_T_handle)) {
    output.status = Status::kInvalidInput;
    return;
  }
  if (!state_.has_reference) {
    const Pose base_T_tracked = base_T_console * input.console_T_handle;
    if (!is_valid(base_T_tracked)) {
      output.status = Status::kInvalidInput;
      return;
    }
    state_.has_reference = true;
    state_.base_T_reference = state_.base_T_tracked = output.tracked_pose = base_T_tracked;
    state_.console_T_reference = state_.console_T_previous = input.console_T_handle;
    state_.base_T_console = base_T_console;
    output.status = Status::kWaiting;
    return;
  }
  if (!std::isfinite(dt) || dt <= 0.0) {
    output.status = Status::kInvalidTimeStep;
    return;
  }

  FrameMappingState next = state_;
  output.interval_s = state_.elapsed_s + dt;
  output.gap = output.interval_s > config_.dt_max_s;
  const Twist moved = base_T_console.rotation * displacement(state_.console_T_previous, input.console_T_handle);
  const Twist handle_twist{moved.linear / output.interval_s, moved.angular / output.interval_s};
  Twist tracked_twist;
  if (!same(base_T_console, state_.base_T_console)) {
    next.base_T_reference = state_.base_T_tracked;
    next.console_T_reference = state_.console_T_previous;
    next.base_T_console = base_T_console;
  }
  if (input.clutch || output.gap) {
    next.base_T_reference = state_.base_T_tracked;
    next.console_T_reference = input.console_T_handle;
  } else {
    next.base_T_tracked = track(next, input.console_T_handle);
    tracked_twist = handle_twist;
  }
  next.console_T_previous = input.console_T_handle;
  next.elapsed_s = 0.0;
  low_pass(next.tracked_twist_filtered, tracked_twist, low_pass_gain(config_.cutoff_hz, output.interval_s));
  // Finite inputs of absurd size can still overflow.
  if (!is_valid(next.base_T_tracked) || !is_finite(handle_twist) || !is_finite(next.tracked_twist_filtered)) {
    output.interval_s = 0.0;
    output.gap = false;
    output.status = Status::kInvalidInput;
    return;
  }

  state_ = next;
  output.has_pose = true;
  output.tracked_pose = next.base_T_tracked;
  output.tracked_twist = tracked_twist;
  output.tracked_twist_filtered = next.tracked_twist_filtered;
  output.handle_twist = handle_twist;
  output.status = output.gap ? Status::kInvalidTimeStep : Status::kOk;
}

}  // namespace saras
