// What a master and a slave should do to each other: the wrench for the hand, the twist for the arm. One a side.
#pragma once

#include <cstdint>
#include <optional>

#include "saras/spatial/law.hpp"

namespace saras {

enum class TransparencyMode : std::uint8_t {
  kPositionPosition,  ///< the hand feels the position error
  kPositionForce,     ///< the hand feels the force on the tissue; limit-cycles on stiff contact at long delay
  kFourChannel        ///< the sum of both
};

struct TransparencyConfig {
  TransparencyMode mode = TransparencyMode::kPositionPosition;
  double scale = 0.5;                    ///< s, slave metres per master metre, (0, 10]
  double stiffness_N_m = 200.0;          ///< k, per metre of slave error
  double damping_N_s_m = 2.0;            ///< b
  double rotation_stiffness_Nm_rad = 0;  ///< of the rotation error
  double rotation_damping_Nm_s_rad = 0;
  double force_scale = 0.2;              ///< lambda, force on the hand per force on the tissue
  double torque_scale = 0.0;             ///< the same for torques
  double force_limit_N = 3.3;            ///< largest force on the hand
  double torque_limit_Nm = 0.1;          ///< largest torque on the hand
  Seconds ramp_s = 0.1;                  ///< force fades in and out over this time
  double drift_gain_1_s = 2.0;           ///< g, removes the position drift that a reduced command leaves
  double drift_limit_m_s = 0.02;         ///< largest speed of that correction
  Seconds slave_lag_s = 0.0;             ///< of the arm in free motion: no drift, so not to be corrected
  double rotation_drift_gain_1_s = 0.0;  ///< the same for rotation
  double rotation_drift_limit_rad_s = 0.1;
  bool pivoted = true;               ///< project the slave's twist on an arm that pivots about its trocar
  double pivot_radius_min_m = 0.01;  ///< distance trocar - tip below which pivot rates are no longer raised
  Seconds dt_max_s = 0.1;            ///< longest time step
  void validate() const;             ///< throws ConfigError
};

/// All in the slave's base frame.
struct TransparencyInput {
  Pose master_pose;                            ///< base_T_tracked
  Twist master_twist;                          ///< of the tracked pose, unfiltered
  Pose slave_pose;                             ///< measured base_T_tip
  Twist slave_twist;                           ///< of the tip
  Wrench tissue_wrench;                        ///< that the tip exerts on the tissue; not read by kPositionPosition
  Vector3 rcm = Vector3::Zero();               ///< trocar [m]; read when pivoted
  bool clutch = false;                         ///< pressed: slave stands still, force fades out
  bool stale = false;                          ///< any of the above is older than its limit
  std::optional<Twist> master_twist_filtered;  ///< for the damping term; master_twist when not given
  Wrench guidance_wrench;                      ///< further wrench on the hand: fixtures, nearness
};

struct TransparencyOutput {
  Wrench desired_wrench;            ///< on the operator's hand, base axes
  Twist desired_twist;              ///< of the slave's tip
  Vector6 error = Vector6::Zero();  ///< slave - mapped master: position [slave m], rotation vector [rad]
  Status status = Status::kOk;
};

struct TransparencyState {
  bool has_reference = false;
  Pose master_reference;
  Pose slave_reference;
  Vector3 lagged_master = Vector3::Zero();  ///< s (x_m - x_m0) as the lagging arm should follow it [m]
  double ramp = 0.0;                        ///< 0 = no force, 1 = all of it
  Wrench wrench;                            ///< last limited wrench before the ramp: what a fade-out fades
};

/// e = (x_s - x_s0) - s (x_m - x_m0), e_R = log((R_s R_s0^T) (R_m R_m0^T)^T); rates from the twists likewise.
///     position_position  w = k e + b e'      position_force  w = -lambda F      four_channel  the sum
/// plus guidance_wrench, limited in norm, times a ramp that rises from 0 after each reference. The slave gets
///     (s v_m - clamp(g d), omega_m - clamp(g_R e_R)),
/// angular velocity unscaled. d is e with the master delayed by slave_lag_s (first order): else the correction would
/// push the set-point ahead of the master by what the servo lags. Pivoted: the tip's translation is kept, rotation
/// becomes the pivoting that it implies, u x v / |r|, plus the roll u (u . omega), with u the shaft from trocar to tip.
///
/// References are taken at the first tick with both poses good and fresh (WAITING). Clutch: desired twist is
/// zero, the force fades out, and references follow both poses, so that release begins with e = 0.
/// Stale or invalid input: twist zero, the last force fades out over ramp_s, references kept. Without a finite
/// tissue wrench the modes that need it fade the force out (INVALID_INPUT) and motion goes on. An invalid dt
/// gives zero at once and the ramp begins anew.
class Transparency {
 public:
  explicit Transparency(TransparencyConfig config);
  TransparencyOutput step(const TransparencyInput& input, Seconds dt) noexcept;
  /// Without an argument: new references at the next good input (engagement).
  void reset(const TransparencyState& state = {}) { state_ = state; }
  const TransparencyState& state() const { return state_; }
  const TransparencyConfig& config() const { return config_; }

 private:
  Vector6 error(const TransparencyInput& input) const;
  Wrench wrench_on_hand(const TransparencyInput& input, const Vector6& error, bool& limited) const;
  Twist twist_of_slave(const TransparencyInput& input, const Vector6& error, const Vector3& drift, bool& limited) const;
  Vector3 lag(const TransparencyInput& input, Seconds dt) const;
  Wrench fade_out(Seconds dt);
  void take_reference(const TransparencyInput& input);

  TransparencyConfig config_;
  TransparencyState state_;
};

static_assert(has_law_shape<Transparency, TransparencyInput, TransparencyState>());

/// The part of a tip twist that an arm pivoting about rcm can do: translation kept, rotation = pivoting + roll.
/// Closer to the trocar than radius_min [m] the pivot rate is that at radius_min.
Twist project_on_pivot(const Twist& tip_twist, const Pose& base_T_tip, const Vector3& rcm, double radius_min);

}  // namespace saras
