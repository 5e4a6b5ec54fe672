// Mean twist of a moving frame over each interval, raw and low-passed.
#pragma once

#include "saras/spatial/law.hpp"

namespace saras {

struct TwistEstimatorConfig {
  double cutoff_hz = 20.0;  ///< of the first-order low-pass behind the filtered twist [Hz]
  Seconds dt_max_s = 0.5;   ///< longest interval that still gives a twist [s]
  void validate() const;    ///< throws ConfigError
};

struct TwistEstimatorInput {
  Pose base_T_body;
};

struct TwistEstimatorOutput {
  Twist twist;           ///< displacement / dt in the base frame, unfiltered: what energy is billed with
  Twist twist_filtered;  ///< for damping and display only
  Status status = Status::kOk;
};

struct TwistEstimatorState {
  bool has_previous = false;
  Pose base_T_previous;
  Twist twist_filtered;
};

/// twist = displacement(previous, now) / dt (KDL::diff); filtered by y += (1 - exp(-2 pi f dt)) (x - y),
/// the exact step response of a first-order low-pass, so that it is stable for every dt.
/// An interval beyond dt_max_s gives no twist, and its end is the next baseline.
class TwistEstimator {
 public:
  explicit TwistEstimator(TwistEstimatorConfig config);
  TwistEstimatorOutput step(const TwistEstimatorInput& input, Seconds dt) noexcept;
  void reset(const TwistEstimatorState& state = {}) { state_ = state; }
  const TwistEstimatorState& state() const { return state_; }
  const TwistEstimatorConfig& config() const { return config_; }

 private:
  TwistEstimatorConfig config_;
  TwistEstimatorState state_;
};

static_assert(has_law_shape<TwistEstimator, TwistEstimatorInput, TwistEstimatorState>());

}  // namespace saras
