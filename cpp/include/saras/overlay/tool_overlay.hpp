// What the overlay says of each tool: green, yellow, red, or grey for what is not known.
#pragma once

#include <array>
#include <limits>

#include "saras/collision/proximity_monitor.hpp"
#include "saras/overlay/stroke_font.hpp"
#include "saras/spatial/law.hpp"

namespace saras {

struct ToolOverlayConfig {
  double collision_m = 0.002;          ///< as ProximityMonitorConfig has them
  double warning_m = 0.010;            ///< > collision_m
  double hysteresis_m = 0.001;         ///< a colour is left this much further out than it was entered
  double witness_below_m = 0.030;      ///< nearer than this the two nearest points are shown
  Seconds distances_timeout_s = 0.15;  ///< older distances are unknown, > 0
  Seconds tools_timeout_s = 0.15;      ///< older positions and states of the tools are unknown, > 0
  Seconds camera_timeout_s = 0.2;      ///< an older pose of the camera is unknown, > 0
  void validate() const;               ///< throws ConfigError
};

/// A tool as last heard of, in the world.
struct OverlayTool {
  ShortText name;
  Vector3 tip = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());     ///< [m]; NaN: unknown
  Vector3 trocar = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< remote centre [m]
  double distance_m = std::numeric_limits<double>::quiet_NaN();  ///< to the nearest thing; NaN: unknown; inf: none
  ProximityState state = ProximityState::kUnknown;               ///< colliding_regions' own word
  double known_distance_m = std::numeric_limits<double>::quiet_NaN();  ///< to what is known, between the two points
  Vector3 on_tool = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector3 on_partner = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
};

struct ToolOverlayInput {
  std::array<OverlayTool, kMaxTools> tools;
  int count = 0;        ///< of tools, 0 … kMaxTools
  Pose camera_T_world;  ///< camera: rectified left optical frame
  Seconds distances_age_s = std::numeric_limits<double>::infinity();
  Seconds tools_age_s = std::numeric_limits<double>::infinity();
  Seconds camera_age_s = std::numeric_limits<double>::infinity();
};

/// What is to be drawn of one tool, in the rectified left optical frame.
struct ToolMark {
  ShortText name;
  ProximityState level = ProximityState::kUnknown;
  double distance_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN: "?"
  bool placed = false;                                           ///< tip and trocar are known
  Vector3 tip = Vector3::Zero();
  Vector3 trocar = Vector3::Zero();
  bool witness = false;  ///< the two points are known and near
  Vector3 on_tool = Vector3::Zero();
  Vector3 on_partner = Vector3::Zero();
};

struct ToolOverlayOutput {
  std::array<ToolMark, kMaxTools> tools;
  int count = 0;
  bool camera_known = false;    ///< false: where things are in the image is not known, nothing is placed
  Status status = Status::kOk;  ///< STALE: some tool is unknown
};

struct ToolOverlayState {
  std::array<ProximityState, kMaxTools> levels{};  ///< by distance, when last known: what hysteresis remembers
};

/// Level of a tool, from its distance (with hysteresis) and from colliding_regions' own state: the worse of both. CLEAR
/// needs both to be known and fresh, and both to say so. Of what is unknown, WARNING and COLLISION that are freshly
/// known stay; else it is UNKNOWN. An age that is negative or not finite is too old: unknown is never green.
/// Nothing is placed while the camera's pose is unknown, or a tool's ends are. An invalid dt: all UNKNOWN, state kept.
class ToolOverlay {
 public:
  explicit ToolOverlay(ToolOverlayConfig config);
  ToolOverlayOutput step(const ToolOverlayInput& input, Seconds dt) noexcept;
  void reset(const ToolOverlayState& state = {}) { state_ = state; }
  const ToolOverlayState& state() const { return state_; }
  const ToolOverlayConfig& config() const { return config_; }

 private:
  ProximityState by_distance(ProximityState before, double distance_m) const noexcept;

  ToolOverlayConfig config_;
  ToolOverlayState state_;
};

static_assert(has_law_shape<ToolOverlay, ToolOverlayInput, ToolOverlayState>());

}  // namespace saras
