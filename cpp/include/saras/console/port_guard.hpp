// The passivity layer at one handle: an energy tank between the wrench that the platform wants and the motors.
//
// Between tank_master and the handle lies a network, so the port is billed here, with the encoders' work, at device
// rate. Adds to the tank what belongs to the port: the ramp of the force and the handle's twist in the touch frame.
#pragma once

#include "saras/teleop/energy_tank.hpp"

namespace saras {

struct PortGuardConfig {
  EnergyTankConfig tank;
  Seconds force_ramp_s = 0.1;                                   ///< from full force to none, and back [s]
  Quaternion touch_R_simball = Quaternion(0.0, 0.0, 0.0, 1.0);  ///< the Touch faces the operator: half a turn about z
  void validate() const;                                        ///< throws ConfigError
};

struct PortGuardInput {
  Wrench wrench;            ///< newest from the platform, touch frame
  bool active = false;      ///< ENGAGED on a fresh link: the force may be there; else it ramps to zero
  bool has_pose = false;    ///< the handle gives a valid reading
  Pose simball_T_handle;    ///< calibrated
  double work_J = 0.0;      ///< the device's cumulative work on the hand [J]
  double received_J = 0.0;  ///< credited by the ledger since the last tick [J]
  bool peer_requests = false;
  bool peer_has_room = false;
};

struct PortGuardOutput {
  Wrench applied;  ///< to the motors, touch frame
  EnergyTankOutput tank;
  Status status = Status::kOk;  ///< the tank's
};

struct PortGuardState {
  EnergyTankState tank;
  double ramp = 0.0;  ///< share of the wanted wrench that passes, 0 to 1
  bool has_previous = false;
  Pose simball_T_previous;
  double billed_J = 0.0;  ///< of the device's cumulative work
};

class PortGuard {
 public:
  /// Begins as a restart: level minimum_J. The starting charge comes by grant(), once an engagement.
  explicit PortGuard(PortGuardConfig config = {});
  PortGuardOutput step(const PortGuardInput& input, Seconds dt) noexcept;
  /// Fills the tank up to initial_J and counts it as granted.
  void grant();
  void reset();
  void reset(const PortGuardState& state);
  const PortGuardState& state() const { return state_; }
  const PortGuardConfig& config() const { return config_; }

 private:
  PortGuardConfig config_;
  EnergyTank tank_;
  PortGuardState state_;
};

static_assert(has_law_shape<PortGuard, PortGuardInput, PortGuardState>());

}  // namespace saras
