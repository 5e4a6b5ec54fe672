// Gaussian process of the normal force near a point, grown and shrunk one sample at a time.
//
// Pressed tissue answers with f = K(s) (h(s) - u): s across the surface, u along the normal, K stiffness, h height of
// the surface; K and h change smoothly with s. Quasi-static palpation adds a part in step with the power that goes in
// (Hunt-Crossley damping). So the prior is a polynomial in u whose coefficients are Gaussian processes over s:
//
//   k = exp(-|s - s'|^2 / 2 l^2) (force^2 + stiffness^2 u u' + bend^2 u^2 u'^2) + damping_scale^2 P P'
//
// with P the power (force times speed of pressing), zero where something is asked for: the answer is of tissue at rest,
// and what cannot be told from damping is in the variance. The mean is zero: with a polynomial the force extrapolates
// to where it vanishes, which a stationary kernel does not. Rasmussen and Williams (2006), chapters 2, 2.7 and 9.4
// (derivatives). The Cholesky factor follows the samples: O(n^2) for each that comes or goes (Seeger 2004), never
// O(n^3).
#pragma once

#include <cstdint>

#include "saras/spatial/types.hpp"

namespace saras {

struct GpHyperparameters {
  double force_scale_N = 1.0;           ///< of the force in the middle of the samples [N]
  double stiffness_scale_N_m = 1000.0;  ///< of the stiffness [N/m]
  double bend_scale_N_m2 = 2e4;         ///< of half the second derivative of the force over depth [N/m^2]
  double tangential_length_m = 6e-3;    ///< over which the tissue changes along its surface [m]
  double damping_s_m = 0.0;             ///< share of the force that goes with the speed of pressing [s/m]
  double damping_scale_s_m = 15.0;      ///< standard deviation of damping_s_m
  double noise_N = 0.05;                ///< standard deviation of one sample's error, all other causes [N]
  void validate() const;                ///< throws ConfigError
};

/// What one sample says: the force at a place, and the power that went in there (0: not known, or slow).
struct GpSample {
  Vector3 position = Vector3::Zero();  ///< [m]
  double power_W = 0.0;                ///< force . velocity of the tip
  double value_N = 0.0;                ///< normal force, pressing > 0
  double noise_variance_N2 = 0.0;
};

/// Posterior of the force of tissue at rest, and of its gradient, at one point.
struct GpPrediction {
  double mean = 0.0;                                              ///< [N]
  double variance = 0.0;                                          ///< without the noise of a sample [N^2]
  Vector3 gradient = Vector3::Zero();                             ///< [N/m]
  Eigen::Matrix3d gradient_covariance = Eigen::Matrix3d::Zero();  ///< [N^2/m^2]
};

class LocalGp {
 public:
  /// Allocates all it will ever use. Throws ConfigError (capacity outside 1..512).
  explicit LocalGp(int capacity = 64, GpHyperparameters hyperparameters = {});

  /// Empties it. origin: where u is zero, in the middle of the samples to come; normal: outward unit vector.
  void restart(const Vector3& origin, const Vector3& normal) noexcept;
  /// Other hyper-parameters; empties it. Throws ConfigError.
  void adopt(const GpHyperparameters& hyperparameters);
  /// False, and nothing changed: full, or a number that no factor can be made with. Allocates nothing.
  bool append(const GpSample& sample) noexcept;
  void remove(int i) noexcept;

  int size() const { return size_; }
  int capacity() const { return capacity_; }
  const Vector3& normal() const { return normal_; }
  /// Of the i-th sample.
  Vector3 position(int i) const;

  struct MeanAndSlope {
    double mean;   ///< [N]
    double slope;  ///< along the normal [N/m]
  };
  /// Without variances, in O(n).
  MeanAndSlope mean_and_slope(const Vector3& at) const noexcept;
  /// power_W: 0 for tissue at rest; that of a sample for what it should have said (mean and variance).
  GpPrediction predict(const Vector3& at, double power_W = 0.0) const noexcept;
  double log_marginal_likelihood() const noexcept;
  const GpHyperparameters& hyperparameters() const { return hyperparameters_; }
  /// Covariances and multiplications so far: what the time of a step is bounded by.
  std::uint64_t work() const { return work_; }

 private:
  /// s / l and u.
  Vector3 local(const Vector3& position) const noexcept;
  /// Covariances with the point into the first column of the workspace; the next three are left alone.
  void covariances(const Vector3& point, double power_W) const noexcept;
  double polynomial(double u, double v) const noexcept;
  void forward(int columns) const noexcept;
  void whiten(int from) noexcept;
  void solve_weights() const noexcept;

  int capacity_;
  GpHyperparameters hyperparameters_;
  double force_variance_ = 0.0;
  double stiffness_variance_ = 0.0;
  double bend_variance_ = 0.0;
  double damping_variance_ = 0.0;
  int size_ = 0;
  Vector3 origin_ = Vector3::Zero();
  Vector3 normal_ = Vector3::UnitZ();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  ///< rows: unit vectors of the local axes in the base
  Eigen::Matrix3Xd points_;
  Eigen::VectorXd powers_;
  Eigen::VectorXd values_;
  Eigen::MatrixXd factor_;           ///< lower triangle
  Eigen::VectorXd whitened_;         ///< factor^-1 values
  mutable Eigen::VectorXd weights_;  ///< covariance^-1 values, made when mean_and_slope() asks
  mutable bool weights_made_ = false;
  mutable Eigen::MatrixXd columns_;  ///< covariance with a point, and its three derivatives
  mutable std::uint64_t work_ = 0;
};

}  // namespace saras
