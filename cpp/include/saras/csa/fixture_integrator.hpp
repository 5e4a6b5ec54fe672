// The velocity integrator of an arm with virtual fixtures: its set-point does not pass a hard one.
#pragma once

#include <optional>

#include "saras/csa/fixture_bound.hpp"

namespace saras::csa {

struct FixtureIntegratorInput {
  VelocityIntegratorInput motion;
  FixtureWord word;
};

struct FixtureIntegratorState {
  VelocityIntegratorState integrator;
  FixtureState fixtures;
};

/// VelocityIntegrator, whose set-point is brought to the nearest place that the hard fixtures allow as its last bound.
/// Without a hard fixture, or switched off, it is that law to the bit. Fixtures of which it is not known where they
/// are: the set-point stands (STALE).
class FixtureIntegrator {
 public:
  /// Throws ConfigError.
  FixtureIntegrator(VelocityIntegratorConfig config, const std::vector<TeleopFixture>& fixtures);
  VelocityIntegratorOutput step(const FixtureIntegratorInput& input, Seconds dt) noexcept;
  /// Without an argument: starts from measured again.
  void reset(const FixtureIntegratorState& state = {});
  const FixtureIntegratorState& state() const { return state_; }
  const VelocityIntegratorConfig& config() const { return integrator_.config(); }

 private:
  VelocityIntegrator integrator_;
  std::optional<FixtureBound> bound_;  ///< none without a hard fixture
  FixtureIntegratorState state_;
};

static_assert(has_law_shape<FixtureIntegrator, FixtureIntegratorInput, FixtureIntegratorState>());

}  // namespace saras::csa
