#include "saras/model/cross_entropy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saras/spatial/errors.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using Eigen::VectorXd;
using test::kInf;
using test::kNan;

TEST(CrossEntropy, FindsTheMinimumOfACostWithManyValleys) {
  int found = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    CrossEntropyConfig config;
    config.seed = seed;
    config.candidates = 100;
    config.elites = 12;
    const VectorXd wide = VectorXd::Constant(3, 2.0);
    CrossEntropy search(config, VectorXd::Zero(3), wide, -3.0 * wide, 3.0 * wide);
    const Eigen::Vector3d truth(1.3, -0.7, 2.1);
    for (int round = 0; round < 60 && !search.settled(); ++round) {
      const Eigen::MatrixXd& candidates = search.ask();
      VectorXd costs(candidates.cols());
      for (Eigen::Index j = 0; j < candidates.cols(); ++j) {
        const Eigen::Vector3d off = candidates.col(j) - truth;
        costs[j] = off.squaredNorm() + 0.3 * (3.0 - (6.0 * off).array().cos().sum());
      }
      EXPECT_TRUE(search.tell(costs));
    }
    found += (search.best() - truth).norm() < 0.1 ? 1 : 0;
  }
  EXPECT_GE(found, 17);
}

TEST(CrossEntropy, CandidatesKeepToTheirBoundsAndARunRepeats) {
  const VectorXd one = VectorXd::Ones(4);
  CrossEntropy a({}, VectorXd::Zero(4), 5.0 * one, -one, one);
  CrossEntropy b = a;
  for (int round = 0; round < 10; ++round) {
    const Eigen::MatrixXd drawn = a.ask();
    EXPECT_LE(drawn.cwiseAbs().maxCoeff(), 1.0);
    EXPECT_EQ(drawn, b.ask());
    a.tell(drawn.colwise().sum().transpose());
    b.tell(drawn.colwise().sum().transpose());
  }
  EXPECT_LT(a.mean().sum(), -3.0);
}

TEST(CrossEntropy, CostsThatAreNoNumbersAreNoCandidates) {
  const VectorXd one = VectorXd::Ones(2);
  CrossEntropy search({}, VectorXd::Zero(2), one, -one, one);
  search.ask();
  VectorXd costs = VectorXd::Constant(search.ask().cols(), kNan);
  EXPECT_FALSE(search.tell(costs));
  EXPECT_EQ(search.best_cost(), kInf);
  EXPECT_EQ(search.mean(), VectorXd::Zero(2));
  costs[5] = 1.0;
  EXPECT_TRUE(search.tell(costs));
  EXPECT_EQ(search.best_cost(), 1.0);
  EXPECT_THROW(search.tell(VectorXd::Zero(3)), ConfigError);
  EXPECT_THROW(CrossEntropy({}, VectorXd::Zero(2), one, one, -one), ConfigError);
  EXPECT_THROW(CrossEntropy({}, VectorXd::Zero(2), VectorXd::Ones(3), -one, one), ConfigError);
}

}  // namespace
}  // namespace saras
