// From the console's frame to the arm's base frame and back: pose and twist of the handle, wrench for the hand.
#pragma once

#include <cstdint>
#include <optional>

#include "saras/spatial/law.hpp"

namespace saras {

enum class Mapping : std::uint8_t {
  kStatic,    ///< base_T_console is a configuration value
  kEndoscope  ///< base_T_console comes with each input, so that the hand moves as the picture shows
};

struct FrameMappingConfig {
  Mapping mapping = Mapping::kStatic;
  Pose base_T_console;      ///< console (simball_base) in the arm's base; for Mapping::kStatic
  Pose touch_T_console;     ///< console in the frame in which the device takes forces; its rotation is used
  double cutoff_hz = 20.0;  ///< of the first-order low-pass behind tracked_twist_filtered [Hz]
  Seconds dt_max_s = 0.1;   ///< a longer interval between two poses re-references like a clutch [s]
  void validate() const;    ///< throws ConfigError
};

struct FrameMappingInput {
  Pose console_T_handle;               ///< measured handle in the console's frame (simball_T_handle)
  bool clutch = false;                 ///< pressed: the hand moves, the tracked pose does not
  Wrench base_wrench;                  ///< for the hand, in base axes
  std::optional<Pose> base_T_console;  ///< for Mapping::kEndoscope; none = not known now
  bool stale = false;                  ///< the pose is older than its limit
};

/// Twists are means over interval_s, in base axes.
struct FrameMappingOutput {
  bool has_pose = false;         ///< pose and twists are new: publish them
  bool has_wrench = false;       ///< touch_wrench is new: publish it
  Pose tracked_pose;             ///< base_T_tracked: continuous over clutch, gaps and endoscope motion
  Twist tracked_twist;           ///< of tracked_pose, so zero under clutch
  Twist tracked_twist_filtered;  ///< low-passed, for damping and display
  Twist handle_twist;            ///< of the handle itself, also under clutch and over gaps: bill energy with it
  Wrench touch_wrench;           ///< base_wrench in touch axes
  Seconds interval_s = 0.0;      ///< time between the two poses that the twists span [s]
  bool gap = false;              ///< interval_s is above dt_max_s: tracked_pose was re-referenced
  Status status = Status::kOk;
};

struct FrameMappingState {
  bool has_reference = false;
  Pose base_T_reference;     ///< tracked pose when the reference was taken
  Pose console_T_reference;  ///< handle at that moment
  Pose base_T_console;       ///< mapping in use
  Pose console_T_previous;   ///< handle at the last good input
  Pose base_T_tracked;
  Twist tracked_twist_filtered;
  Seconds elapsed_s = 0.0;  ///< since the last good input
};

/// With reference (p_ref, q_ref) for the handle at (h_ref, r_ref), and R the rotation of base_T_console:
///     p = p_ref + R (h - h_ref)        q = R (r r_ref^-1) R^T q_ref
/// It is evaluated from the reference each time, so nothing accumulates. The first reference is
/// base_T_console * console_T_handle (WAITING for that tick). Under clutch and over a gap the reference
/// follows the handle; a new base_T_console re-references at the last handle pose.
///
/// Wrenches are rotated only: they refer to the handle in both frames (SPEC "Signs").
///
/// Stale or invalid pose, missing base_T_console: has_pose false, status STALE or INVALID_INPUT; only the
/// elapsed time is noted, so the next twist is the mean over the whole interval. A gap gives
/// INVALID_TIME_STEP with has_pose true. A wrench that is not finite gives INVALID_INPUT and has_wrench
/// false, and the pose goes on.
class FrameMapping {
 public:
  explicit FrameMapping(FrameMappingConfig config);
  /// dt: since the previous step, whatever its status [s].
  FrameMappingOutput step(const FrameMappingInput& input, Seconds dt) noexcept;
  void reset(const FrameMappingState& state = {}) { state_ = state; }
  const FrameMappingState& state() const { return state_; }
  const FrameMappingConfig& config() const { return config_; }

 private:
  void map_wrench(const FrameMappingInput& input, const Pose& base_T_console, FrameMappingOutput& output) const;
  void map_pose(const FrameMappingInput& input, const Pose& base_T_console, Seconds dt, FrameMappingOutput& output);

  FrameMappingConfig config_;
  FrameMappingState state_;
};

static_assert(has_law_shape<FrameMapping, FrameMappingInput, FrameMappingState>());

}  // namespace saras
