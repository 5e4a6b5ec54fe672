#include "saras/model/cross_entropy.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {

void CrossEntropyConfig::validate() const {
  validate::in_range("candidates", candidates, 2, 100'000);
  validate::in_range("elites", elites, 2, candidates);
  validate::positive("smoothing", smoothing);
  validate::in_range("smoothing", smoothing, 0.0, 1.0);
  validate::in_range("least_deviation", least_deviation, 0.0, 1.0);
}

CrossEntropy::CrossEntropy(CrossEntropyConfig config, const Eigen::VectorXd& mean, const Eigen::VectorXd& deviation,
                           const Eigen::VectorXd& low, const Eigen::VectorXd& high)
    : config_((config.validate(), config)),
      mean_(mean),
      first_deviation_(deviation),
      low_(low),
      high_(high),
      covariance_(deviation.cwiseAbs2().asDiagonal()),
      candidates_(mean.size(), config.candidates),
      best_(mean),
      random_(config.seed) {
  if (mean.size() == 0 || deviation.size() != mean.size() || low.size() != mean.size() || high.size() != mean.size()) {
    throw ConfigError("mean, deviation, low, high: " + std::to_string(mean.size()) + ", " +
                      std::to_string(deviation.size()) + ", " + std::to_string(low.size()) + ", " +
                      std::to_string(high.size()) + " numbers: must be as many, and not none");
  }
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    const std::string at = "[" + std::to_string(i) + "]";
    validate::finite(("mean" + at).c_str(), mean[i]);
    validate::positive(("deviation" + at).c_str(), deviation[i]);
    validate::less(("low" + at).c_str(), low[i], ("high" + at).c_str(), high[i]);
  }
}

const Eigen::MatrixXd& CrossEntropy::ask() {
  // A little is added so that a direction in which the elites agree keeps a factor.
  Eigen::MatrixXd covariance = covariance_;
  covariance.diagonal() += 1e-12 * first_deviation_.cwiseAbs2();
  const Eigen::MatrixXd factor = covariance.llt().matrixL();
  Eigen::VectorXd draw(mean_.size());
  for (Eigen::Index j = 0; j < candidates_.cols(); ++j) {
    for (double& number : draw) {
      number = j == 0 ? 0.0 : random_.normal();
    }
    candidates_.col(j) = (mean_ + factor * draw).cwiseMax(low_).cwiseMin(high_);
  }
  return candidates_;
}

bool CrossEntropy::tell(const Eigen::VectorXd& costs) {
  if (costs.size() != candidates_.cols()) {
    throw ConfigError("costs: " + std::to_string(costs.size()) + " numbers: must be " +
                      std::to_string(candidates_.cols()) + ", one a candidate");
  }
  std::vector<Eigen::Index> order;
  for (Eigen::Index j = 0; j < costs.size(); ++j) {
    if (std::isfinite(costs[j])) {
      order.push_back(j);
    }
  }
  ++rounds_;
  if (order.empty()) {
    return false;
  }
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return costs[a] < costs[b]; });
  if (costs[order.front()] < best_cost_) {
    best_cost_ = costs[order.front()];
    best_ = candidates_.col(order.front());
  }
  const auto elites = std::min<std::size_t>(order.size(), static_cast<std::size_t>(config_.elites));
  if (elites < 2) {
    return true;  // one point has no spread
  }
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(mean_.size());
  for (std::size_t i = 0; i < elites; ++i) {
    mean += candidates_.col(order[i]) / static_cast<double>(elites);
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(mean_.size(), mean_.size());
  for (std::size_t i = 0; i < elites; ++i) {
    const Eigen::VectorXd offset = candidates_.col(order[i]) - mean;
    covariance += offset * offset.transpose() / static_cast<double>(elites - 1);
  }
  mean_ += config_.smoothing * (mean - mean_);
  covariance_ += config_.smoothing * (covariance - covariance_);
  return true;
}

bool CrossEntropy::settled() const {
  return (covariance_.diagonal().array().sqrt() <= config_.least_deviation * first_deviation_.array()).all();
}

}  // namespace saras
