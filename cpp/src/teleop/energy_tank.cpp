#include "saras/teleop/energy_tank.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

// 50 halvings leave alpha exact to 1e-15: the search costs less than a microsecond and runs only near the floor.
constexpr int kBisections = 50;
// Rounding of a floor that was reached exactly must not count as having fallen through it.
constexpr double kFloorTolerance = 1e-9;

double saturate(double value, double limit) noexcept { return std::clamp(value, -limit, limit); }

bool has_shape(const ChannelArray& array, int channels) noexcept { return array.cols() == channels; }

}  // namespace

void EnergyTankConfig::validate() const {
  validate::positive("minimum_J", minimum_J);
  validate::less("minimum_J", minimum_J, "request_J", request_J);
  validate::less("request_J", request_J, "available_J", available_J);
  validate::less("available_J", available_J, "maximum_J", maximum_J);
  validate::in_range("initial_J", initial_J, minimum_J, maximum_J);
  validate::not_negative("exchange_W", exchange_W);
  validate::not_negative("damping_min", damping_min);
  validate::not_negative("damping_max", damping_max);
  validate::not_above("damping_min", damping_min, "damping_max", damping_max);
  validate::not_negative("conjugate_rate", conjugate_rate);
  validate::not_negative("applied_limit", applied_limit);
  validate::positive("hold_s", hold_s);
  validate::positive("dt_max_s", dt_max_s);
}

EnergyTank::EnergyTank(EnergyTankConfig config, int channels) : config_(config), channels_(channels) {
  config_.validate();
  if (channels < 1 || channels > kMaxTankChannels) {
    throw ConfigError("channels = " + std::to_string(channels) + ": must be in [1, " +
                      std::to_string(kMaxTankChannels) + "]");
  }
  const Vector6 drift = config_.conjugate_rate * config_.hold_s;
  damping_reserve_J_ = channels_ * (config_.damping_max.array() * drift.array().square()).sum() * config_.hold_s / 4.0;
  reset();
  grant(config_.initial_J - config_.minimum_J);
}

void EnergyTank::reset() {
  state_ = {};
  state_.energy_J = config_.minimum_J;
  state_.granted_J = config_.minimum_J;
  state_.applied = ChannelArray::Zero(6, channels_);
  state_.conjugate = ChannelArray::Zero(6, channels_);
}

void EnergyTank::reset(const EnergyTankState& state) {
  if (!has_shape(state.applied, channels_) || !has_shape(state.conjugate, channels_)) {
    throw ConfigError("state.applied has " + std::to_string(state.applied.cols()) + " channels, state.conjugate " +
                      std::to_string(state.conjugate.cols()) + ": must be " + std::to_string(channels_));
  }
  for (const auto& [name, value] : {std::pair{"state.energy_J", state.energy_J},
                                    {"state.granted_J", state.granted_J},
                                    {"state.work_out_J", state.work_out_J},
                                    {"state.received_J", state.received_J},
                                    {"state.sent_J", state.sent_J},
                                    {"state.vented_J", state.vented_J}}) {
    validate::finite(name, value);
  }
  if (!state.applied.allFinite() || !state.conjugate.allFinite()) {
    throw ConfigError("state.applied or state.conjugate is not finite");
  }
  state_ = state;
}

void EnergyTank::grant(double energy_J) {
  validate::not_negative("grant", energy_J);
  state_.energy_J += energy_J;
  state_.granted_J += energy_J;
  if (state_.energy_J > config_.maximum_J) {
    state_.vented_J += state_.energy_J - config_.maximum_J;
    state_.energy_J = config_.maximum_J;
  }
}

EnergyTankOutput EnergyTank::step(const EnergyTankInput& input, Seconds dt) noexcept {
  EnergyTankOutput output;
  output.applied = ChannelArray::Zero(6, channels_);
  const bool conjugate_usable = has_shape(input.conjugate, channels_) && input.conjugate.allFinite();
  const bool time_step_usable = std::isfinite(dt) && dt > 0.0;
  const bool billed = bill(input, conjugate_usable, dt, time_step_usable);
  exchange(input, time_step_usable ? std::min(dt, config_.dt_max_s) : 0.0, output);

  if (!billed || !conjugate_usable || !has_shape(input.desired, channels_) || !input.desired.allFinite() ||
      !std::isfinite(input.received_J) || input.received_J < 0.0 ||
      (input.measured.cols() != 0 && (!has_shape(input.measured, channels_) || !input.measured.allFinite()))) {
    state_.has_conjugate = false;
    return finish(output, Status::kInvalidInput);
  }
  if (input.conjugate_stale) {
    state_.has_conjugate = false;
    return finish(output, Status::kStale);
  }
  const bool exceeded = state_.has_conjugate && rate_exceeded(input.conjugate);
  state_.conjugate = input.conjugate;
  state_.has_conjugate = true;
  if (exceeded) {
    state_.rate_locked = true;
  } else if (state_.energy_J > config_.minimum_J) {
    state_.rate_locked = false;
  }
  if (!time_step_usable || dt > config_.dt_max_s) {
    return finish(output, Status::kInvalidTimeStep);
  }
  apply(input, state_.rate_locked, output);
  if (state_.rate_locked) {
    return finish(output, Status::kRateExceeded);
  }
  return finish(output, output.scale < 1.0 ? Status::kLimited : Status::kOk);
}

// Charges the tank with the work of the interval that just ended. False when a given number is unusable.
bool EnergyTank::bill(const EnergyTankInput& input, bool conjugate_usable, Seconds dt, bool time_step_usable) noexcept {
  double work_J = 0.0;
  if (input.has_work) {
    if (!std::isfinite(input.work_J)) {
      return false;
    }
    work_J = input.work_J;
  } else if (conjugate_usable && time_step_usable) {
    work_J = state_.applied.cwiseProduct(input.conjugate).sum() * dt;
    if (!std::isfinite(work_J)) {
      return false;
    }
  }
  state_.energy_J -= work_J;
  state_.work_out_J += work_J;
  return true;
}

void EnergyTank::exchange(const EnergyTankInput& input, Seconds dt, EnergyTankOutput& output) noexcept {
  if (std::isfinite(input.received_J) && input.received_J > 0.0) {
    state_.energy_J += input.received_J;
    state_.received_J += input.received_J;
  }
  if (input.requesting_peers > 0) {
    const double spare_J = std::max(0.0, state_.energy_J - config_.available_J);
    output.sent_J = std::min(input.requesting_peers * config_.exchange_W * dt, spare_J);
    state_.energy_J -= output.sent_J;
  }
  const double overflow_J = state_.energy_J - config_.maximum_J;
  if (overflow_J > 0.0) {
    state_.energy_J = config_.maximum_J;
    if (input.peer_has_room) {
      output.sent_J += overflow_J;
      output.sent_overflow_J = overflow_J;
    } else {
      state_.vented_J += overflow_J;
    }
  }
  state_.sent_J += output.sent_J;
  // Hysteresis, so that a level at the threshold does not chatter.
  if (state_.energy_J < config_.request_J) {
    state_.requesting = true;
  } else if (state_.energy_J >= config_.available_J) {
    state_.requesting = false;
  }
}

bool EnergyTank::rate_exceeded(const ChannelArray& conjugate) const noexcept {
  const Vector6 allowed = config_.conjugate_rate * config_.hold_s;
  for (int channel = 0; channel < channels_; ++channel) {
    for (int axis = 0; axis < 6; ++axis) {
      const double limit = allowed[axis] * (1.0 + kFloorTolerance);
      // An axis that can never carry power (no motor, no damping) has no rate to keep.
      const bool carries_power = config_.applied_limit[axis] > 0.0;
      if (carries_power && std::abs(conjugate(axis, channel) - state_.conjugate(axis, channel)) > limit) {
        return true;
      }
    }
  }
  return false;
}

ChannelArray EnergyTank::command(const EnergyTankInput& input, double reduction, const Vector6& damping,
                                 double scale) const noexcept {
  ChannelArray applied(6, channels_);
  for (int channel = 0; channel < channels_; ++channel) {
    for (int axis = 0; axis < 6; ++axis) {
      const double wanted =
          scale * ((1.0 - reduction) * input.desired(axis, channel)) - damping[axis] * input.conjugate(axis, channel);
      applied(axis, channel) = saturate(wanted, config_.applied_limit[axis]);
    }
  }
  return applied;
}

// Most work that `applied`, kept for hold_s, can do while each conjugate axis stays within c h of its value now:
// the maximum of a linear function over a box. A lagging arm may still move as measured: take the larger.
double EnergyTank::worst_work_J(const ChannelArray& applied, const EnergyTankInput& input) const noexcept {
  const bool lagging = input.measured.cols() == channels_;
  double power_W = 0.0;
  for (int channel = 0; channel < channels_; ++channel) {
    for (int axis = 0; axis < 6; ++axis) {
      const double conjugate = input.conjugate(axis, channel);
      const double drift = config_.conjugate_rate[axis] * config_.hold_s;
      const double flow = applied(axis, channel);
      double worst = flow * conjugate + std::abs(flow) * drift;
      if (lagging) {
        const double moved = input.measured(axis, channel);
        worst = std::max(worst, moved * conjugate + std::abs(moved) * drift);
      }
      power_W += worst;
    }
  }
  return power_W * config_.hold_s;
}

// Damping alone. It may use the reserve below minimum_J, else it would die at the floor and the tank never
// recover; but not more than the reserve, else a vibrating hand could drain it tick by tick. Below the reserve
// (only an exceeded rate gets there) it may use what there is.
ChannelArray EnergyTank::damp_within_budget(const EnergyTankInput& input, const Vector6& damping) const noexcept {
  const double floor_J = config_.minimum_J - damping_reserve_J_;
  const bool above_floor = state_.energy_J >= floor_J - kFloorTolerance * config_.minimum_J;
  const double budget_J = std::max(0.0, above_floor ? state_.energy_J - std::max(0.0, floor_J) : state_.energy_J);
  EnergyTankInput without_measured = input;
  without_measured.measured.resize(6, 0);  // what the arm's lag does is not the damping's to answer for
  ChannelArray applied = command(input, 1.0, damping, 0.0);
  if (worst_work_J(applied, without_measured) <= budget_J) {
    return applied;
  }
  double feasible = 0.0;
  double infeasible = 1.0;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (feasible + infeasible);
    const bool fits = worst_work_J(command(input, 1.0, middle * damping, 0.0), without_measured) <= budget_J;
    (fits ? feasible : infeasible) = middle;
  }
  return command(input, 1.0, feasible * damping, 0.0);
}

void EnergyTank::apply(const EnergyTankInput& input, bool damping_only, EnergyTankOutput& output) const noexcept {
  output.reduction =
      std::clamp((config_.request_J - state_.energy_J) / (config_.request_J - config_.minimum_J), 0.0, 1.0);
  output.damping = config_.damping_min + output.reduction * (config_.damping_max - config_.damping_min);
  const double budget_J = state_.energy_J - config_.minimum_J;
  if (damping_only || budget_J <= 0.0) {
    output.scale = 0.0;
    output.applied = damp_within_budget(input, output.damping);
    return;
  }
  const auto fits = [&](double scale) {
    return worst_work_J(command(input, output.reduction, output.damping, scale), input) <= budget_J;
  };
  if (fits(1.0)) {
    output.scale = 1.0;
  } else if (!fits(0.0)) {
    output.scale = 0.0;
    output.applied = damp_within_budget(input, output.damping);
    return;
  } else {
    double feasible = 0.0;
    double infeasible = 1.0;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (feasible + infeasible);
      (fits(middle) ? feasible : infeasible) = middle;
    }
    output.scale = feasible;
  }
  output.applied = command(input, output.reduction, output.damping, output.scale);
}

EnergyTankOutput EnergyTank::finish(EnergyTankOutput output, Status status) noexcept {
  output.status = status;
  output.energy_J = state_.energy_J;
  output.requesting = state_.requesting;
  output.has_room = state_.energy_J < config_.maximum_J;
  state_.applied = output.applied;
  return output;
}

}  // namespace saras
