// What the hand feels of virtual fixtures: a one-sided spring back to where the tip may be.
#pragma once

#include <limits>

#include "saras/csa/fixture_rows.hpp"
#include "saras/csa/qp.hpp"
#include "saras/spatial/law.hpp"

namespace saras::csa {

struct BorderWrenchConfig {
  double stiffness_N_m = 300.0;
  double damping_N_s_m = 1.0;
  double force_limit_N = 3.3;
  Seconds dt_max_s = 0.1;
  void validate() const;  ///< throws ConfigError
};

struct BorderWrenchInput {
  const FixtureRows* rows = nullptr;   ///< of FixtureSet at the point that is led by the hand; null: no fixture
  Vector3 velocity = Vector3::Zero();  ///< of that point, base axes [m/s]
};

struct BorderWrenchOutput {
  Wrench wrench;                  ///< on the hand, base axes
  Vector3 way = Vector3::Zero();  ///< the shortest back to where all fixtures are obeyed; zero inside [m]
  Status status = Status::kOk;  ///< LIMITED: cut at the limit; or fixtures that contradict each other, without a force
};

struct BorderWrenchState {};

/// f = max(0, k |w| - b v.w/|w|) w/|w|, with w the least displacement that obeys all rows on the tip's position. It is
/// the projection on a convex set: continuous, also around corners. Rows on the shaft (remote centres) are left out.
/// Inside there is no force, and none ever points outwards.
class BorderWrench {
 public:
  explicit BorderWrench(BorderWrenchConfig config);
  BorderWrenchOutput step(const BorderWrenchInput& input, Seconds dt) noexcept;
  void reset(const BorderWrenchState& state = {}) { state_ = state; }
  const BorderWrenchState& state() const { return state_; }
  const BorderWrenchConfig& config() const { return config_; }

 private:
  BorderWrenchConfig config_;
  BorderWrenchState state_;
  QpSolver solver_;
};

static_assert(has_law_shape<BorderWrench, BorderWrenchInput, BorderWrenchState>());

}  // namespace saras::csa
