// A force on the operator's hand away from what the tool comes near to.
#pragma once

#include <limits>

#include "saras/spatial/law.hpp"

namespace saras {

struct RepulsiveForceConfig {
  double start_distance_m = 0.010;  ///< nearer than this the force begins, at zero
  double stiffness_N_m = 300.0;     ///< force per metre nearer
  double force_limit_N = 2.0;       ///< largest force
  Seconds dt_max_s = 0.1;           ///< longest time step
  void validate() const;            ///< throws ConfigError
};

struct RepulsiveForceInput {
  double distance_m = std::numeric_limits<double>::quiet_NaN();  ///< signed; NaN: unknown
  Vector3 normal = Vector3::Zero();                              ///< unit, tool -> what is near
};

struct RepulsiveForceOutput {
  Wrench wrench;  ///< on the operator's hand, in the frame of the normal
  Status status = Status::kOk;
};

struct RepulsiveForceState {};

/// force = -normal * min(stiffness (start - distance), limit) below start, else zero. A function of the distance alone,
/// so it stores no energy over a closed path in front of a flat wall; passivity is the tank's work all the same.
/// Unknown distance: zero (STALE): a force from nowhere would be made up, and what unknown does is to cap the speed.
/// Normal not of unit length where a force is due, or distance = -infinity: zero (INVALID_INPUT).
class RepulsiveForce {
 public:
  explicit RepulsiveForce(RepulsiveForceConfig config);
  RepulsiveForceOutput step(const RepulsiveForceInput& input, Seconds dt) noexcept;
  void reset(const RepulsiveForceState& state = {}) { state_ = state; }
  const RepulsiveForceState& state() const { return state_; }
  const RepulsiveForceConfig& config() const { return config_; }

 private:
  RepulsiveForceConfig config_;
  RepulsiveForceState state_;
};

static_assert(has_law_shape<RepulsiveForce, RepulsiveForceInput, RepulsiveForceState>());

}  // namespace saras
