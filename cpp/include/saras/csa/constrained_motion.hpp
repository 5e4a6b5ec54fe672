// One tick of joint motion towards a twist of the tip, inside joint limits, speeds, lead and fixtures.
#pragma once

#include <array>

#include "saras/csa/fixture_rows.hpp"
#include "saras/csa/qp.hpp"
#include "saras/spatial/law.hpp"

namespace saras::csa {

inline constexpr int kMaxJoints = 12;
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxJoints, 1>;
using TipJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxJoints>;

/// Why a controller stands still, or does less than asked. Anything above kFixtureActive is a hold.
enum class MotionReason : std::uint8_t {
  kNone = 0,
  kSpeedLimit,       ///< a joint or the tip moves as fast as it may
  kJointLimit,       ///< a joint is at its limit
  kLeadLimit,        ///< the set-point is as far ahead of the measured joint as it may be
  kNearSingular,     ///< damped: the Jacobian has nearly lost a direction
  kForceCap,         ///< the force is at its cap: no further in
  kFixtureActive,    ///< a fixture bounds the motion
  kInvalidInput,     ///< hold: a number is not finite or of the wrong size
  kInvalidTimeStep,  ///< hold
  kStale,            ///< hold: an input is too old
  kForceUnknown,     ///< hold: a force mode without a force
  kForceSaturated,   ///< hold: the sensor is at the end of its range
  kNormalUnknown,    ///< hold: in contact, but the surface's direction was never known
  kInfeasible,       ///< hold (INVALID_INPUT): no motion obeys all fixtures and limits
  kSolverFailed,     ///< hold: no answer of the asked accuracy
};
/// Upper-case name, as shown to operators and in messages.
const char* to_string(MotionReason reason) noexcept;
inline bool is_hold(MotionReason reason) noexcept { return reason > MotionReason::kFixtureActive; }

struct ConstrainedMotionConfig {
  JointVector lower;                   ///< joint limits [rad, m]
  JointVector upper;                   ///< [rad, m]
  JointVector speed;                   ///< largest joint speed [rad/s, m/s]
  JointVector lead;                    ///< largest |set-point - measured| [rad, m]
  double rotation_weight_m = 0.1;      ///< one radian of error counts as this many metres
  double first_weight = 100.0;         ///< error along the direction that comes first counts so many times
  double damping = 1e-6;               ///< weight of joint speeds in the objective [m^2/rad^2]
  double singular_value_min_m = 0.01;  ///< below it damping rises to damping_singular
  double damping_singular = 1e-3;      ///< where the singular value is zero
  double recovery_speed_m_s = 0.01;    ///< at most this fast out of a violated fixture or lead
  double soft_weight = 1e4;            ///< cost of violating a soft row, per (m/s)^2
  Seconds dt_max_s = 0.1;
  void validate() const;  ///< throws ConfigError
};

struct ConstrainedMotionInput {
  JointVector q;                    ///< set-point [rad, m]
  JointVector q_measured;           ///< empty: there is none (a simulated arm), no bound on lead
  TipJacobian jacobian;             ///< at q: twist of the tip, base axes, from joint rates
  Twist twist;                      ///< wanted [m/s, rad/s]
  Vector3 first = Vector3::Zero();  ///< unit: speed along it comes before all other directions; zero: none does
  const FixtureRows* rows = nullptr;
};

struct ConstrainedMotionOutput {
  JointVector q;      ///< next set-point; the old one under a hold
  JointVector rates;  ///< [rad/s, m/s]
  Twist twist;        ///< J rates: what the tip will do
  int fixture = -1;   ///< the fixture that acts most, by its multiplier; under INFEASIBLE the one violated most
  double smallest_singular_value_m = 0.0;
  double kkt_residual = 0.0;
  MotionReason reason = MotionReason::kNone;
  Status status = Status::kOk;
};

/// rates* = argmin |W (J rates - twist)|^2 + damping |rates|^2, W = diag(1, 1, 1, w, w, w)
///     s.t. |rates| <= speed, joint limits and lead after dt, rows of the fixtures after dt.
/// Along `first` the error counts first_weight times: where a fixture blocks motion across, none of it is made good
/// along a force's normal. A bound that is violated already asks for recovery at recovery_speed and not for a jump; for
/// joints and lead no faster than the joint's speed. In rates, not in increments, so that all numbers are near one.
/// After Kapoor, Li, Taylor, "Constrained control for surgical assistant robots", 2006.
class ConstrainedMotion {
 public:
  explicit ConstrainedMotion(ConstrainedMotionConfig config);
  ConstrainedMotionOutput step(const ConstrainedMotionInput& input, Seconds dt) noexcept;
  const ConstrainedMotionConfig& config() const { return config_; }
  int joints() const { return static_cast<int>(config_.lower.size()); }

 private:
  bool is_valid(const ConstrainedMotionInput& input) const noexcept;
  void set_bounds(const ConstrainedMotionInput& input, Seconds dt) noexcept;
  int set_rows(const ConstrainedMotionInput& input, Seconds dt) noexcept;
  MotionReason active_bound(const ConstrainedMotionInput& input, Seconds dt) const noexcept;

  ConstrainedMotionConfig config_;
  QpSolver solver_;
  std::array<int, kMaxFixtureRows> row_fixture_{};  ///< of the rows given to the solver
};

}  // namespace saras::csa
