#include "saras/model/stiffness_gp.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

/// Allowed beyond speed_limit_m_s * dt: the jitter of stamps [m].
constexpr double kPositionSlack_m = 2e-4;
/// A single sample says no more than this about the agreement with the map [sigma].
constexpr double kGreatestDeviation = 6.0;
/// The local model is built anew after it has learned this many times its size: better normal, no rounding errors.
constexpr int kLearnedTimesSize = 4;

}  // namespace

const char* to_string(SampleVerdict verdict) noexcept {
  switch (verdict) {
    case SampleVerdict::kLearned:
      return "LEARNED";
    case SampleVerdict::kNotTouching:
      return "NOT_TOUCHING";
    case SampleVerdict::kOutlier:
      return "OUTLIER";
    case SampleVerdict::kRelearned:
      return "RELEARNED";
    case SampleVerdict::kSensorDrift:
      return "SENSOR_DRIFT";
    case SampleVerdict::kImplausiblePosition:
      return "IMPLAUSIBLE_POSITION";
    case SampleVerdict::kImplausibleForce:
      return "IMPLAUSIBLE_FORCE";
    case SampleVerdict::kInvalid:
      break;
  }
  return "INVALID";
}

void StiffnessGpConfig::validate() const {
  grid.validate();
  local.validate();
  validate::positive("recenter_m", recenter_m);
  validate::in_range("recenter_m", recenter_m, 0.0, local.radius_m);
  validate::positive("contact_force_N", contact_force_N);
  validate::less("contact_force_N", contact_force_N, "force_limit_N", force_limit_N);
  validate::positive("workspace_m", workspace_m);
  validate::positive("speed_limit_m_s", speed_limit_m_s);
  if (!std::isinf(outlier_sigma)) {
    validate::in_range("outlier_sigma", outlier_sigma, 1.0, 1e6);
  }
  validate::in_range("outlier_patience", outlier_patience, 1, 1'000'000);
  validate::positive("bias_time_constant_s", bias_time_constant_s);
  validate::positive("bias_limit_N", bias_limit_N);
  validate::positive("agreement_time_constant_s", agreement_time_constant_s);
  validate::positive("agreement_limit", agreement_limit);
  validate::positive("dt_max_s", dt_max_s);
}

StiffnessGp::StiffnessGp(StiffnessGpConfig config) : config_((config.validate(), config)) { reset(); }

void StiffnessGp::reset() {
  StiffnessGpState state{HashGrid(config_.grid), LocalModel(config_.local, config_.grid)};
  state_ = std::move(state);
}

void StiffnessGp::adopt(const GpHyperparameters& hyperparameters) {
  state_.local.adopt(hyperparameters);
  config_.local.hyperparameters = hyperparameters;
}

SampleVerdict StiffnessGp::plausible(const StiffnessGpInput& input, Seconds dt) noexcept {
  const double moved = (input.tip_position - state_.last_position).norm();
  const bool jumped = state_.has_last_position && moved > config_.speed_limit_m_s * dt + kPositionSlack_m;
  state_.last_position = input.tip_position;
  state_.has_last_position = true;
  if (jumped || !(input.tip_position.cwiseAbs().maxCoeff() <= config_.workspace_m)) {
    return SampleVerdict::kImplausiblePosition;
  }
  return input.force.norm() <= config_.force_limit_N ? SampleVerdict::kLearned : SampleVerdict::kImplausibleForce;
}

void StiffnessGp::center_on(const Vector3& position) noexcept {
  const int size = std::max(state_.local.process().size(), config_.local.min_samples);
  const bool left = (position - state_.local.center()).norm() > config_.recenter_m;
  if (left || state_.learned_since_build >= kLearnedTimesSize * size || !state_.local.usable()) {
    state_.local.build(state_.grid, position);
    state_.learned_since_build = 0;
  }
}

SampleVerdict StiffnessGp::learn(const Vector3& position, const Vector3& force, double speed_m_s, Seconds dt) noexcept {
  SampleVerdict verdict = SampleVerdict::kLearned;
  if (state_.local.usable()) {
    const GpSample sample = state_.local.process_sample({position, force, speed_m_s, 1.0});
    const GpPrediction expected = state_.local.process().predict(position, sample.power_W);
    const double deviation = (sample.value_N - expected.mean) / std::sqrt(expected.variance + sample.noise_variance_N2);
    const double share = 1.0 - std::exp(-dt / config_.agreement_time_constant_s);
    state_.disagreement +=
        share * (std::clamp(deviation, -kGreatestDeviation, kGreatestDeviation) - state_.disagreement);
    if (std::abs(deviation) > config_.outlier_sigma) {
      if (++state_.outliers_in_a_row < config_.outlier_patience) {
        return SampleVerdict::kOutlier;
      }
      state_.grid.forget(position, config_.recenter_m);
      state_.local.clear();
      state_.disagreement = 0.0;
      verdict = SampleVerdict::kRelearned;
    }
    state_.outliers_in_a_row = 0;
  }
  const std::uint64_t evicted = state_.grid.evicted();
  const int place = state_.grid.insert(position, force, speed_m_s);
  if (state_.grid.evicted() != evicted) {
    state_.local.clear();  // its places may have been given to others
  }
  if (state_.local.usable()) {
    state_.local.learn(state_.grid, place);
    ++state_.learned_since_build;
  } else {
    center_on(position);
  }
  return verdict;
}

StiffnessGpOutput StiffnessGp::step(const StiffnessGpInput& input, Seconds dt) noexcept {
  StiffnessGpOutput output;
  output.bias_N = state_.bias_N;
  output.disagreement = state_.disagreement;
  if (!input.tip_position.allFinite() || !input.force.allFinite() || !input.tip_velocity.allFinite()) {
    output.status = Status::kInvalidInput;
    return output;
  }
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  output.verdict = plausible(input, dt);
  if (output.verdict != SampleVerdict::kLearned) {
    ++state_.refused;
    output.status = Status::kInvalidInput;
    return output;
  }
  if (input.belief == TouchBelief::kFree) {
    state_.bias_N += (1.0 - std::exp(-dt / config_.bias_time_constant_s)) * (input.force - state_.bias_N);
  }
  const Vector3 force = input.force - state_.bias_N;
  const bool drifted = state_.bias_N.norm() > config_.bias_limit_N;
  center_on(input.tip_position);
  if (drifted) {
    output.verdict = SampleVerdict::kSensorDrift;
  } else if (input.belief == TouchBelief::kFree || force.norm() < config_.contact_force_N) {
    output.verdict = SampleVerdict::kNotTouching;
  } else {
    output.verdict = learn(input.tip_position, force, force.normalized().dot(input.tip_velocity), dt);
  }
  const bool refused = drifted || output.verdict == SampleVerdict::kOutlier;
  state_.refused += refused ? 1 : 0;
  output.bias_N = state_.bias_N;
  output.disagreement = state_.disagreement;
  output.disagrees = std::abs(state_.disagreement) > config_.agreement_limit;
  output.estimate = state_.local.estimate(input.tip_position);
  if (output.estimate.status != EstimateStatus::kOk) {
    output.status = Status::kWaiting;
  } else if (refused) {
    output.status = Status::kLimited;
  }
  return output;
}

}  // namespace saras
