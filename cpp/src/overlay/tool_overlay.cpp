#include "saras/overlay/tool_overlay.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

bool fresh(Seconds age_s, Seconds limit_s) noexcept { return age_s >= 0.0 && age_s <= limit_s; }

/// Both are opinions of one tool; who knows of danger is believed, and only two who say CLEAR make it clear.
ProximityState worse(ProximityState a, ProximityState b) noexcept {
  for (const ProximityState state : {ProximityState::kCollision, ProximityState::kWarning, ProximityState::kUnknown}) {
    if (a == state || b == state) {
      return state;
    }
  }
  return ProximityState::kClear;
}

}  // namespace

void ToolOverlayConfig::validate() const {
  validate::not_negative("collision_m", collision_m);
  validate::finite("warning_m", warning_m);
  validate::less("collision_m", collision_m, "warning_m", warning_m);
  validate::not_negative("hysteresis_m", hysteresis_m);
  validate::not_negative("witness_below_m", witness_below_m);
  validate::positive("distances_timeout_s", distances_timeout_s);
  validate::positive("tools_timeout_s", tools_timeout_s);
  validate::positive("camera_timeout_s", camera_timeout_s);
}

ToolOverlay::ToolOverlay(ToolOverlayConfig config) : config_(config) { config_.validate(); }

ProximityState ToolOverlay::by_distance(ProximityState before, double distance_m) const noexcept {
  const bool was_collision = before == ProximityState::kCollision;
  const bool was_warning = was_collision || before == ProximityState::kWarning;
  if (distance_m <= config_.collision_m || (was_collision && distance_m < config_.collision_m + config_.hysteresis_m)) {
    return ProximityState::kCollision;
  }
  return distance_m < config_.warning_m + (was_warning ? config_.hysteresis_m : 0.0) ? ProximityState::kWarning
                                                                                     : ProximityState::kClear;
}

ToolOverlayOutput ToolOverlay::step(const ToolOverlayInput& input, Seconds dt) noexcept {
  ToolOverlayOutput output;
  output.count = std::clamp(input.count, 0, kMaxTools);
  const bool in_time = is_valid_time_step(dt, std::numeric_limits<double>::infinity());
  const bool tools_fresh = in_time && fresh(input.tools_age_s, config_.tools_timeout_s);
  const bool distances_fresh = in_time && fresh(input.distances_age_s, config_.distances_timeout_s);
  output.camera_known =
      in_time && fresh(input.camera_age_s, config_.camera_timeout_s) && is_valid(input.camera_T_world);
  bool some_unknown = false;
  for (int n = 0; n < output.count; ++n) {
    const auto i = static_cast<std::size_t>(n);
    const OverlayTool& tool = input.tools[i];
    ToolMark& mark = output.tools[i];
    mark.name = tool.name;
    ProximityState level = ProximityState::kUnknown;
    if (distances_fresh && !std::isnan(tool.distance_m) && tool.distance_m > -1e9) {
      level = state_.levels[i] = by_distance(state_.levels[i], tool.distance_m);
      mark.distance_m = tool.distance_m;
    }
    mark.level = worse(level, tools_fresh ? tool.state : ProximityState::kUnknown);
    some_unknown = some_unknown || mark.level == ProximityState::kUnknown;
    const bool usable = output.camera_known && tools_fresh;
    mark.placed = usable && is_finite(tool.tip) && is_finite(tool.trocar);
    if (mark.placed) {
      mark.tip = input.camera_T_world * tool.tip;
      mark.trocar = input.camera_T_world * tool.trocar;
    }
    mark.witness = usable && is_finite(tool.on_tool) && is_finite(tool.on_partner) &&
                   tool.known_distance_m < config_.witness_below_m;
    if (mark.witness) {
      mark.on_tool = input.camera_T_world * tool.on_tool;
      mark.on_partner = input.camera_T_world * tool.on_partner;
    }
  }
  output.status = !in_time ? Status::kInvalidTimeStep : some_unknown ? Status::kStale : Status::kOk;
  return output;
}

}  // namespace saras
