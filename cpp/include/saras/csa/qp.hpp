// Small dense quadratic programmes: DAQP (third_party/daqp) behind our types, memory taken once.
#pragma once

#include <cstdint>
#include <memory>

#include "saras/spatial/types.hpp"

namespace saras::csa {

enum class QpStatus : std::uint8_t {
  kSolved = 0,
  kSoftened,      ///< solved, with at least one soft row violated
  kInfeasible,    ///< no point obeys all hard rows
  kInvalidInput,  ///< a number is not finite (bounds may be infinite), or the rows do not fit
  kFailed,        ///< no solution of the asked accuracy: treat it as infeasible
};
/// Upper-case name.
const char* to_string(QpStatus status) noexcept;

struct QpResult {
  QpStatus status = QpStatus::kInvalidInput;
  int iterations = 0;
  double kkt_residual = 0.0;  ///< largest of stationarity, violation of hard rows, complementarity; scaled as below
  double slack = 0.0;         ///< largest violation of a soft row [units of the row]
};

/// minimise 1/2 x'Hx + g'x   subject to   lower <= x <= upper,  row_lower <= A x <= row_upper
///
/// H symmetric positive definite. Bounds may be infinite. A row is soft when soft[i] is not 0: its violation s costs
/// soft_weight s^2 / 2. A solution is only called solved when its KKT residual, with stationarity divided by
/// max(1, |g|, |Hx|) and rows by max(1, |bound|), is at most kkt_tolerance.
class QpSolver {
 public:
  /// Throws ConfigError unless 1 <= variables <= 200, 0 <= rows_max <= 2000.
  QpSolver(int variables, int rows_max, double soft_weight = 1e6);
  /// Copies the problem and its solution; the copy has a workspace of its own.
  QpSolver(const QpSolver& other);
  QpSolver& operator=(const QpSolver& other);
  QpSolver(QpSolver&&) noexcept;
  QpSolver& operator=(QpSolver&&) noexcept;
  ~QpSolver();

  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd hessian;    ///< (n, n)
  Eigen::VectorXd gradient;   ///< (n,)
  Eigen::VectorXd lower;      ///< (n,)
  Eigen::VectorXd upper;      ///< (n,)
  RowMajor rows;              ///< (rows_max, n); the first `count` are read
  Eigen::VectorXd row_lower;  ///< (rows_max,)
  Eigen::VectorXd row_upper;  ///< (rows_max,)
  Eigen::VectorXi soft;       ///< (rows_max,) 0 or 1

  /// Solves with the first `count` rows, from an empty working set: the same problem gives the same bits, whatever was
  /// solved before. Allocates nothing.
  QpResult solve(int count) noexcept;
  /// (n,) of the last solve that said solved or softened.
  const Eigen::VectorXd& solution() const { return solution_; }
  /// (n + rows_max,) first bounds, then rows; positive at an upper bound, negative at a lower one:
  /// Hx + g + multipliers_bounds + A' multipliers_rows = 0.
  const Eigen::VectorXd& multipliers() const { return multipliers_; }
  int variables() const { return static_cast<int>(gradient.size()); }
  int rows_max() const { return static_cast<int>(row_lower.size()); }

  static constexpr double kkt_tolerance = 1e-8;

 private:
  bool is_valid(int count) const noexcept;
  double kkt_residual(int count, double& slack) noexcept;

  struct Workspace;
  double soft_weight_;
  Eigen::VectorXd solution_;
  Eigen::VectorXd multipliers_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace saras::csa
