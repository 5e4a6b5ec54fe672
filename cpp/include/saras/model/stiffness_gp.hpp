// Stiffness and surface from what the tool feels, one sample at a time: the law that runs at the sensor's rate.
#pragma once

#include "saras/model/hash_grid.hpp"
#include "saras/model/local_model.hpp"
#include "saras/spatial/law.hpp"

namespace saras {

struct StiffnessGpConfig {
  HashGridConfig grid;
  LocalModelConfig local;
  double recenter_m = 1.5e-3;         ///< the local model is built anew when the tip is this far from its centre [m]
  double contact_force_N = 0.1;       ///< below it nothing is touched [N]
  double force_limit_N = 40.0;        ///< above it no tissue was meant: another unit, a broken sensor [N]
  double workspace_m = 2.0;           ///< greatest |coordinate| of a tip [m]
  double speed_limit_m_s = 1.0;       ///< of a tip between two samples [m/s]
  double outlier_sigma = 6.0;         ///< further from the prediction is an outlier; infinite: nothing is
  int outlier_patience = 30;          ///< so many in a row are no outliers: the tissue is another one
  double bias_time_constant_s = 0.5;  ///< of the sensor's offset, taken while the tip is free [s]
  double bias_limit_N = 0.5;          ///< a greater offset is a sensor that drifted [N]
  double agreement_time_constant_s = 1.0;  ///< over which the disagreement with the map is averaged [s]
  double agreement_limit = 2.5;            ///< mean deviation [sigma] above which the map and the tissue disagree
  double dt_max_s = 0.1;
  void validate() const;  ///< throws ConfigError
};

/// What somebody else knows of the tip.
enum class TouchBelief : std::uint8_t {
  kUnknown = 0,  ///< the force decides
  kFree,         ///< surely touches nothing: the sensor's offset is taken
  kTouching,
};

struct StiffnessGpInput {
  Vector3 tip_position = Vector3::Zero();  ///< base frame [m]
  Vector3 force = Vector3::Zero();         ///< that the tool exerts on the tissue, base frame [N]
  Vector3 tip_velocity = Vector3::Zero();  ///< base frame; zero: not known, damping counts as stiffness then [m/s]
  TouchBelief belief = TouchBelief::kUnknown;
};

/// What became of a sample.
enum class SampleVerdict : std::uint8_t {
  kLearned = 0,
  kNotTouching,          ///< no contact, or it was lost
  kOutlier,              ///< far from what the neighbourhood predicts; not learned
  kRelearned,            ///< outlier_patience outliers in a row: what was known here is forgotten, this is learned
  kSensorDrift,          ///< the offset in free air is above bias_limit_N; not learned
  kImplausiblePosition,  ///< beyond workspace_m or speed_limit_m_s: another unit, another frame; not learned
  kImplausibleForce,     ///< beyond force_limit_N: another unit, a broken sensor; not learned
  kInvalid,              ///< not finite
};
const char* to_string(SampleVerdict verdict) noexcept;

struct StiffnessGpOutput {
  SurfaceEstimate estimate;  ///< under the tip, from all samples near it
  SampleVerdict verdict = SampleVerdict::kInvalid;
  bool disagrees = false;     ///< the tissue is not, or no longer, what the map says: drift, or the organ has moved
  double disagreement = 0.0;  ///< mean deviation of the samples from the map [sigma]
  Vector3 bias_N = Vector3::Zero();  ///< the sensor's offset that was subtracted
  Status status = Status::kOk;       ///< WAITING: nothing known here; LIMITED: known, but this sample was not learned
};

struct StiffnessGpState {
  HashGrid grid;
  LocalModel local;
  int learned_since_build = 0;
  Vector3 last_position = Vector3::Zero();
  bool has_last_position = false;
  Vector3 bias_N = Vector3::Zero();
  double disagreement = 0.0;
  int outliers_in_a_row = 0;
  std::uint64_t refused = 0;  ///< samples not learned that should have been: outliers, drift, implausible, invalid
};

/// Each sample that touches goes into the hash grid, and into the local model under the tip by two rank-1 updates; the
/// model is built anew only after the tip has left its centre. Work and memory are bounded whatever the session's
/// length.
///
/// Bad input is named in the verdict and leaves the map as it was. Time enters in the sensor's offset, in the speed
/// limit and in the averaging of the disagreement only.
class StiffnessGp {
 public:
  explicit StiffnessGp(StiffnessGpConfig config = {});  ///< throws ConfigError
  StiffnessGpOutput step(const StiffnessGpInput& input, Seconds dt) noexcept;
  void reset();
  void reset(const StiffnessGpState& state) { state_ = state; }
  const StiffnessGpState& state() const { return state_; }
  const StiffnessGpConfig& config() const { return config_; }
  /// Takes over what was learned off the control thread; costs one build. Throws ConfigError.
  void adopt(const GpHyperparameters& hyperparameters);

 private:
  SampleVerdict plausible(const StiffnessGpInput& input, Seconds dt) noexcept;
  SampleVerdict learn(const Vector3& position, const Vector3& force, double speed_m_s, Seconds dt) noexcept;
  void center_on(const Vector3& position) noexcept;

  StiffnessGpConfig config_;
  StiffnessGpState state_;
};

static_assert(has_law_shape<StiffnessGp, StiffnessGpInput, StiffnessGpState>());

}  // namespace saras
