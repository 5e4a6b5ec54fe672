// Levels of noise by restricted maximum likelihood, and the covariance of the result.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "hand_eye_parts.hpp"

namespace saras::hand_eye_parts {
namespace {

/// Pseudo-observations at the expected levels: three pairs leave next to nothing to estimate them from.
constexpr double kPriorFreedom = 2.0;
constexpr double kLeastLevel = 1e-10;

Information normal_matrix(const std::vector<Jacobian>& jacobians, const std::vector<Matrix6>& weights,
                          const std::vector<bool>& used, bool time_offset) {
  Information normal = Information::Zero();
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) {
      normal += jacobians[i].transpose() * weights[i] * jacobians[i];
    }
  }
  if (!time_offset) {
    normal(kParameters - 1, kParameters - 1) = 1.0;  // its column is zero: any value keeps it apart
  }
  return normal;
}

}  // namespace

// With P = W - W J (JᵀWJ)⁻¹ JᵀW, W = V⁻¹, V = Σ level_k V_k: Fisher's scoring solves
// ½ tr(P V_k P V_l) level_l = ½ rᵀ P V_k P r. At the optimum JᵀW r = 0, hence P r = W r. All sums run over 6x6 blocks.
Levels next_levels(const std::vector<Vector6>& residuals, const std::vector<Jacobian>& jacobians,
                   const std::vector<NoiseParts>& parts, const std::vector<bool>& used, const Levels& levels,
                   bool time_offset) {
  const std::size_t n = residuals.size();
  std::vector<Matrix6> weights(n);
  for (std::size_t i = 0; i < n; ++i) {
    weights[i] = (levels.rotation * parts[i].rotation + levels.translation * parts[i].translation).inverse();
  }
  const Information inverse = normal_matrix(jacobians, weights, used, time_offset).inverse();
  Eigen::Matrix2d fisher = Eigen::Matrix2d::Zero();
  Eigen::Vector2d score = Eigen::Vector2d::Zero();
  std::array<Information, 2> projected = {Information::Zero(), Information::Zero()};
  std::array<std::array<Information, 2>, 2> twice{};
  for (auto& row : twice) {
    row.fill(Information::Zero());
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!used[i]) {
      continue;
    }
    const std::array<Matrix6, 2> v = {levels.rotation * parts[i].rotation, levels.translation * parts[i].translation};
    const Vector6 pulled = weights[i] * residuals[i];
    const Jacobian u = weights[i] * jacobians[i];
    for (int k = 0; k < 2; ++k) {
      score[k] += 0.5 * pulled.dot(v[k] * pulled);
      projected[k] += u.transpose() * v[k] * u;
      for (int l = 0; l < 2; ++l) {
        fisher(k, l) += 0.5 * (weights[i] * v[k] * weights[i] * v[l]).trace();
        twice[k][l] += u.transpose() * v[k] * weights[i] * v[l] * u;
      }
    }
  }
  for (int k = 0; k < 2; ++k) {
    for (int l = 0; l < 2; ++l) {
      fisher(k, l) +=
          -(inverse * twice[k][l]).trace() + 0.5 * (inverse * projected[k] * inverse * projected[l]).trace();
    }
  }
  const std::array<double, 2> now = {levels.rotation, levels.translation};
  for (int k = 0; k < 2; ++k) {
    fisher(k, k) += 0.5 * kPriorFreedom;
    score[k] += 0.5 * kPriorFreedom / now[static_cast<std::size_t>(k)];
  }
  const Eigen::Vector2d factor = fisher.ldlt().solve(score);
  const auto bounded = [](double level, double by) {
    return std::max(kLeastLevel, level * std::clamp(by, 0.05, 20.0));
  };
  return {bounded(levels.rotation, factor[0]), bounded(levels.translation, factor[1])};
}

Information parameter_covariance(const std::vector<HandEyePair>& pairs, const std::vector<Vector6>& residuals,
                                 const std::vector<Jacobian>& jacobians, const std::vector<Matrix6>& covariances,
                                 const std::vector<bool>& used, const HandEyeOptions& options) {
  std::vector<Matrix6> weights;
  weights.reserve(covariances.size());
  for (const auto& covariance : covariances) {
    weights.push_back(covariance.inverse());
  }
  const Information inverse = normal_matrix(jacobians, weights, used, options.time_offset).inverse();
  const double freedom = 6.0 * static_cast<double>(std::count(used.begin(), used.end(), true)) -
                         (options.time_offset ? kParameters : kParameters - 1) + kPriorFreedom;
  if (!options.grouped) {
    // The two levels are estimates themselves, each from about half of the freedom. So that the ellipsoid of
    // chi-squared still holds 95 %, it grows as Hotelling's does: 6 F(0.95; 6, f) is 12.59 (1 + 4.6 / f) within 2 % for
    // f >= 15.
    return inverse * (1.0 + 4.6 / (0.5 * freedom));
  }
  // Jackknife over the groups: what leaving one out changes, to first order. The plain sum of the groups' pulls would
  // be far too small where the groups are hardly more than the parameters.
  struct Group {
    Eigen::Matrix<double, kParameters, 1> pull = Eigen::Matrix<double, kParameters, 1>::Zero();
    Information information = Information::Zero();
  };
  std::map<int, Group> groups;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (used[i]) {
      Group& group = groups[pairs[i].group];
      group.pull += jacobians[i].transpose() * weights[i] * residuals[i];
      group.information += jacobians[i].transpose() * weights[i] * jacobians[i];
    }
  }
  const Information all = inverse.inverse();
  Information spread = Information::Zero();
  for (const auto& [number, group] : groups) {
    const Eigen::Matrix<double, kParameters, 1> change = (all - group.information).ldlt().solve(group.pull);
    spread += change * change.transpose();
  }
  const auto count = static_cast<double>(groups.size());
  return spread * ((count - 1.0) / count);
}

}  // namespace saras::hand_eye_parts
