#include "saras/model/gp_learning.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "saras/model/model_error.hpp"
#include "saras/sim/random.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

/// Parameters of force, stiffness, bend, length and noise; then the damping itself, in units of its scale.
constexpr int kParameters = 6;
constexpr std::size_t kNoise = 4;
constexpr std::size_t kDamping = 5;
using Parameters = std::array<double, kParameters>;

/// What the likelihood needs of one neighbourhood: nothing of it changes with the hyper-parameters.
struct Neighbourhood {
  Eigen::MatrixXd across_squared;  ///< between each two samples [m^2]
  Eigen::MatrixXd depths;          ///< u u'
  Eigen::VectorXd forces;
  Eigen::VectorXd speeds;
  Eigen::VectorXd noise_shares;  ///< 1 / weight
};

Neighbourhood neighbourhood_of(const HashGrid& grid, const LocalModel& model) {
  const std::vector<int>& members = model.members();
  const auto count = static_cast<Eigen::Index>(members.size());
  Eigen::Matrix3Xd positions(3, count);
  Neighbourhood result{
      Eigen::MatrixXd(count, count), {}, Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const TouchSample& sample = grid.place(members[static_cast<std::size_t>(i)]);
    positions.col(i) = sample.position;
    result.speeds[i] = sample.speed_m_s;
    result.forces[i] = -sample.force.dot(model.normal());
    result.noise_shares[i] = 1.0 / sample.weight;
  }
  positions.colwise() -= positions.rowwise().mean().eval();
  const Eigen::VectorXd along = positions.transpose() * model.normal();
  positions -= model.normal() * along.transpose();
  for (Eigen::Index i = 0; i < count; ++i) {
    result.across_squared.col(i) = (positions.colwise() - positions.col(i)).colwise().squaredNorm().transpose();
  }
  result.depths = along * along.transpose();
  return result;
}

/// Log marginal likelihood, and its derivatives by the parameters added to `gradient`. False: no factor.
bool add_likelihood(const Neighbourhood& near, const Parameters& parameters, double damping_scale_s_m,
                    double& likelihood, double* gradient) {
  const auto squared = [&](std::size_t i) { return std::exp(2.0 * parameters[i]); };
  const double across = 1.0 / squared(3);
  const Eigen::MatrixXd envelope = (-0.5 * across * near.across_squared).array().exp().matrix();
  const std::array<Eigen::MatrixXd, 3> terms = {squared(0) * envelope, squared(1) * envelope.cwiseProduct(near.depths),
                                                squared(2) * envelope.cwiseProduct(near.depths.cwiseAbs2())};
  const Eigen::MatrixXd tissue = terms[0] + terms[1] + terms[2];
  Eigen::MatrixXd covariance = tissue;
  covariance.diagonal() += squared(kNoise) * near.noise_shares;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) {
    return false;
  }
  // What tissue at rest would have said, and how that moves with the damping; its Jacobian belongs to the likelihood.
  const Eigen::Index count = near.forces.size();
  Eigen::VectorXd values(count);
  Eigen::VectorXd by_damping(count);
  double jacobian = 0.0;
  double jacobian_by_damping = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double damping_s_m = parameters[kDamping] * damping_scale_s_m;
    const double share = damping_share(damping_s_m, near.speeds[i]);
    const bool bounded = share > 1.0 + damping_s_m * near.speeds[i];
    const double slope = bounded ? 0.0 : near.speeds[i] / share * damping_scale_s_m;
    values[i] = near.forces[i] / share;
    by_damping[i] = -values[i] * slope;
    jacobian -= std::log(share);
    jacobian_by_damping -= slope;
  }
  const Eigen::VectorXd weights = factor.solve(values);
  constexpr double kLogTwoPi = 1.8378770664093453;
  likelihood += jacobian - 0.5 * values.dot(weights) - factor.matrixLLT().diagonal().array().log().sum() -
                0.5 * kLogTwoPi * static_cast<double>(count);
  if (gradient != nullptr) {
    const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
    const Eigen::MatrixXd inner = weights * weights.transpose() - inverse;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      gradient[i] += inner.cwiseProduct(terms[i]).sum();
    }
    gradient[3] += 0.5 * across * inner.cwiseProduct(tissue).cwiseProduct(near.across_squared).sum();
    gradient[kNoise] += squared(kNoise) * inner.diagonal().dot(near.noise_shares);
    gradient[kDamping] += jacobian_by_damping - weights.dot(by_damping);
  }
  return true;
}

class NegativePosterior : public ceres::FirstOrderFunction {
 public:
  NegativePosterior(const std::vector<Neighbourhood>& near, const Parameters& start, double damping_scale_s_m,
                    double log_std)
      : near_(near), start_(start), damping_scale_s_m_(damping_scale_s_m), precision_(1.0 / (log_std * log_std)) {}

  bool Evaluate(const double* at, double* cost, double* gradient) const override {
    Parameters parameters{};
    std::copy_n(at, kParameters, parameters.begin());
    Parameters slope{};
    double likelihood = 0.0;
    for (const Neighbourhood& one : near_) {
      if (!add_likelihood(one, parameters, damping_scale_s_m_, likelihood,
                          gradient != nullptr ? slope.data() : nullptr)) {
        return false;
      }
    }
    for (std::size_t i = 0; i < kParameters; ++i) {
      const double off = parameters[i] - start_[i];
      const double precision = i == kDamping ? 1.0 : precision_;
      likelihood -= 0.5 * precision * off * off;
      if (gradient != nullptr) {
        gradient[i] = -(slope[i] - precision * off);
      }
    }
    *cost = -likelihood;
    return std::isfinite(likelihood);
  }
  int NumParameters() const override { return kParameters; }

 private:
  const std::vector<Neighbourhood>& near_;
  Parameters start_;
  double damping_scale_s_m_;
  double precision_;
};

double likelihood_of(const std::vector<Neighbourhood>& near, const Parameters& parameters, double damping_scale_s_m) {
  double likelihood = 0.0;
  for (const Neighbourhood& one : near) {
    add_likelihood(one, parameters, damping_scale_s_m, likelihood, nullptr);
  }
  return likelihood;
}

/// Standard deviation of the damping at the optimum (Laplace), in units of its scale.
double damping_deviation(const NegativePosterior& posterior, const Parameters& found) {
  constexpr double kStep = 1e-4;
  double cost = 0.0;
  Parameters at = found;
  Parameters above{};
  Parameters below{};
  at[kDamping] = found[kDamping] + kStep;
  const bool first = posterior.Evaluate(at.data(), &cost, above.data());
  at[kDamping] = found[kDamping] - kStep;
  const bool second = posterior.Evaluate(at.data(), &cost, below.data());
  const double curvature = (above[kDamping] - below[kDamping]) / (2.0 * kStep);
  return first && second && curvature > 1.0 ? 1.0 / std::sqrt(curvature) : 1.0;
}

}  // namespace

void GpLearningOptions::validate() const {
  validate::in_range("neighbourhoods", neighbourhoods, 1, 10'000);
  validate::positive("prior_log_std", prior_log_std);
  validate::in_range("max_iterations", max_iterations, 1, 10'000);
}

GpLearning learn_hyperparameters(const HashGrid& grid, const LocalModelConfig& config,
                                 const GpLearningOptions& options) {
  options.validate();
  LocalModel model(config, grid.config());
  const std::vector<int> places = grid.used();
  std::vector<Neighbourhood> near;
  GpLearning result;
  Random random(options.seed);
  for (int i = 0; i < options.neighbourhoods && !places.empty(); ++i) {
    const auto drawn = static_cast<std::size_t>(random.uniform() * static_cast<double>(places.size()));
    if (model.build(grid, grid.place(places[drawn]).position)) {
      near.push_back(neighbourhood_of(grid, model));
      result.samples += static_cast<int>(near.back().forces.size());
    }
  }
  if (near.empty()) {
    throw ModelError("samples: " + std::to_string(places.size()) + " places: no neighbourhood of radius_m = " +
                     std::to_string(config.radius_m) + " holds min_samples = " + std::to_string(config.min_samples));
  }
  // A scale of zero stays zero: its logarithm is far below, where nothing pulls.
  const GpHyperparameters& from = config.hyperparameters;
  constexpr double kNothing = 1e-12;
  const double scale_s_m = std::max(kNothing, from.damping_scale_s_m);
  const Parameters start = {std::log(from.force_scale_N),
                            std::log(from.stiffness_scale_N_m),
                            std::log(std::max(kNothing, from.bend_scale_N_m2)),
                            std::log(from.tangential_length_m),
                            std::log(from.noise_N),
                            from.damping_s_m / scale_s_m};
  Parameters found = start;
  auto* posterior = new NegativePosterior(near, start, scale_s_m, options.prior_log_std);
  const ceres::GradientProblem problem(posterior);  // owns it
  ceres::GradientProblemSolver::Options solver;
  solver.line_search_direction_type = ceres::LBFGS;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = 1e-7;
  solver.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(solver, problem, found.data(), &summary);
  result.hyperparameters = {std::exp(found[0]),
                            std::exp(found[1]),
                            std::exp(found[2]),
                            std::exp(found[3]),
                            std::max(0.0, found[kDamping] * scale_s_m),
                            damping_deviation(*posterior, found) * scale_s_m,
                            std::exp(found[kNoise])};
  result.hyperparameters.validate();
  result.log_likelihood_before = likelihood_of(near, start, scale_s_m);
  result.log_likelihood = likelihood_of(near, found, scale_s_m);
  result.neighbourhoods = static_cast<int>(near.size());
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  return result;
}

}  // namespace saras
