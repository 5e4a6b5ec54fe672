#include "saras/csa/fixture_integrator.hpp"

namespace saras::csa {
namespace {

/// Of fixtures that are nobody knows where.
class Nowhere final : public PositionBound {
 public:
  Vector3 bound(const Vector3& from, const Vector3&) noexcept override { return from; }
};

}  // namespace

FixtureIntegrator::FixtureIntegrator(VelocityIntegratorConfig config, const std::vector<TeleopFixture>& fixtures)
    : integrator_(config) {
  FixtureBound bound(fixtures);
  if (!bound.empty()) {
    bound_.emplace(std::move(bound));
  }
}

VelocityIntegratorOutput FixtureIntegrator::step(const FixtureIntegratorInput& input, Seconds dt) noexcept {
  if (!bound_ || !input.word.on) {
    VelocityIntegratorOutput output = integrator_.step(input.motion, dt);
    state_.integrator = integrator_.state();
    return output;
  }
  VelocityIntegratorInput motion = input.motion;
  motion.stale = motion.stale || !input.word.known;
  Nowhere nowhere;
  PositionBound* const bound = input.word.known ? static_cast<PositionBound*>(&*bound_) : &nowhere;
  VelocityIntegratorOutput output = integrator_.step(motion, dt, bound);
  state_ = {integrator_.state(), bound_->state()};
  return output;
}

void FixtureIntegrator::reset(const FixtureIntegratorState& state) {
  state_ = state;
  integrator_.reset(state.integrator);
  if (bound_) {
    bound_->reset(state.fixtures);
  }
}

}  // namespace saras::csa
