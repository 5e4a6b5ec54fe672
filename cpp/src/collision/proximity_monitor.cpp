#include "saras/collision/proximity_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {

const char* to_string(ProximityState state) noexcept {
  switch (state) {
    case ProximityState::kClear:
      return "CLEAR";
    case ProximityState::kWarning:
      return "WARNING";
    case ProximityState::kCollision:
      return "COLLISION";
    case ProximityState::kUnknown:
      break;
  }
  return "UNKNOWN";
}

void ProximityMonitorConfig::validate() const {
  validate::not_negative("collision_m", collision_m);
  validate::finite("warning_m", warning_m);
  validate::not_negative("hysteresis_m", hysteresis_m);
  validate::less("collision_m", collision_m, "warning_m", warning_m);
  validate::not_negative("slowdown_stop_m", slowdown_stop_m);
  validate::finite("slowdown_start_m", slowdown_start_m);
  validate::less("slowdown_stop_m", slowdown_stop_m, "slowdown_start_m", slowdown_start_m);
  validate::positive("speed_limit_m_s", speed_limit_m_s);
  validate::in_range("unknown_speed_limit_m_s", unknown_speed_limit_m_s, 0.0, speed_limit_m_s);
}

ProximityMonitor::ProximityMonitor(ProximityMonitorConfig config, int tools, const std::vector<Parallelepiped>& regions)
    : config_((config.validate(), validate::in_range("tools", tools, 1, kMaxTools), config)), scene_(tools, regions) {}

ProximityState ProximityMonitor::level(ProximityState before, double distance_m) const noexcept {
  const auto inside = [&](double bound, bool was_inside) {
    return distance_m < bound + (was_inside ? config_.hysteresis_m : 0.0);
  };
  const bool was_collision = before == ProximityState::kCollision;
  if (distance_m <= config_.collision_m || (was_collision && inside(config_.collision_m, true))) {
    return ProximityState::kCollision;
  }
  return inside(config_.warning_m, was_collision || before == ProximityState::kWarning) ? ProximityState::kWarning
                                                                                        : ProximityState::kClear;
}

void ProximityMonitor::judge(const ToolDistance& nearest, ProximityState& level_before,
                             ToolProximity& tool) const noexcept {
  tool.tool_unknown = nearest.tool_unknown;
  tool.other_tool_unknown = nearest.other_tool_unknown;
  tool.regions_unknown = nearest.regions_unknown;
  tool.known = nearest.distance;
  tool.partner = nearest.partner;
  tool.partner_index = nearest.index;
  const bool incomplete = nearest.tool_unknown || nearest.other_tool_unknown || nearest.regions_unknown;
  tool.max_speed_scale = incomplete ? config_.unknown_speed_limit_m_s / config_.speed_limit_m_s : 1.0;
  if (nearest.partner != Partner::kNone) {
    const double distance_m = nearest.distance.distance_m;
    level_before = level(level_before, distance_m);
    tool.approach_direction = nearest.distance.normal;
    const double share = (distance_m - config_.slowdown_stop_m) / (config_.slowdown_start_m - config_.slowdown_stop_m);
    tool.approach_speed_limit_m_s = config_.speed_limit_m_s * std::clamp(share, 0.0, 1.0);
    if (!incomplete || level_before != ProximityState::kClear) {
      tool.state = level_before;
      tool.distance_m = distance_m;
    }
  } else if (!incomplete) {
    tool.state = level_before = ProximityState::kClear;
    tool.distance_m = std::numeric_limits<double>::infinity();
  }
}

ProximityMonitorOutput ProximityMonitor::step(const ProximityMonitorInput& input, Seconds dt) noexcept {
  ProximityMonitorOutput output;
  if (!is_valid_time_step(dt, std::numeric_limits<double>::infinity())) {
    output.status = Status::kInvalidTimeStep;
    for (ToolProximity& tool : output.tools) {
      tool.max_speed_scale = config_.unknown_speed_limit_m_s / config_.speed_limit_m_s;
    }
    return output;
  }
  const std::vector<ToolDistance>& nearest = scene_.distances(
      input.tools.data(), static_cast<std::size_t>(scene_.tools()), input.base_T_regions, input.regions_known);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    ToolProximity& tool = output.tools[i];
    judge(nearest[i], state_.levels[i], tool);
    const bool incomplete = tool.tool_unknown || tool.other_tool_unknown || tool.regions_unknown;
    if (incomplete) {
      output.status = Status::kStale;
    } else if (output.status == Status::kOk && tool.approach_speed_limit_m_s < config_.speed_limit_m_s) {
      output.status = Status::kLimited;
    }
  }
  return output;
}

}  // namespace saras
