#include "saras/collision/repulsive_force.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {

void RepulsiveForceConfig::validate() const {
  validate::positive("start_distance_m", start_distance_m);
  validate::not_negative("stiffness_N_m", stiffness_N_m);
  validate::not_negative("force_limit_N", force_limit_N);
  validate::positive("dt_max_s", dt_max_s);
}

RepulsiveForce::RepulsiveForce(RepulsiveForceConfig config) : config_(config) { config_.validate(); }

RepulsiveForceOutput RepulsiveForce::step(const RepulsiveForceInput& input, Seconds dt) noexcept {
  RepulsiveForceOutput output;
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  if (std::isnan(input.distance_m)) {
    output.status = Status::kStale;
    return output;
  }
  const double nearer = config_.start_distance_m - input.distance_m;
  if (nearer <= 0.0) {
    return output;
  }
  if (!std::isfinite(nearer) || !(std::abs(input.normal.norm() - 1.0) <= 1e-6)) {
    output.status = Status::kInvalidInput;
    return output;
  }
  const double force = config_.stiffness_N_m * nearer;
  output.wrench.force = -std::min(force, config_.force_limit_N) * input.normal;
  if (force > config_.force_limit_N) {
    output.status = Status::kLimited;
  }
  return output;
}

}  // namespace saras
