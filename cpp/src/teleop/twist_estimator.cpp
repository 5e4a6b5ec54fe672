#include "saras/teleop/twist_estimator.hpp"

#include "saras/spatial/low_pass.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {

void TwistEstimatorConfig::validate() const {
  validate::positive("cutoff_hz", cutoff_hz);
  validate::positive("dt_max_s", dt_max_s);
}

TwistEstimator::TwistEstimator(TwistEstimatorConfig config) : config_(config) { config_.validate(); }

TwistEstimatorOutput TwistEstimator::step(const TwistEstimatorInput& input, Seconds dt) noexcept {
  TwistEstimatorOutput output;
  if (!is_valid(input.base_T_body)) {
    output.status = Status::kInvalidInput;
    return output;
  }
  if (!state_.has_previous) {
    state_.has_previous = true;
    state_.base_T_previous = input.base_T_body;
    output.status = Status::kWaiting;
    return output;
  }
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    if (dt > config_.dt_max_s) {
      // A new baseline, or the next twist would divide the gap's displacement by its own short dt.
      state_.base_T_previous = input.base_T_body;
    }
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  const Twist moved = displacement(state_.base_T_previous, input.base_T_body);
  output.twist = {moved.linear / dt, moved.angular / dt};
  low_pass(state_.twist_filtered, output.twist, low_pass_gain(config_.cutoff_hz, dt));
  state_.base_T_previous = input.base_T_body;
  output.twist_filtered = state_.twist_filtered;
  return output;
}

}  // namespace saras
