#include "saras/csa/fixture_force.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/clamp_norm.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::csa {
namespace {

/// Three walls at right angles push so many times as hard as one.
const double kCorner = std::sqrt(3.0);

double tube_m(const FixtureGeometry& geometry) {
  if (const auto* line = std::get_if<LineFixture>(&geometry)) {
    return line->radius_m;
  }
  const auto* path = std::get_if<PathFixture>(&geometry);
  return path != nullptr ? path->radius_m : -1.0;
}

}  // namespace

void FixtureForceConfig::validate() const {
  validate::not_negative("force_limit_N", force_limit_N);
  validate::positive("ramp_s", ramp_s);
  validate::positive("dt_max_s", dt_max_s);
}

FixtureForce::FixtureForce(FixtureForceConfig config, const std::vector<TeleopFixture>& fixtures)
    : config_((config.validate(), config)), fixtures_(fixtures), set_(fixture_set(fixtures)) {
  for (const TeleopFixture& each : fixtures_) {
    tube_m_.push_back(tube_m(each.fixture.geometry));
    guides_ = guides_ || tube_m_.back() >= 0.0;
  }
}

void FixtureForce::reset(const FixtureForceState& state) {
  state_ = state;
  set_.reset(state.fixtures);
}

Vector3 FixtureForce::wall(const FixtureOutput& found, std::size_t i, const Vector3& hand_ahead) const noexcept {
  const TeleopFixture& of = fixtures_[i];
  const auto spring_N = [&](double distance_m, const Vector3& normal) {
    const double least_m = std::min(distance_m, distance_m + normal.dot(hand_ahead));
    return of.stiffness_N_m * std::max(0.0, of.start_m - least_m);
  };
  const auto* hull = std::get_if<HullFixture>(&of.fixture.geometry);
  if (hull == nullptr || !hull->keep_in) {
    const double force_N = spring_N(found.distance_m[i], found.normals[i]);
    return std::min(force_N, config_.force_limit_N) * found.normals[i];
  }
  Vector3 sum = Vector3::Zero();
  double most_N = 0.0;
  for (const FixtureRow& row : found.rows) {
    if (row.fixture == static_cast<int>(i)) {
      const Vector3 normal = row.axis.head<3>();
      const double force_N = spring_N(-row.lower_m, normal);
      most_N = std::max(most_N, force_N);
      sum += force_N * normal;
    }
  }
  return clamp_norm(sum, std::min(kCorner * most_N, config_.force_limit_N));
}

Vector3 FixtureForce::guide(const FixtureOutput& of_hand, std::size_t i) const noexcept {
  const double nearer_m = std::min(fixtures_[i].start_m, tube_m_[i]) - of_hand.distance_m[i];
  const double force_N = fixtures_[i].stiffness_N_m * std::max(0.0, nearer_m);
  return std::min(force_N, config_.force_limit_N) * of_hand.normals[i];
}

Vector3 FixtureForce::wanted(const FixtureForceInput& input, FixtureForceOutput& output) noexcept {
  if (!input.word.known) {
    output.status = Status::kStale;
    return Vector3::Zero();
  }
  FixtureInput place;
  place.base_T_tip = input.base_T_tip;
  const FixtureOutput found = set_.step(place, config_.dt_max_s);
  if (found.status == Status::kInvalidInput || !is_finite(input.hand_ahead)) {
    output.status = Status::kInvalidInput;
    return Vector3::Zero();
  }
  state_.fixtures = set_.state();
  output.distance_m = found.distance_m;
  output.nearest = found.nearest;
  output.closest = found.closest;
  output.normal = found.normal;
  output.violation_m = std::max(0.0, -found.distance_m[static_cast<std::size_t>(found.nearest)]);
  if (!input.word.on) {
    return Vector3::Zero();
  }
  FixtureOutput of_hand;
  if (guides_) {
    place.base_T_tip.translation += input.hand_ahead;
    of_hand = set_.step(place, config_.dt_max_s);
    set_.reset(state_.fixtures);
  }
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < fixtures_.size(); ++i) {
    sum += tube_m_[i] < 0.0 ? wall(found, i, input.hand_ahead) : guide(of_hand, i);
  }
  output.status = sum.isZero(0.0) ? Status::kOk : Status::kLimited;
  return clamp_norm(sum, config_.force_limit_N);
}

FixtureForceOutput FixtureForce::step(const FixtureForceInput& input, Seconds dt) noexcept {
  FixtureForceOutput output;
  if (fixtures_.empty()) {
    return output;
  }
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    state_.force.setZero();
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  const Vector3 change = wanted(input, output) - state_.force;
  state_.force += clamp_norm(change, config_.force_limit_N / config_.ramp_s * dt);
  output.wrench.force = state_.force;
  return output;
}

}  // namespace saras::csa
