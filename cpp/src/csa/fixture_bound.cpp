#include "saras/csa/fixture_bound.hpp"

#include <algorithm>
#include <cmath>

namespace saras::csa {
namespace {

constexpr double kMillimetres = 1e3;
constexpr int kRounds = 4;
constexpr int kHalvings = 16;
constexpr double kRounding_m = 1e-10;

}  // namespace

FixtureBound::FixtureBound(const std::vector<TeleopFixture>& fixtures)
    : set_(hard_fixture_set(fixtures)), solver_(3, 2 * kMaxFixtureRows) {}

FixtureOutput FixtureBound::look(const Vector3& position) noexcept {
  FixtureInput input;
  input.base_T_tip.translation = position;
  return set_.step(input, 1.0);  // time does not enter
}

bool FixtureBound::obeys(const FixtureOutput& there) const noexcept {
  for (std::size_t i = 0; i < set_.fixtures().size(); ++i) {
    if (!(there.distance_m[i] >= floor_m_[i])) {
      return false;
    }
  }
  return true;
}

void FixtureBound::add_rows(const FixtureOutput& found, const Vector3& step, bool only_passed) noexcept {
  for (const FixtureRow& row : found.rows) {
    const auto fixture = static_cast<std::size_t>(row.fixture);
    if (rows_ == solver_.rows_max() || (only_passed && found.distance_m[fixture] >= floor_m_[fixture])) {
      continue;
    }
    const Vector3 axis = row.axis.head<3>();
    // The own place is allowed: neither bound asks for a motion.
    const double moved = axis.dot(step);
    solver_.rows.row(rows_) = axis.transpose();
    solver_.row_lower[rows_] = kMillimetres * std::min(row.lower_m + moved, 0.0);
    solver_.row_upper[rows_] = kMillimetres * std::max(row.upper_m + moved, 0.0);
    ++rows_;
  }
}

Vector3 FixtureBound::nearest(const Vector3& wanted_step) noexcept {
  const Vector3 wanted = kMillimetres * wanted_step;
  bool allowed = true;
  for (int i = 0; i < rows_ && allowed; ++i) {
    const double along = solver_.rows.row(i).dot(wanted);
    allowed = along >= solver_.row_lower[i] && along <= solver_.row_upper[i];
  }
  if (allowed) {
    return wanted_step;
  }
  solver_.gradient = -wanted;
  if (solver_.solve(rows_).status != QpStatus::kSolved) {
    return Vector3::Zero();
  }
  return solver_.solution() / kMillimetres;
}

Vector3 FixtureBound::bound(const Vector3& from, const Vector3& wanted) noexcept {
  const FixtureOutput here = look(from);
  if (here.status == Status::kInvalidInput || !is_finite(wanted)) {
    return wanted.allFinite() ? from : wanted;  // who asks refuses a place that is none
  }
  for (std::size_t i = 0; i < floor_m_.size(); ++i) {
    floor_m_[i] = std::min(-kBeyond_m, here.distance_m[i] - kRounding_m);
  }
  const FixtureState features = set_.state();
  rows_ = 0;
  add_rows(here, Vector3::Zero(), false);
  Vector3 step = Vector3::Zero();
  for (int round = 0; round < kRounds; ++round) {
    const Vector3 wanted_step = wanted - from;
    step = nearest(wanted_step);
    Vector3 next = step == wanted_step ? wanted : Vector3(from + step);
    set_.reset(features);
    const FixtureOutput there = look(next);
    if (obeys(there)) {
      return next;
    }
    add_rows(there, step, true);
  }
  // Half of what is at the border is left for the rounding of the steps to come.
  for (std::size_t i = 0; i < floor_m_.size(); ++i) {
    floor_m_[i] = std::min(-0.5 * kBeyond_m, here.distance_m[i]);
  }
  double allowed = 0.0;
  double refused = 1.0;
  FixtureState reached = features;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (allowed + refused);
    set_.reset(features);
    if (obeys(look(from + middle * step))) {
      allowed = middle;
      reached = set_.state();
    } else {
      refused = middle;
    }
  }
  set_.reset(reached);
  return from + allowed * step;
}

}  // namespace saras::csa
