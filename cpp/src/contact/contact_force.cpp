#include "saras/contact/contact_force.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLeastDirection = 1e-6;

ContactForceOutput no_estimate(Status status) noexcept {
  ContactForceOutput output;
  const Vector3 nan = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  output.exerted = {nan, nan};
  output.reaction = nan;
  output.depth_m = nan.x();
  output.status = status;
  return output;
}

}  // namespace

void ContactForceConfig::validate() const {
  validate::positive("stiffness_N_m", stiffness_N_m);
  validate::in_range("exponent", exponent, 1.0, 3.0);
  validate::not_negative("damping_N_s_m2", damping_N_s_m2);
  validate::positive("rate_cutoff_hz", rate_cutoff_hz);
  validate::positive("depth_limit_m", depth_limit_m);
  validate::positive("force_limit_N", force_limit_N);
  validate::positive("age_limit_s", age_limit_s);
  validate::positive("dt_max_s", dt_max_s);
}

ContactForce::ContactForce(ContactForceConfig config) : config_(config) { config_.validate(); }

bool ContactForce::take(const ContactForceInput& input) noexcept {
  const double length = input.direction.norm();
  const bool good = std::isfinite(input.depth_m) && input.depth_m <= config_.depth_limit_m &&
                    length > kLeastDirection && std::isfinite(length) && input.age_s >= 0.0;
  if (!good) {
    state_ = {};
    return false;
  }
  const double depth = std::max(0.0, input.depth_m);
  // The held reading aged to now, minus the age of the new one: the time between both.
  const Seconds interval = state_.age_s - input.age_s;
  if (state_.known && interval > 0.0 && state_.age_s <= config_.age_limit_s) {
    const double gain = 1.0 - std::exp(-2.0 * kPi * config_.rate_cutoff_hz * interval);
    state_.rate_m_s += gain * ((depth - state_.depth_m) / interval - state_.rate_m_s);
  } else {
    state_.rate_m_s = 0.0;
  }
  state_.known = true;
  state_.depth_m = depth;
  state_.normal = input.direction / length;
  state_.age_s = input.age_s;
  return true;
}

ContactForceOutput ContactForce::step(const ContactForceInput& input, Seconds dt) noexcept {
  if (std::isfinite(dt) && dt > 0.0) {
    state_.age_s += dt;  // after a stall too: what is held is that much older
  }
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    return no_estimate(Status::kInvalidTimeStep);
  }
  if (input.is_new && !take(input)) {
    return no_estimate(Status::kInvalidInput);
  }
  if (!state_.known) {
    return no_estimate(Status::kWaiting);
  }
  if (state_.age_s > config_.age_limit_s) {
    return no_estimate(Status::kStale);
  }
  const double power = std::pow(state_.depth_m, config_.exponent);
  const double rate = state_.depth_m > 0.0 ? state_.rate_m_s : 0.0;
  const double force = std::max(0.0, power * (config_.stiffness_N_m + config_.damping_N_s_m2 * rate));
  if (!(force <= config_.force_limit_N)) {
    return no_estimate(Status::kLimited);
  }
  ContactForceOutput output;
  output.has_estimate = true;
  output.reaction = force * state_.normal;
  output.exerted.force = -output.reaction;
  output.depth_m = state_.depth_m;
  output.age_s = state_.age_s;
  return output;
}

}  // namespace saras
