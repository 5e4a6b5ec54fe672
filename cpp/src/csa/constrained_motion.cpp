#include "saras/csa/constrained_motion.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::csa {
namespace {

void check_size(const char* field, const JointVector& value, Eigen::Index joints) {
  if (value.size() != joints) {
    throw ConfigError(std::string(field) + ": length = " + std::to_string(value.size()) + ": must be " +
                      std::to_string(joints));
  }
}

std::string element(const char* field, Eigen::Index i) { return std::string(field) + "[" + std::to_string(i) + "]"; }

ConstrainedMotionConfig validated(ConstrainedMotionConfig config) {
  config.validate();
  return config;
}

/// The singular value that a full-rank Jacobian of this many joints has last.
double smallest_singular_value(const Eigen::Matrix<double, 6, 6>& gram, Eigen::Index joints) noexcept {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(gram, Eigen::EigenvaluesOnly);
  const Eigen::Index last = joints < 6 ? 6 - joints : 0;
  return std::sqrt(std::max(0.0, solver.eigenvalues()[last]));
}

}  // namespace

const char* to_string(MotionReason reason) noexcept {
  static constexpr std::array<const char*, 15> kNames = {
      "NONE",          "SPEED_LIMIT",     "JOINT_LIMIT",    "LEAD_LIMIT",        "NEAR_SINGULAR",
      "FORCE_CAP",     "FIXTURE_ACTIVE",  "INVALID_INPUT",  "INVALID_TIME_STEP", "STALE",
      "FORCE_UNKNOWN", "FORCE_SATURATED", "NORMAL_UNKNOWN", "INFEASIBLE",        "SOLVER_FAILED"};
  const auto index = static_cast<std::size_t>(reason);
  return index < kNames.size() ? kNames[index] : "UNKNOWN";
}

void ConstrainedMotionConfig::validate() const {
  const Eigen::Index joints = lower.size();
  validate::in_range("joints", static_cast<double>(joints), 1, kMaxJoints);
  check_size("upper", upper, joints);
  check_size("speed", speed, joints);
  check_size("lead", lead, joints);
  for (Eigen::Index i = 0; i < joints; ++i) {
    validate::finite(element("lower", i).c_str(), lower[i]);
    validate::finite(element("upper", i).c_str(), upper[i]);
    validate::less(element("lower", i).c_str(), lower[i], element("upper", i).c_str(), upper[i]);
    validate::positive(element("speed", i).c_str(), speed[i]);
    validate::positive(element("lead", i).c_str(), lead[i]);
  }
  validate::positive("rotation_weight_m", rotation_weight_m);
  validate::in_range("first_weight", first_weight, 1.0, 1000.0);
  validate::in_range("damping", damping, 1e-9, 1.0);
  validate::positive("singular_value_min_m", singular_value_min_m);
  validate::in_range("damping_singular", damping_singular, damping, 1.0);
  validate::positive("recovery_speed_m_s", recovery_speed_m_s);
  validate::positive("soft_weight", soft_weight);
  validate::positive("dt_max_s", dt_max_s);
}

ConstrainedMotion::ConstrainedMotion(ConstrainedMotionConfig config)
    : config_(validated(std::move(config))), solver_(joints(), kMaxFixtureRows, config_.soft_weight) {}

bool ConstrainedMotion::is_valid(const ConstrainedMotionInput& input) const noexcept {
  const Eigen::Index n = joints();
  return input.q.size() == n && input.q.allFinite() && (input.q_measured.size() == 0 || input.q_measured.size() == n) &&
         input.q_measured.allFinite() && input.jacobian.cols() == n && input.jacobian.allFinite() &&
         is_finite(input.twist) && input.first.allFinite() && (input.rows == nullptr || !input.rows->overflow);
}

void ConstrainedMotion::set_bounds(const ConstrainedMotionInput& input, Seconds dt) noexcept {
  for (Eigen::Index i = 0; i < joints(); ++i) {
    double low = (config_.lower[i] - input.q[i]) / dt;
    double high = (config_.upper[i] - input.q[i]) / dt;
    if (input.q_measured.size() > 0) {
      const double ahead = input.q[i] - input.q_measured[i];
      low = std::max(low, (-config_.lead[i] - ahead) / dt);
      high = std::min(high, (config_.lead[i] - ahead) / dt);
    }
    // A joint beyond a bound comes back as fast as it may; where bounds conflict the joint's own limit wins.
    const double speed = config_.speed[i];
    low = std::clamp(low, -speed, speed);
    high = std::clamp(high, -speed, speed);
    if (low > high) {
      const double limit_low = std::clamp((config_.lower[i] - input.q[i]) / dt, -speed, speed);
      const double limit_high = std::clamp((config_.upper[i] - input.q[i]) / dt, -speed, speed);
      low = high = std::clamp(0.5 * (low + high), std::min(limit_low, limit_high), std::max(limit_low, limit_high));
    }
    solver_.lower[i] = low;
    solver_.upper[i] = high;
  }
}

int ConstrainedMotion::set_rows(const ConstrainedMotionInput& input, Seconds dt) noexcept {
  if (input.rows == nullptr) {
    return 0;
  }
  int count = 0;
  for (const FixtureRow& row : *input.rows) {
    // What cannot be reached in this tick whatever the joints do is no row; the others keep their numbers near one.
    solver_.rows.row(count).noalias() = row.axis.transpose() * input.jacobian;
    const double reach = solver_.rows.row(count).cwiseAbs().dot(config_.speed.transpose()) * dt;
    if (row.lower_m < -reach && row.upper_m > reach) {
      continue;
    }
    const double recovery = config_.recovery_speed_m_s;
    solver_.row_lower[count] = std::min(row.lower_m / dt, recovery);
    solver_.row_upper[count] = std::max(row.upper_m / dt, -recovery);
    solver_.soft[count] = row.soft ? 1 : 0;
    row_fixture_[static_cast<std::size_t>(count)] = row.fixture;
    ++count;
  }
  return count;
}

MotionReason ConstrainedMotion::active_bound(const ConstrainedMotionInput& input, Seconds dt) const noexcept {
  const Eigen::VectorXd& rates = solver_.solution();
  MotionReason reason = MotionReason::kNone;
  for (Eigen::Index i = 0; i < joints(); ++i) {
    const double multiplier = solver_.multipliers()[i];
    if (multiplier == 0.0) {
      continue;
    }
    const double next = input.q[i] + dt * rates[i];
    const double limit = multiplier > 0.0 ? config_.upper[i] : config_.lower[i];
    if (std::abs(next - limit) <= 1e-9) {
      return MotionReason::kJointLimit;
    }
    const bool at_speed = std::abs(std::abs(rates[i]) - config_.speed[i]) <= 1e-9;
    reason = at_speed && reason == MotionReason::kNone ? MotionReason::kSpeedLimit
             : at_speed                                ? reason
                                                       : MotionReason::kLeadLimit;
  }
  return reason;
}

ConstrainedMotionOutput ConstrainedMotion::step(const ConstrainedMotionInput& input, Seconds dt) noexcept {
  ConstrainedMotionOutput output;
  output.q = input.q;
  output.rates = JointVector::Zero(joints());
  const auto hold = [&output](MotionReason reason, Status status) {
    output.reason = reason;
    output.status = status;
    return output;
  };
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    return hold(MotionReason::kInvalidTimeStep, Status::kInvalidTimeStep);
  }
  if (!is_valid(input)) {
    return hold(MotionReason::kInvalidInput, Status::kInvalidInput);
  }
  TipJacobian weighted = input.jacobian;
  weighted.bottomRows<3>() *= config_.rotation_weight_m;
  Vector6 wanted = to_vector(input.twist);
  wanted.tail<3>() *= config_.rotation_weight_m;
  const Eigen::Matrix<double, 6, 6> gram = weighted.lazyProduct(weighted.transpose());
  output.smallest_singular_value_m = smallest_singular_value(gram, joints());
  const double lost = std::max(0.0, 1.0 - output.smallest_singular_value_m / config_.singular_value_min_m);
  const double damping = config_.damping + lost * lost * (config_.damping_singular - config_.damping);
  solver_.hessian = weighted.transpose().lazyProduct(weighted);
  solver_.hessian.diagonal().array() += damping;
  solver_.gradient = -weighted.transpose().lazyProduct(wanted);
  const JointVector along = input.jacobian.topRows<3>().transpose().lazyProduct(input.first);
  const double more = config_.first_weight * config_.first_weight - 1.0;
  solver_.hessian += more * along.lazyProduct(along.transpose());
  solver_.gradient -= more * input.first.dot(input.twist.linear) * along;
  set_bounds(input, dt);
  const int count = set_rows(input, dt);
  const QpResult result = solver_.solve(count);
  output.kkt_residual = result.kkt_residual;
  if (result.status == QpStatus::kInvalidInput) {
    return hold(MotionReason::kInvalidInput, Status::kInvalidInput);
  }
  if (result.status == QpStatus::kInfeasible || result.status == QpStatus::kFailed) {
    double worst = 0.0;
    for (int i = 0; i < count; ++i) {
      const double violation = std::max(solver_.row_lower[i], -solver_.row_upper[i]);
      if (output.fixture < 0 || violation > worst) {
        worst = violation;
        output.fixture = row_fixture_[static_cast<std::size_t>(i)];
      }
    }
    const bool infeasible = result.status == QpStatus::kInfeasible;
    return hold(infeasible ? MotionReason::kInfeasible : MotionReason::kSolverFailed, Status::kInvalidInput);
  }
  output.rates = solver_.solution();
  output.q = input.q + dt * output.rates;
  const Vector6 twist = input.jacobian.lazyProduct(output.rates);
  output.twist = to_twist(twist);
  double most = 1e-9;
  for (int i = 0; i < count; ++i) {
    const double multiplier = std::abs(solver_.multipliers()[joints() + i]);
    if (multiplier > most) {
      most = multiplier;
      output.fixture = row_fixture_[static_cast<std::size_t>(i)];
    }
  }
  output.reason = output.fixture >= 0 ? MotionReason::kFixtureActive
                  : lost > 0.0        ? MotionReason::kNearSingular
                                      : active_bound(input, dt);
  output.status = output.reason == MotionReason::kNone ? Status::kOk : Status::kLimited;
  return output;
}

}  // namespace saras::csa
