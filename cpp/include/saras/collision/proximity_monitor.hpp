// From distances to what a tool may do: clear, warning, collision or unknown, and how fast it may approach.
#pragma once

#include <array>

#include "saras/collision/scene.hpp"
#include "saras/spatial/law.hpp"

namespace saras {

/// Fixed capacity, so that input, output and state are plain values and no step allocates.
inline constexpr int kMaxTools = 16;

enum class ProximityState : std::uint8_t {
  kUnknown = 0,  ///< the tool, or something that it could meet, is not known
  kClear,
  kWarning,
  kCollision,
};
/// Upper-case name, as shown to operators and in messages.
const char* to_string(ProximityState state) noexcept;

struct ProximityMonitorConfig {
  double collision_m = 0.002;             ///< at most this far is a collision
  double warning_m = 0.010;               ///< below it is a warning
  double hysteresis_m = 0.001;            ///< a state is left this much further out than it was entered
  double slowdown_start_m = 0.015;        ///< d0: up to here a tool may approach at speed_limit_m_s
  double slowdown_stop_m = 0.001;         ///< d1: from here on it may not approach at all
  double speed_limit_m_s = 0.1;           ///< v_max; the velocity integrator's own limit
  double unknown_speed_limit_m_s = 0.02;  ///< in any direction, while something is unknown
  void validate() const;                  ///< throws ConfigError
};

/// All in one frame. Ages are judged by the caller: what is too old is not known.
struct ProximityMonitorInput {
  std::array<SceneTool, kMaxTools> tools;  ///< as many as the monitor was made for
  Pose base_T_regions;                     ///< from the regions' frame to that of the tools
  bool regions_known = true;
};

/// Of one tool.
struct ToolProximity {
  ProximityState state = ProximityState::kUnknown;
  double distance_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN when UNKNOWN; infinite: nothing there to meet
  /// Least distance, witnesses and normal (tool -> partner) to what is known; NaN when nothing is.
  SignedDistance known;
  Partner partner = Partner::kNone;
  int partner_index = -1;
  bool tool_unknown = true;         ///< why: this tool
  bool other_tool_unknown = false;  ///< why: another tool
  bool regions_unknown = false;     ///< why: the regions
  // As VelocityIntegratorInput takes them; always finite but for a limit that does not bind.
  double max_speed_scale = 0.0;                  ///< 0..1
  Vector3 approach_direction = Vector3::Zero();  ///< towards what is near; zero: nothing known
  double approach_speed_limit_m_s = std::numeric_limits<double>::infinity();  ///< along it; retreat is free
};

struct ProximityMonitorOutput {
  std::array<ToolProximity, kMaxTools> tools;  ///< unused places say UNKNOWN
  Status status = Status::kOk;                 ///< STALE: something is unknown; LIMITED: some tool is slowed down
};

struct ProximityMonitorState {
  std::array<ProximityState, kMaxTools> levels{};  ///< of each tool when it was last known: what hysteresis remembers
};

/// State per tool, of the least distance d to what is known: COLLISION d <= collision, WARNING d < warning, else CLEAR,
/// left hysteresis_m further out. *Unknown is never clear*: while the tool is unknown, or any other tool or the regions
/// are, it is UNKNOWN instead of CLEAR; a known collision or warning stays one, as what is unknown can only be nearer.
///
/// Approach towards the nearest known thing is bounded by v_max (d - d1) / (d0 - d1), clipped to 0..v_max. While
/// anything is unknown, max_speed_scale also brings the speed in every direction down to unknown_speed_limit_m_s.
/// The bound holds for the tip. Along the side of a shaft that pivots about its trocar the normal is perpendicular to
/// the shaft, so the point beside the obstacle is not faster than the tip. Only the nearest thing bounds: a second one
/// does as soon as it is the nearest. Two tools that approach each other may each take their bound.
///
/// dt not finite or <= 0: everything UNKNOWN (INVALID_TIME_STEP), state kept. Time enters in no other way.
class ProximityMonitor {
 public:
  /// Throws ConfigError, also for tools outside 1..kMaxTools.
  ProximityMonitor(ProximityMonitorConfig config, int tools, const std::vector<Parallelepiped>& regions);
  ProximityMonitorOutput step(const ProximityMonitorInput& input, Seconds dt) noexcept;
  void reset(const ProximityMonitorState& state = {}) { state_ = state; }
  const ProximityMonitorState& state() const { return state_; }
  const ProximityMonitorConfig& config() const { return config_; }
  int tools() const { return scene_.tools(); }
  std::size_t regions() const { return scene_.regions(); }

 private:
  ProximityState level(ProximityState before, double distance_m) const noexcept;
  void judge(const ToolDistance& nearest, ProximityState& level, ToolProximity& tool) const noexcept;

  ProximityMonitorConfig config_;
  ProximityMonitorState state_;
  Scene scene_;
};

static_assert(has_law_shape<ProximityMonitor, ProximityMonitorInput, ProximityMonitorState>());

}  // namespace saras
