#include "saras/csa/qp.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

extern "C" {
#include "api.h"
#include "utils.h"
}

namespace saras::csa {
namespace {

constexpr int kMaxVariables = 200;
constexpr int kMaxRows = 2000;
constexpr double kInfinity = 1e30;  // DAQP's

double finite_bound(double bound) { return std::clamp(bound, -kInfinity, kInfinity); }

}  // namespace

const char* to_string(QpStatus status) noexcept {
  switch (status) {
    case QpStatus::kSolved:
      return "SOLVED";
    case QpStatus::kSoftened:
      return "SOFTENED";
    case QpStatus::kInfeasible:
      return "INFEASIBLE";
    case QpStatus::kInvalidInput:
      return "INVALID_INPUT";
    case QpStatus::kFailed:
      return "FAILED";
  }
  return "UNKNOWN";
}

/// What DAQP reads and writes, in the sizes of the largest problem.
struct QpSolver::Workspace {
  DAQPWorkspace daqp{};
  DAQPProblem problem{};
  DAQPResult result{};
  RowMajor hessian;
  Eigen::VectorXd upper, lower, x, multipliers, stationarity;
  Eigen::VectorXi sense;

  Workspace(int n, int rows, double soft_weight)
      : hessian(RowMajor::Identity(n, n)),
        upper(Eigen::VectorXd::Constant(n + rows, kInfinity)),
        lower(-upper),
        x(n),
        multipliers(n + rows),
        stationarity(n),
        sense(Eigen::VectorXi::Zero(n + rows)),
        zero_rows_(RowMajor::Zero(std::max(rows, 1), n)),
        zero_gradient_(Eigen::VectorXd::Zero(n)) {
    // Set up with every row soft: DAQP sizes its factors by their number.
    sense.tail(rows).setConstant(DAQP_SOFT);
    describe(rows, zero_gradient_, zero_rows_);
    result.x = x.data();
    result.lam = multipliers.data();
    allocate_daqp_settings(&daqp);
    daqp.settings->primal_tol = 1e-10;
    daqp.settings->iter_limit = 1000;
    daqp.settings->eq_reduction = DAQP_EQ_REDUCTION_OFF;  // it would allocate
    daqp.settings->rho_soft = 1.0 / soft_weight;
    setup_daqp(&problem, &daqp, nullptr);
  }
  ~Workspace() {
    free_daqp_workspace(&daqp);
    free_daqp_ldp(&daqp);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  void describe(int rows, Eigen::VectorXd& gradient, RowMajor& matrix) {
    const int n = static_cast<int>(hessian.rows());
    problem.n = n;
    problem.m = n + rows;
    problem.ms = n;
    problem.H = hessian.data();
    problem.f = gradient.data();
    problem.A = matrix.data();
    problem.bupper = upper.data();
    problem.blower = lower.data();
    problem.sense = sense.data();
  }

 private:
  RowMajor zero_rows_;
  Eigen::VectorXd zero_gradient_;
};

QpSolver::QpSolver(int variables, int rows_max, double soft_weight) : soft_weight_(soft_weight) {
  validate::in_range("variables", variables, 1, kMaxVariables);
  validate::in_range("rows_max", rows_max, 0, kMaxRows);
  validate::positive("soft_weight", soft_weight);
  hessian = Eigen::MatrixXd::Identity(variables, variables);
  gradient = Eigen::VectorXd::Zero(variables);
  lower = Eigen::VectorXd::Constant(variables, -std::numeric_limits<double>::infinity());
  upper = -lower;
  rows = RowMajor::Zero(rows_max, variables);
  row_lower = Eigen::VectorXd::Constant(rows_max, -std::numeric_limits<double>::infinity());
  row_upper = -row_lower;
  soft = Eigen::VectorXi::Zero(rows_max);
  solution_ = Eigen::VectorXd::Zero(variables);
  multipliers_ = Eigen::VectorXd::Zero(variables + rows_max);
  workspace_ = std::make_unique<Workspace>(variables, rows_max, soft_weight);
}

QpSolver::QpSolver(const QpSolver& other)
    : hessian(other.hessian),
      gradient(other.gradient),
      lower(other.lower),
      upper(other.upper),
      rows(other.rows),
      row_lower(other.row_lower),
      row_upper(other.row_upper),
      soft(other.soft),
      soft_weight_(other.soft_weight_),
      solution_(other.solution_),
      multipliers_(other.multipliers_),
      workspace_(std::make_unique<Workspace>(other.variables(), other.rows_max(), other.soft_weight_)) {}
QpSolver& QpSolver::operator=(const QpSolver& other) {
  if (this != &other) {
    *this = QpSolver(other);
  }
  return *this;
}
QpSolver::QpSolver(QpSolver&&) noexcept = default;
QpSolver& QpSolver::operator=(QpSolver&&) noexcept = default;
QpSolver::~QpSolver() = default;

bool QpSolver::is_valid(int count) const noexcept {
  if (count < 0 || count > rows_max() || !hessian.allFinite() || !gradient.allFinite() ||
      !rows.topRows(count).allFinite()) {
    return false;
  }
  const auto no_nan = [](const auto& bounds) { return (bounds.array() == bounds.array()).all(); };
  return no_nan(lower) && no_nan(upper) && no_nan(row_lower.head(count)) && no_nan(row_upper.head(count));
}

QpResult QpSolver::solve(int count) noexcept {
  QpResult result;
  if (!is_valid(count)) {
    return result;
  }
  Workspace& work = *workspace_;
  const int n = variables();
  work.hessian = hessian;
  for (int i = 0; i < n; ++i) {
    work.lower[i] = finite_bound(lower[i]);
    work.upper[i] = finite_bound(upper[i]);
    work.sense[i] = 0;
  }
  for (int i = 0; i < count; ++i) {
    work.lower[n + i] = finite_bound(row_lower[i]);
    work.upper[n + i] = finite_bound(row_upper[i]);
    work.sense[n + i] = soft[i] != 0 ? DAQP_SOFT : 0;
    // Crossing soft bounds have no answer in the solver: hold the middle.
    if (soft[i] != 0 && work.lower[n + i] > work.upper[n + i]) {
      work.lower[n + i] = work.upper[n + i] = 0.5 * (work.lower[n + i] + work.upper[n + i]);
    }
  }
  work.describe(count, gradient, rows);
  reset_daqp_workspace(&work.daqp);
  const int updated = daqp_update_ldp(
      DAQP_UPDATE_Rinv | DAQP_UPDATE_M | DAQP_UPDATE_v | DAQP_UPDATE_d | DAQP_UPDATE_sense, &work.daqp, &work.problem);
  if (updated >= 0) {
    daqp_solve(&work.result, &work.daqp);
  } else {
    work.result.exitflag = updated;
    work.result.iter = 0;
  }
  result.iterations = work.result.iter;
  if (work.result.exitflag <= 0) {
    const bool infeasible =
        work.result.exitflag == DAQP_EXIT_INFEASIBLE || work.result.exitflag == DAQP_EXIT_OVERDETERMINED_INITIAL;
    result.status = infeasible ? QpStatus::kInfeasible : QpStatus::kFailed;
    return result;
  }
  if ((work.daqp.state & DAQP_STATE_UNCONSTRAINED) != 0) {
    work.multipliers.setZero();  // DAQP leaves them untouched
  }
  result.kkt_residual = kkt_residual(count, result.slack);
  if (!(result.kkt_residual <= kkt_tolerance)) {
    result.status = QpStatus::kFailed;
    return result;
  }
  solution_ = work.x;
  multipliers_.head(n + count) = work.multipliers.head(n + count);
  multipliers_.tail(rows_max() - count).setZero();
  result.status = result.slack > kkt_tolerance ? QpStatus::kSoftened : QpStatus::kSolved;
  return result;
}

double QpSolver::kkt_residual(int count, double& slack) noexcept {
  Workspace& work = *workspace_;
  const int n = variables();
  work.stationarity.noalias() = hessian * work.x;
  const double scale = std::max({1.0, work.stationarity.lpNorm<Eigen::Infinity>(), gradient.lpNorm<Eigen::Infinity>()});
  work.stationarity += gradient;
  work.stationarity += work.multipliers.head(n);
  double worst = 0.0;
  slack = 0.0;
  for (int i = 0; i < n + count; ++i) {
    const bool is_soft = i >= n && soft[i - n] != 0;
    const double value = i < n ? work.x[i] : rows.row(i - n).dot(work.x);
    if (i >= n) {
      work.stationarity += work.multipliers[i] * rows.row(i - n).transpose();
    }
    const double below = work.lower[i] - value;
    const double above = value - work.upper[i];
    const double violation = std::max({0.0, below, above});
    if (is_soft) {
      slack = std::max(slack, violation);
      continue;
    }
    const double bound = above > below ? work.upper[i] : work.lower[i];
    worst = std::max(worst, violation / std::max(1.0, std::abs(bound)));
    // A multiplier acts only at its own bound.
    const double gap = work.multipliers[i] > 0.0 ? above : work.multipliers[i] < 0.0 ? below : 0.0;
    const double size = std::max(1.0, std::abs(work.multipliers[i])) * std::max(1.0, std::abs(bound));
    worst = std::max(worst, std::abs(work.multipliers[i] * gap) / size);
  }
  return std::max(worst, work.stationarity.lpNorm<Eigen::Infinity>() / scale);
}

}  // namespace saras::csa
