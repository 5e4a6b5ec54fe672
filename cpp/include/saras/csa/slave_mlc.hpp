// Slave mid-level controller: hybrid force and motion as one constrained optimisation. And the proxy slave, which is
// the same with motion only.
#pragma once

#include "saras/csa/constrained_motion.hpp"

namespace saras::csa {

enum class SlaveMode : std::uint8_t {
  kPosition = 0,  ///< K_a = 0, K_p = I: follows the desired pose
  kHybrid,        ///< K_a = n n', K_p = I - n n': force along the normal, motion across
  kAdmittance,    ///< K_a = I, K_p = I, F_d = 0: follows the pose and yields to force
};

enum class PalpationKind : std::uint8_t {
  kNone = 0,
  kForce,   ///< F_d* = F_d + A sin(2 pi f t) along the normal
  kMotion,  ///< position along the normal: x_n0 + A sin(2 pi f t), with a force cap
};

/// What is superimposed in kHybrid.
struct Palpation {
  PalpationKind kind = PalpationKind::kNone;
  double amplitude = 0.0;     ///< A [N] or [m]; of the force primitive at most 0.95 F_d
  double frequency_hz = 1.0;  ///< f
};

struct SlaveMlcConfig {
  ConstrainedMotionConfig motion;
  double admittance_m_Ns = 9.6e-3;    ///< K_g, largest
  bool scheduled = true;              ///< K_g lowered where the estimated stiffness asks for it
  double stiffness_min_N_m = 50.0;    ///< estimates below it are taken as this
  double stiffness_max_N_m = 2000.0;  ///< k_max; taken while nothing is known
  Seconds period_s = 0.001;           ///< of this controller
  Seconds arm_lag_s = 0.015;          ///< tau = 2 zeta / omega_n of the arm
  Seconds sensor_lag_s = 0.002;       ///< of the force, its low-pass included
  double stability_margin = 0.5;      ///< K_g k (period + arm + sensor) stays at most this
  double approach_speed_m_s = 0.01;   ///< largest speed along the normal from force
  double speed_limit_m_s = 0.1;       ///< largest speed of the tip from position
  double rotation_speed_limit_rad_s = 1.0;
  double force_cutoff_hz = 100.0;    ///< low-pass of F_c
  double normal_cutoff_hz = 10.0;    ///< low-pass of F_c for the normal
  double normal_force_min_N = 0.15;  ///< below it the normal is kept
  double normal_rate_rad_s = 2.0;    ///< the normal turns at most this fast (a mesh edge, a flipped sensor)
  double force_cap_N = 6.0;          ///< no desired force beyond it, no motion further in above it
  double force_range_N = 20.0;       ///< a component at or beyond it is a saturated sensor
  void validate() const;             ///< throws ConfigError; unscheduled gains beyond the stability bound too
};

struct SlaveMlcInput {
  JointVector q;           ///< set-point [rad, m]: the q of the last output
  JointVector q_measured;  ///< empty: none
  TipJacobian jacobian;    ///< at q, base axes
  Pose pose;               ///< base_T_tip at q: x_c
  Pose desired;            ///< x_d
  Wrench tissue_wrench;    ///< measured, that the tip exerts on the tissue, base axes; F_c = -force
  bool force_known = false;
  bool stale = false;  ///< desired or measured are older than their limit
  SlaveMode mode = SlaveMode::kPosition;
  double desired_force_N = 0.0;                                     ///< F_d along the normal, pressing
  Vector3 normal = Vector3::Zero();                                 ///< outward; zero: along the filtered F_c
  double stiffness_N_m = std::numeric_limits<double>::quiet_NaN();  ///< estimated; NaN: unknown
  Palpation palpation;
  const FixtureRows* rows = nullptr;
};

struct SlaveMlcOutput {
  ConstrainedMotionOutput motion;    ///< next set-point, or a hold with its reason
  Vector3 normal = Vector3::Zero();  ///< n that was used; zero: none
  double normal_force_N = 0.0;       ///< filtered F_c . n
  double desired_force_N = 0.0;      ///< F_d* with palpation
  double admittance_m_Ns = 0.0;      ///< K_g that was used
  Status status = Status::kOk;       ///< that of the motion
};

struct SlaveMlcState {
  bool has_force = false;
  Vector3 force = Vector3::Zero();         ///< low-passed F_c [N]
  Vector3 normal_force = Vector3::Zero();  ///< low-passed further, for the normal [N]
  bool has_normal = false;
  Vector3 normal = Vector3::UnitZ();
  double phase_rad = 0.0;  ///< of palpation
  bool palpating_motion = false;
  double anchor_m = 0.0;  ///< x_n0 - n'x_c, kept as the position along the normal still to go [m]
};

/// rates = argmin |J rates - delta_x / dt| under ConstrainedMotion's bounds, with
///     delta_x = K_a K_g (F_c - F_d* n) dt + K_p (x_d - x_c)
/// x_c is the set-point's, so that an arm's droop does not become force. Chalasani et al. 2018, eq. (1)-(3), as
/// corrected in docs/csa.md. A hold gives the old set-point and says why.
class SlaveMlc {
 public:
  explicit SlaveMlc(SlaveMlcConfig config);
  SlaveMlcOutput step(const SlaveMlcInput& input, Seconds dt) noexcept;
  void reset(const SlaveMlcState& state = {}) { state_ = state; }
  const SlaveMlcState& state() const { return state_; }
  const SlaveMlcConfig& config() const { return config_; }
  /// K_g for an estimated stiffness [N/m]; NaN: unknown.
  double admittance(double stiffness_N_m) const noexcept;

 private:
  bool saturated(const SlaveMlcInput& input) const noexcept;
  bool take_force(const SlaveMlcInput& input, Seconds dt) noexcept;
  bool take_normal(const SlaveMlcInput& input, Seconds dt) noexcept;
  Twist position_twist(const SlaveMlcInput& input, Seconds dt) const noexcept;
  double normal_speed(const SlaveMlcInput& input, Seconds dt, SlaveMlcOutput& output) noexcept;

  SlaveMlcConfig config_;
  ConstrainedMotion motion_;
  SlaveMlcState state_;
};

static_assert(has_law_shape<SlaveMlc, SlaveMlcInput, SlaveMlcState>());

/// The slave in the virtual environment: delta_x = x_d - x_c, under the same bounds.
class ProxySlave {
 public:
  ProxySlave(ConstrainedMotionConfig config, double speed_limit_m_s, double rotation_speed_limit_rad_s);
  ConstrainedMotionOutput step(const ConstrainedMotionInput& at, const Pose& pose, const Pose& desired,
                               Seconds dt) noexcept;

 private:
  ConstrainedMotion motion_;
  double speed_limit_m_s_;
  double rotation_speed_limit_rad_s_;
};

/// (x_d - x_c) / dt, limited in both norms; base axes.
Twist pursuit(const Pose& pose, const Pose& desired, double speed_limit_m_s, double rotation_speed_limit_rad_s,
              Seconds dt) noexcept;

}  // namespace saras::csa
