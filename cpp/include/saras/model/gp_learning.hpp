// Hyper-parameters of the tissue's Gaussian processes from the samples themselves. Takes tenths of a second: never on
// the control thread. Needs Ceres.
#pragma once

#include <cstdint>

#include "saras/model/hash_grid.hpp"
#include "saras/model/local_model.hpp"

namespace saras {

struct GpLearningOptions {
  int neighbourhoods = 24;  ///< drawn among the places
  double prior_log_std =
      1.0;  ///< of each hyper-parameter's logarithm about where it starts: keeps sane what data leave open
  int max_iterations = 60;
  std::uint64_t seed = 1;
  void validate() const;  ///< throws ConfigError
};

struct GpLearning {
  GpHyperparameters hyperparameters;
  double log_likelihood_before = 0.0;  ///< of all neighbourhoods together, without the prior
  double log_likelihood = 0.0;
  int neighbourhoods = 0;
  int samples = 0;  ///< places used, with repetition
  bool converged = false;
};

/// Maximum a posteriori over the sum of the neighbourhoods' log marginal likelihoods (Rasmussen and Williams 2006, eq.
/// 5.8 and 5.9), by L-BFGS over logarithms, from config.hyperparameters. Throws ModelError when no neighbourhood holds
/// min_samples places.
GpLearning learn_hyperparameters(const HashGrid& grid, const LocalModelConfig& config,
                                 const GpLearningOptions& options = {});

}  // namespace saras
