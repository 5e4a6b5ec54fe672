#include "saras/teleop/disturbance_observer.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

/// Steps y'' + 2 zeta omega y' + omega^2 y = omega^2 u exactly, with u linear from u0 to u1 over dt.
/// u0 = u1 gives the hold.
void step_second_order(double omega, double zeta, const Vector3& u0, const Vector3& u1, Seconds dt, Vector3& y,
                       Vector3& y_rate) {
  // Fundamental solutions exp(-zeta omega t) {cos|cosh}(s t) and {sin|sinh}(s t)/s.
  const double decay = zeta * omega;
  const double s = omega * std::sqrt(std::abs(zeta * zeta - 1.0));
  double even = 0.0;
  double odd = 0.0;
  if (s * dt < 1e-6) {
    even = std::exp(-decay * dt);
    odd = dt * even;
  } else if (zeta < 1.0) {
    even = std::exp(-decay * dt) * std::cos(s * dt);
    odd = std::exp(-decay * dt) * std::sin(s * dt) / s;
  } else {
    const double slow = std::exp((s - decay) * dt);
    const double fast = std::exp(-(s + decay) * dt);
    even = 0.5 * (slow + fast);
    odd = 0.5 * (slow - fast) / s;
  }
  // The ramp's own solution lags it by 2 zeta / omega; the rest decays.
  const Vector3 slope = (u1 - u0) / dt;
  const Vector3 lag = slope * (2.0 * zeta / omega);
  const Vector3 z = y - (u0 - lag);
  const Vector3 z_rate = y_rate - slope;
  y = u1 - lag + (even + decay * odd) * z + odd * z_rate;
  y_rate = slope - omega * omega * odd * z + (even - decay * odd) * z_rate;
}

}  // namespace

void DisturbanceObserverConfig::validate() const {
  validate::positive("natural_frequency_rad_s", natural_frequency_rad_s);
  validate::in_range("damping_ratio", damping_ratio, 0.1, 10.0);
  validate::positive("mass_kg", mass_kg);
  validate::positive("cutoff_hz", cutoff_hz);
  validate::not_negative("deadband_N", deadband_N);
  validate::not_negative("settle_s", settle_s);
  validate::positive("dt_max_s", dt_max_s);
}

DisturbanceObserver::DisturbanceObserver(DisturbanceObserverConfig config) : config_(config) { config_.validate(); }

DisturbanceObserverOutput DisturbanceObserver::step(const DisturbanceObserverInput& input, Seconds dt) noexcept {
  DisturbanceObserverOutput output;
  if (state_.started && !(std::isfinite(dt) && dt > 0.0)) {
    state_ = {};
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  const bool valid = is_finite(input.set_point) && is_finite(input.measured);
  const Seconds interval = state_.elapsed_s + dt;
  if (!valid || input.stale) {
    state_.elapsed_s = state_.started ? interval : 0.0;
    output.status = valid ? Status::kStale : Status::kInvalidInput;
    return output;
  }
  if (!state_.started || interval > config_.dt_max_s) {
    output.status = state_.started ? Status::kInvalidTimeStep : Status::kWaiting;
    state_ = {};
    state_.started = true;
    state_.free_position = input.measured;
    return output;
  }

  DisturbanceObserverState next = state_;
  const Vector3 force = external_force(input, interval, next);
  next.elapsed_s = 0.0;
  next.settled_s = std::min(state_.settled_s + interval, config_.settle_s);
  // Finite inputs of absurd size can still overflow.
  if (!is_finite(force) || !is_finite(next.free_position) || !is_finite(next.free_velocity)) {
    state_ = {};
    output.status = Status::kInvalidInput;
    return output;
  }
  state_ = next;
  if (state_.settled_s < config_.settle_s) {
    output.status = Status::kWaiting;
    return output;
  }
  const double norm = force.norm();
  const double fade = config_.deadband_N > 0.0 ? std::clamp(norm / config_.deadband_N - 1.0, 0.0, 1.0) : 1.0;
  output.has_wrench = true;
  output.wrench.force = -fade * force;
  return output;
}

Vector3 DisturbanceObserver::external_force(const DisturbanceObserverInput& input, Seconds interval,
                                            DisturbanceObserverState& next) const {
  const double omega = config_.natural_frequency_rad_s;
  const double zeta = config_.damping_ratio;
  step_second_order(omega, zeta, input.set_point, input.set_point, interval, next.free_position, next.free_velocity);
  next.error = input.measured - next.free_position;
  const double c = 2.0 * M_PI * config_.cutoff_hz;
  step_second_order(c, 1.0, state_.error, next.error, interval, next.error_filtered, next.error_rate_filtered);
  const Vector3 acceleration = c * c * (next.error - next.error_filtered) - 2.0 * c * next.error_rate_filtered;
  return config_.mass_kg *
         (acceleration + 2.0 * zeta * omega * next.error_rate_filtered + omega * omega * next.error_filtered);
}

}  // namespace saras
