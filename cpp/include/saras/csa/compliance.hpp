// Compliance wrench: springs, dampers and biases about a frame, different on each side of each axis.
#pragma once

#include "saras/spatial/law.hpp"

namespace saras::csa {

/// How the gains of ComplianceGains act.
enum class ComplianceConvention : std::uint8_t {
  kAsPrinted,  ///< g = bias + stiffness eps + damping v: gains that restore are negative
  kPositive,   ///< g = bias - stiffness eps - damping v, all gains >= 0: stiffness and damping in the usual sense
};

/// Of one side (eps_i <= 0, or eps_i > 0) of each axis, in the compliance frame.
struct ComplianceGains {
  Vector3 stiffness_N_m = Vector3::Zero();
  Vector3 damping_N_s_m = Vector3::Zero();
  Vector3 force_bias_N = Vector3::Zero();
  Vector3 rotation_stiffness_Nm_rad = Vector3::Zero();
  Vector3 torque_bias_Nm = Vector3::Zero();
};

struct ComplianceConfig {
  ComplianceConvention convention = ComplianceConvention::kPositive;
  ComplianceGains negative;                             ///< where eps_i <= 0
  ComplianceGains positive;                             ///< where eps_i > 0
  Vector3 rotation_damping_Nm_s_rad = Vector3::Zero();  ///< sign as the convention says
  double deadband_m = 0.0;             ///< |eps_i| below it counts as zero, and what is beyond is measured from it
  double rotation_deadband_rad = 0.0;  ///< the same for the rotation vector
  double force_limit_N = 3.3;          ///< largest norm of the force
  double torque_limit_Nm = 0.1;        ///< largest norm of the torque
  /// A side with stiffness and no bias is a wall: its spring and damper together never pull towards it.
  bool walls_never_pull = true;
  Seconds dt_max_s = 0.1;  ///< longest time step
  void validate() const;   ///< throws ConfigError
};

struct ComplianceInput {
  Pose handle_pose;                                     ///< base_T_handle
  Twist handle_twist;                                   ///< of the handle, base axes
  Pose frame;                                           ///< base_T_compliance: origin and axes of the force
  Quaternion torque_rotation = Quaternion::Identity();  ///< base_R_c of the torque, when it has axes of its own
  bool separate_torque_frame = false;                   ///< torque_rotation is meant
};

struct ComplianceOutput {
  Wrench wrench;                        ///< on the hand, base axes [N, N m]
  Vector3 deviation = Vector3::Zero();  ///< eps in the compliance frame [m]
  Vector3 rotation = Vector3::Zero();   ///< rotation vector of R_c'R [rad]
  Status status = Status::kOk;          ///< LIMITED: cut at a limit
};

struct ComplianceState {};

/// Algorithm 1 of Chalasani et al., "A Computational Framework for Complementary Situational Awareness", 2018:
///     eps = R_c'(p - p_c),  v = R_c' p',  g_i = bias_i + k_i eps_i + b_i v_i  by the side of eps_i,  f = R_c g
///     theta = log(R_c'R),   tau_i = bias_i + k_o,i theta_i (+ b_o,i omega_i),                        t = R_c tau
/// The rotation vector is that of the shortest arc; at an angle of exactly pi it has two signs, and either is a
/// bounded torque of the same size.
class ComplianceWrench {
 public:
  explicit ComplianceWrench(ComplianceConfig config);
  ComplianceOutput step(const ComplianceInput& input, Seconds dt) noexcept;
  void reset(const ComplianceState& state = {}) { state_ = state; }
  const ComplianceState& state() const { return state_; }
  const ComplianceConfig& config() const { return config_; }

 private:
  ComplianceConfig config_;
  ComplianceState state_;
};

static_assert(has_law_shape<ComplianceWrench, ComplianceInput, ComplianceState>());

}  // namespace saras::csa
