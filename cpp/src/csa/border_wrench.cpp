#include "saras/csa/border_wrench.hpp"

#include <algorithm>

#include "saras/spatial/clamp_norm.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::csa {
namespace {

/// The solver's tolerances are for numbers about one: it counts in millimetres.
constexpr double kMillimetres = 1e3;
/// A shorter way back is none [m].
constexpr double kShortest = 1e-8;

BorderWrenchConfig validated(const BorderWrenchConfig& config) {
  config.validate();
  return config;
}

}  // namespace

void BorderWrenchConfig::validate() const {
  validate::positive("stiffness_N_m", stiffness_N_m);
  validate::not_negative("damping_N_s_m", damping_N_s_m);
  validate::positive("force_limit_N", force_limit_N);
  validate::positive("dt_max_s", dt_max_s);
}

BorderWrench::BorderWrench(BorderWrenchConfig config) : config_(validated(config)), solver_(3, kMaxFixtureRows) {
  solver_.hessian.setIdentity();
  solver_.gradient.setZero();
  solver_.lower.setConstant(-std::numeric_limits<double>::infinity());
  solver_.upper.setConstant(std::numeric_limits<double>::infinity());
  solver_.soft.setZero();
}

BorderWrenchOutput BorderWrench::step(const BorderWrenchInput& input, Seconds dt) noexcept {
  BorderWrenchOutput output;
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  if (!input.velocity.allFinite()) {
    output.status = Status::kInvalidInput;
    return output;
  }
  if (input.rows == nullptr) {
    return output;
  }
  int count = 0;
  bool outside = false;
  for (const FixtureRow& row : *input.rows) {
    if (!row.axis.tail<3>().isZero(0.0)) {
      continue;  // of a point on the shaft: turning obeys it as well
    }
    solver_.rows.row(count) = row.axis.head<3>().transpose();
    solver_.row_lower[count] = kMillimetres * row.lower_m;
    solver_.row_upper[count] = kMillimetres * row.upper_m;
    outside = outside || row.lower_m > 0.0 || row.upper_m < 0.0;
    ++count;
  }
  if (!outside) {
    return output;
  }
  const QpStatus solved = solver_.solve(count).status;
  if (solved != QpStatus::kSolved) {
    output.status = solved == QpStatus::kInvalidInput ? Status::kInvalidInput : Status::kLimited;
    return output;
  }
  output.way = solver_.solution() / kMillimetres;
  const double length = output.way.norm();
  if (length < kShortest) {
    output.way.setZero();
    return output;
  }
  const Vector3 inwards = output.way / length;
  const double force = config_.stiffness_N_m * length - config_.damping_N_s_m * inwards.dot(input.velocity);
  output.wrench.force = std::clamp(force, 0.0, config_.force_limit_N) * inwards;
  output.status = force > config_.force_limit_N ? Status::kLimited : Status::kOk;
  return output;
}

}  // namespace saras::csa
