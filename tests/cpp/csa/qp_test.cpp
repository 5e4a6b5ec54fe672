// Copies, sizes and refusals. The answers themselves are held against other solvers in tests/property/test_csa_qp.py.
#include "saras/csa/qp.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"

namespace saras::csa {
namespace {

QpSolver triangle() {
  QpSolver solver(2, 3);
  solver.gradient << -2.0, -1.0;
  solver.rows.row(0) << 1.0, 1.0;
  solver.row_upper[0] = 1.0;
  return solver;
}

TEST(QpSolver, SolvesAndCopies) {
  QpSolver solver = triangle();
  ASSERT_EQ(solver.solve(1).status, QpStatus::kSolved);
  EXPECT_TRUE(solver.solution().isApprox(Eigen::Vector2d(1.0, 0.0), 1e-12));  // projected on x + y = 1
  EXPECT_NEAR(solver.multipliers()[2], 1.0, 1e-12);
  QpSolver copy = solver;
  copy.gradient.setZero();
  ASSERT_EQ(copy.solve(1).status, QpStatus::kSolved);
  EXPECT_TRUE(copy.solution().isZero());
  EXPECT_TRUE(solver.solution().isApprox(Eigen::Vector2d(1.0, 0.0), 1e-12));
  solver = copy;
  ASSERT_EQ(solver.solve(0).status, QpStatus::kSolved);
}

TEST(QpSolver, RefusesWhatDoesNotFit) {
  EXPECT_THROW(QpSolver(0, 3), ConfigError);
  EXPECT_THROW(QpSolver(7, -1), ConfigError);
  EXPECT_THROW(QpSolver(7, 3, 0.0), ConfigError);
  QpSolver solver = triangle();
  EXPECT_EQ(solver.solve(4).status, QpStatus::kInvalidInput);
  EXPECT_EQ(solver.solve(-1).status, QpStatus::kInvalidInput);
}

}  // namespace
}  // namespace saras::csa
