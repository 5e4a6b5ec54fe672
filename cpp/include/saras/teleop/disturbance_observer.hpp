// The force on the tissue without a force sensor: from the arm's servo model, free of the lag of free motion.
#pragma once

#include "saras/spatial/law.hpp"

namespace saras {

struct DisturbanceObserverConfig {
  double natural_frequency_rad_s = 60.0;  ///< omega_n of the arm's servo [rad/s]
  double damping_ratio = 1.0;             ///< zeta of the arm's servo, [0.1, 10]
  double mass_kg = 2.0;                   ///< effective mass at the tip
  double cutoff_hz = 8.0;                 ///< of the second-order low-pass on the force [Hz]
  double deadband_N = 0.05;               ///< below it: none; between it and twice it fades in; above: exact
  Seconds settle_s = 0.2;                 ///< after a (re)start the estimate is not given for this long
  Seconds dt_max_s = 0.1;                 ///< a longer gap restarts the observer
  void validate() const;                  ///< throws ConfigError
};

/// Base frame of the arm.
struct DisturbanceObserverInput {
  Vector3 set_point = Vector3::Zero();  ///< tip position that the arm followed since the previous step [m]
  Vector3 measured = Vector3::Zero();   ///< tip position now [m]
  bool stale = false;                   ///< either of them is older than its limit
};

struct DisturbanceObserverOutput {
  bool has_wrench = false;  ///< the wrench is an estimate; otherwise it is unknown, not zero
  Wrench wrench;            ///< that the tip exerts on the tissue: minus the external force; torque is not observed
  Status status = Status::kOk;
};

struct DisturbanceObserverState {
  bool started = false;
  Vector3 free_position = Vector3::Zero();  ///< x_f
  Vector3 free_velocity = Vector3::Zero();
  Vector3 error = Vector3::Zero();           ///< x_m - x_f at the last good input
  Vector3 error_filtered = Vector3::Zero();  ///< and its rate, of the low-pass
  Vector3 error_rate_filtered = Vector3::Zero();
  Seconds elapsed_s = 0.0;  ///< since the last good input
  Seconds settled_s = 0.0;  ///< since the (re)start
};

/// Servo under an external force F on the tip:   m (x_m'' + 2 zeta omega x_m' + omega^2 (x_m - x_d)) = F.
/// Free motion from the same set-point:              x_f'' + 2 zeta omega x_f' + omega^2 (x_f - x_d)  = 0.
/// The difference e = x_m - x_f has no lag of free motion in it:  F = m (e'' + 2 zeta omega e' + omega^2 e).
/// e goes through H(s) = c^2 / (s^2 + 2 c s + c^2), c = 2 pi cutoff_hz, whose state gives both derivatives, so the
/// output is exactly H F: nothing is differentiated numerically. Both second-order systems are stepped
/// exactly, x_d held and e linear over the interval.
///
/// WAITING until settle_s after a start. Stale or invalid input: no wrench, and the time is bridged at the next good
/// one; more than dt_max_s without one, or a dt that is not finite and positive, restarts the observer.
class DisturbanceObserver {
 public:
  explicit DisturbanceObserver(DisturbanceObserverConfig config);
  /// dt: since the previous step, whatever its status [s].
  DisturbanceObserverOutput step(const DisturbanceObserverInput& input, Seconds dt) noexcept;
  void reset(const DisturbanceObserverState& state = {}) { state_ = state; }
  const DisturbanceObserverState& state() const { return state_; }
  const DisturbanceObserverConfig& config() const { return config_; }

 private:
  Vector3 external_force(const DisturbanceObserverInput& input, Seconds interval, DisturbanceObserverState& next) const;

  DisturbanceObserverConfig config_;
  DisturbanceObserverState state_;
};

static_assert(has_law_shape<DisturbanceObserver, DisturbanceObserverInput, DisturbanceObserverState>());

}  // namespace saras
