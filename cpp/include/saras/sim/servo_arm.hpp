// The simulated SARAS arm: six servoed joints that follow a pivoting tip and yield to a force on it.
#pragma once

#include <cstdint>

#include "saras/kinematics/rcm_arm.hpp"
#include "saras/sim/random.hpp"
#include "saras/sim/second_order.hpp"
#include "saras/spatial/law.hpp"

namespace saras {

enum class ArmMode : std::uint8_t {
  kPivot,     ///< the shaft passes through the trocar
  kParallel,  ///< the shaft keeps its direction
};

struct ServoArmConfig {
  RcmArmConfig arm;  ///< geometry, joint limits and joint speed limits
  Vector6 natural_frequency_rad_s =
      Vector6::Constant(60.0);                 ///< per joint; unequal ones bend the remote centre [rad/s]
  Vector6 damping_ratio = Vector6::Ones();     ///< per joint [-]
  double effective_mass_kg = 2.0;              ///< of the tip, in every direction [kg]
  double jaw_speed_max_1_s = 2.0;              ///< the jaw goes from 0 (closed) to 1 (open) [1/s]
  Vector6 joint_resolution = Vector6::Zero();  ///< step of the measured joints, 0 none [rad, m]
  Vector6 joint_noise = Vector6::Zero();       ///< standard deviation of the measured joints [rad, m]
  std::uint64_t seed = 1;                      ///< of the noise
  Seconds dt_max_s = 0.1;                      ///< longest step [s]
  void validate() const;                       ///< throws ConfigError

  /// The tip 0.1 m straight below the nominal trocar.
  Vector6 initial_q() const;
};

struct ServoArmInput {
  Vector3 target_tip = Vector3::Zero();      ///< base frame [m]
  double target_roll = 0.0;                  ///< roll joint [rad]
  Vector3 rcm = Vector3::Zero();             ///< trocar, base frame [m]
  Vector3 reaction_force = Vector3::Zero();  ///< that the surroundings exert on the tip: minus the wrench exerted [N]
  double target_jaw = 0.0;                   ///< 0 closed … 1 open
  double roll_speed_max_rad_s = 1e9;         ///< of this command; the joint's own limit holds too [rad/s], > 0
  double jaw_speed_max_1_s = 1e9;            ///< of this command; the jaw's own limit holds too [1/s], > 0
  ArmMode mode = ArmMode::kPivot;
};

struct ServoArmOutput {
  Vector6 q = Vector6::Zero();                 ///< true joints [rad], insertion [m]
  Vector6 q_rate = Vector6::Zero();            ///< true rates [rad/s], [m/s]
  Pose base_T_tip;                             ///< true
  Vector3 tip_velocity = Vector3::Zero();      ///< true, base frame [m/s]
  Vector6 measured_q = Vector6::Zero();        ///< with resolution and noise
  Pose measured_base_T_tip;                    ///< forward kinematics of measured_q
  Vector3 trocar_deviation = Vector3::Zero();  ///< from the trocar to the nearest point of the shaft's line [m]
  double rcm_deviation_m = 0.0;                ///< its length [m]
  double jaw = 0.0;                            ///< 0 closed … 1 open
  Violation violation;                         ///< why the target is not followed, under LIMITED
  Status status = Status::kOk;  ///< LIMITED: target out of reach (the last one in reach is kept) or speed scaled
};

struct ServoArmState {
  Vector6 q = Vector6::Zero();
  Vector6 q_rate = Vector6::Zero();
  Vector6 q_target = Vector6::Zero();
  double roll_reference = 0.0;
  double jaw = 0.0;
  Random noise{1};
};

/// Per joint q'' = w^2 (q_d - q) - 2 zeta w q' + disturbance, exact for inputs held over dt; q_d is the inverse of the
/// target, the disturbance G F / m with G the pivot jacobian. At a speed limit all joints are scaled together: clipping
/// one alone would bend the remote centre.
class ServoArm {
 public:
  explicit ServoArm(ServoArmConfig config = {});
  ServoArmOutput step(const ServoArmInput& input, Seconds dt) noexcept;
  /// At rest in the configuration's initial_q().
  void reset();
  void reset(const ServoArmState& state) { state_ = state; }
  /// At rest in the given joints. Throws ConfigError when they leave the limits.
  void reset(const Vector6& q);
  const ServoArmState& state() const { return state_; }
  const ServoArmConfig& config() const { return config_; }
  const RcmArm& kinematics() const { return kinematics_; }

 private:
  bool update_target(const ServoArmInput& input, Seconds dt, ServoArmOutput& output) noexcept;
  Vector6 disturbance(const ServoArmInput& input) const noexcept;
  bool move(const Vector6& disturbance, Seconds dt) noexcept;
  void fill(const Vector3& rcm, ServoArmOutput& output) noexcept;

  ServoArmConfig config_;
  RcmArm kinematics_;
  ServoArmState state_;
  Seconds cached_dt_ = 0.0;  // the coefficients depend on config and dt only: no part of the state
  std::array<SecondOrderStep, 6> cached_joints_;
};

static_assert(has_law_shape<ServoArm, ServoArmInput, ServoArmState>());

}  // namespace saras
