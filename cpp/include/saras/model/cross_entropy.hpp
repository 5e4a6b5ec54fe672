// Minimum of a cost over a vector by the cross-entropy method: ask for candidates, tell what they cost.
//
// Rubinstein and Kroese (2004); for trajectories of finitely many numbers Kobilarov (IJRR 2012). Candidates are drawn
// from a normal distribution, which is then fitted to the best of them; a share of the old distribution is kept, so
// that it does not collapse on chance. The cost is computed by whoever asks, in what language and at what pace he
// likes.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "saras/sim/random.hpp"

namespace saras {

struct CrossEntropyConfig {
  int candidates = 48;            ///< a round
  int elites = 8;                 ///< the best, to which the distribution is fitted
  double smoothing = 0.7;         ///< share of the new fit, 0 .. 1
  double least_deviation = 0.01;  ///< of each number, as a share of its first deviation: settled below it
  std::uint64_t seed = 1;
  void validate() const;  ///< throws ConfigError
};

class CrossEntropy {
 public:
  /// mean, deviation: of the first candidates; low, high: bounds that every candidate is clamped to. Throws
  /// ConfigError: other sizes, not finite, deviation <= 0, low >= high.
  CrossEntropy(CrossEntropyConfig config, const Eigen::VectorXd& mean, const Eigen::VectorXd& deviation,
               const Eigen::VectorXd& low, const Eigen::VectorXd& high);

  /// The next round's candidates, one a column; the first one is the mean.
  const Eigen::MatrixXd& ask();
  /// One cost a candidate; not finite: no candidate. False, and the distribution as it was: no finite one among them.
  bool tell(const Eigen::VectorXd& costs);

  /// The cheapest candidate so far, and its cost (infinite: none).
  const Eigen::VectorXd& best() const { return best_; }
  double best_cost() const { return best_cost_; }
  const Eigen::VectorXd& mean() const { return mean_; }
  /// Standard deviations of the numbers.
  Eigen::VectorXd deviation() const { return covariance_.diagonal().cwiseSqrt(); }
  int rounds() const { return rounds_; }
  /// Every deviation is below least_deviation of its first one.
  bool settled() const;

 private:
  CrossEntropyConfig config_;
  Eigen::VectorXd mean_;
  Eigen::VectorXd first_deviation_;
  Eigen::VectorXd low_;
  Eigen::VectorXd high_;
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd candidates_;
  Eigen::VectorXd best_;
  double best_cost_ = std::numeric_limits<double>::infinity();
  int rounds_ = 0;
  Random random_;
};

}  // namespace saras
