// A haptic handle without the hardware: a simulated hand holds the Simball, the Touch's motors push it.
#pragma once

#include "saras/kinematics/simball_handle.hpp"
#include "saras/sim/operator.hpp"

namespace saras {

struct SimulatedHandleConfig {
  OperatorConfig hand;
  SimballHandleConfig simball;
  Vector4 home_joints = Vector4(0.0, 0.0, 0.0, 0.06);           ///< where it starts and intentions are measured from
  Quaternion touch_R_simball = Quaternion(0.0, 0.0, 0.0, 1.0);  ///< frame of the wrench
  double workspace_radius_m = 0.055;                            ///< mechanical stop around home [m]
  Seconds watchdog_s = 0.002;  ///< the motors fall back to zero when a wrench is this old [s]
  Seconds stall_max_s = 0.1;   ///< of a longer step (a suspended process) only this much is simulated [s]
  void validate() const;       ///< throws ConfigError
};

struct SimulatedHandleInput {
  Vector3 intended_offset = Vector3::Zero();    ///< from home, in the handle's frame there: +z deeper [m]
  Vector3 intended_velocity = Vector3::Zero();  ///< same frame [m/s]
  double intended_roll = 0.0;                   ///< [rad]
  Wrench wrench;  ///< applied since the last step, touch frame; the force acts for watchdog_s at most
};

struct SimulatedHandleOutput {
  Vector4 joints = Vector4::Zero();  ///< what ideal encoders read
  bool valid = false;                ///< the hand is above the pivot
  double work_J = 0.0;               ///< cumulative work of the motors on the hand [J]
  Status status = Status::kOk;       ///< the operator's
};

struct SimulatedHandleState {
  OperatorState hand;
  double work_J = 0.0;
};

class SimulatedHandle {
 public:
  explicit SimulatedHandle(SimulatedHandleConfig config = {});
  SimulatedHandleOutput step(const SimulatedHandleInput& input, Seconds dt) noexcept;
  /// At rest at home.
  void reset();
  void reset(const SimulatedHandleState& state);
  const SimulatedHandleState& state() const { return state_; }
  const SimulatedHandleConfig& config() const { return config_; }

 private:
  SimulatedHandleConfig config_;
  SimballHandle simball_;
  Pose simball_T_home_;
  Operator hand_;
  SimulatedHandleState state_;
};

static_assert(has_law_shape<SimulatedHandle, SimulatedHandleInput, SimulatedHandleState>());

}  // namespace saras
