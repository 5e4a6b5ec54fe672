// From the twist that passivity lets through to the arm's set-point, within hard bounds. One a side.
#pragma once

#include <limits>

#include "saras/spatial/law.hpp"

namespace saras {

struct VelocityIntegratorConfig {
  double speed_limit_m_s = 0.1;               ///< no set-point step is longer than this times dt
  double speed_limit_rad_s = 1.0;             ///< the same for rotation
  double lead_limit_m = 0.01;                 ///< set-point ahead of measured
  double lead_limit_rad = 0.1745329252;       ///< 10 deg
  Vector3 cone_axis = Vector3(0, 0, -1);      ///< unit, base frame: from the trocar into the patient
  double cone_half_angle_rad = 0.8726646260;  ///< 50 deg, (0, pi/2)
  double insertion_min_m = 0.03;              ///< distance trocar - tip
  double insertion_max_m = 0.20;
  double measured_jump_m = 0.02;   ///< measured further than this from the last one is refused
  bool shaft_through_rcm = false;  ///< orientation follows from the trocar; only roll is taken from the twist
  Seconds nominal_dt_s = 0.01;     ///< one period: the first step, and the most after a stall
  Seconds dt_max_s = 0.05;         ///< a longer time step is a stall
  void validate() const;           ///< throws ConfigError
};

/// All in the arm's base frame.
struct VelocityIntegratorInput {
  Twist twist;                                   ///< of the tip
  Pose measured_pose;                            ///< base_T_tip
  Vector3 rcm = Vector3::Zero();                 ///< trocar [m]
  bool stale = false;                            ///< twist is older than its limit: taken as zero
  double max_speed_scale = 1.0;                  ///< 0..1, of both speed limits
  Vector3 approach_direction = Vector3::Zero();  ///< towards what is near; zero = any direction
  double approach_speed_limit_m_s = std::numeric_limits<double>::infinity();  ///< along it; retreat is free
};

/// A further bound of the set-point, such as virtual fixtures.
class PositionBound {
 public:
  PositionBound() = default;
  PositionBound(const PositionBound&) = default;
  PositionBound(PositionBound&&) = default;
  PositionBound& operator=(const PositionBound&) = default;
  PositionBound& operator=(PositionBound&&) = default;
  virtual ~PositionBound() = default;
  /// The allowed position nearest to `wanted`, of a set-point that is at `from`; at worst `from` itself.
  virtual Vector3 bound(const Vector3& from, const Vector3& wanted) noexcept = 0;
};

struct VelocityIntegratorOutput {
  bool has_set_point = false;      ///< false until a measured pose was seen: send nothing
  Pose set_point;                  ///< base_T_tip, always finite, quaternion unit
  double lead_m = 0.0;             ///< distance set-point - measured
  bool speed_limited = false;      ///< command above the speed limit
  bool approach_limited = false;   ///< command above the approach limit
  bool lead_limited = false;       ///< set-point too far ahead of measured
  bool cone_limited = false;       ///< at the edge of the cone
  bool insertion_limited = false;  ///< at the least or greatest insertion
  bool fixture_limited = false;    ///< held back by the further bound
  bool measured_jumped = false;    ///< measured pose refused; lasts until reset or until it is back
  Status status = Status::kOk;
};

struct VelocityIntegratorState {
  bool started = false;
  Pose set_point;
  Vector3 measured_position = Vector3::Zero();  ///< last accepted
};

/// set_point <- add_delta(set_point, twist, dt), from the measured pose at the first step.
///
/// Bounds, in this order: commanded speed (norm, direction kept), approach, lead over measured, cone and
/// insertion (nearest point inside, so that the set-point slides along the wall), lead again (it wins where the
/// arm is outside the workspace), and last the step itself: never longer than speed limit * dt, whatever pulls.
/// (A step along the sphere of least insertion is a chord of it: inside by (v dt)^2 / (8 r), micrometres, at most.)
/// A workspace bound that is already broken (start outside, trocar moved) moves nothing by itself: it
/// only refuses to go further out.
///
/// A further bound, where there is one, comes after all of these and may only shorten the step; where what it allows
/// leads out of workspace or lead, the set-point stands.
///
/// Stale twist = zero twist (STALE). dt above dt_max_s: one nominal_dt_s is integrated (INVALID_TIME_STEP);
/// dt not finite or <= 0: held. Twist or limits not finite: zero twist (INVALID_INPUT). Measured pose or trocar
/// not finite, or a jump of the measured pose: held (INVALID_INPUT).
class VelocityIntegrator {
 public:
  explicit VelocityIntegrator(VelocityIntegratorConfig config);
  VelocityIntegratorOutput step(const VelocityIntegratorInput& input, Seconds dt,
                                PositionBound* further = nullptr) noexcept;
  /// Without an argument: starts from measured again.
  void reset(const VelocityIntegratorState& state = {}) { state_ = state; }
  const VelocityIntegratorState& state() const { return state_; }
  const VelocityIntegratorConfig& config() const { return config_; }

 private:
  Twist limit_command(const VelocityIntegratorInput& input, VelocityIntegratorOutput& output) const;
  Vector3 bound_position(const Vector3& wanted, const VelocityIntegratorInput& input, Seconds dt,
                         VelocityIntegratorOutput& output) const;
  Vector3 within_further(const Vector3& wanted, const VelocityIntegratorInput& input, Seconds dt,
                         PositionBound& further, VelocityIntegratorOutput& output) const;
  Vector3 within_workspace(const Vector3& wanted, const Vector3& rcm, VelocityIntegratorOutput& output) const;
  Quaternion wanted_rotation(const Twist& twist, const Vector3& position, const Vector3& rcm, Seconds dt) const;
  Quaternion bound_rotation(const Quaternion& wanted, const Pose& measured, Seconds dt,
                            VelocityIntegratorOutput& output) const;

  VelocityIntegratorConfig config_;
  VelocityIntegratorState state_;
};

static_assert(has_law_shape<VelocityIntegrator, VelocityIntegratorInput, VelocityIntegratorState>());

}  // namespace saras
