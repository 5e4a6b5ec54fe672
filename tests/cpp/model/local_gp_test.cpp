#include "saras/model/local_gp.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "saras/spatial/errors.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using test::kNan;
using test::RandomValues;

GpSample sample(RandomValues& random) {
  return {random.vector(5e-3), random.uniform(-0.02, 0.02), random.uniform(-1.0, 3.0), random.uniform(1e-5, 1e-2)};
}

/// The textbook's formulas with a dense inverse, over samples in any order.
double mean_by_inverse(const GpHyperparameters& h, const Vector3& origin, const Vector3& normal,
                       const std::vector<GpSample>& samples, const Vector3& at, double& variance) {
  const auto kernel = [&](const Vector3& a, double power_a, const Vector3& b, double power_b) {
    const double u = (a - origin).dot(normal);
    const double v = (b - origin).dot(normal);
    const Vector3 across = (a - b) - normal * normal.dot(a - b);
    const auto squared = [](double x) { return x * x; };
    return std::exp(-0.5 * across.squaredNorm() / squared(h.tangential_length_m)) *
               (squared(h.force_scale_N) + squared(h.stiffness_scale_N_m) * u * v +
                squared(h.bend_scale_N_m2) * squared(u * v)) +
           squared(h.damping_scale_s_m) * power_a * power_b;
  };
  const auto n = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd covariance(n, n);
  Eigen::VectorXd with(n);
  Eigen::VectorXd values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const GpSample& a = samples[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) {
      const GpSample& b = samples[static_cast<std::size_t>(j)];
      covariance(i, j) = kernel(a.position, a.power_W, b.position, b.power_W) + (i == j ? a.noise_variance_N2 : 0.0);
    }
    with[i] = kernel(a.position, a.power_W, at, 0.0);
    values[i] = a.value_N;
  }
  const Eigen::VectorXd weights = covariance.fullPivLu().solve(with);
  variance = kernel(at, 0.0, at, 0.0) - weights.dot(with);
  return weights.dot(values);
}

TEST(LocalGp, AfterAnyComingAndGoingItIsTheProcessOfWhatIsThere) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomValues random(seed);
    GpHyperparameters hyperparameters;
    hyperparameters.tangential_length_m = random.uniform(2e-3, 2e-2);
    hyperparameters.damping_scale_s_m = random.chance(0.5) ? 0.0 : 10.0;
    LocalGp process(24, hyperparameters);
    const Vector3 origin = random.vector(1e-3);
    const Vector3 normal = random.rotation() * Vector3::UnitZ();
    process.restart(origin, normal);
    std::vector<GpSample> samples;
    for (int i = 0; i < 300; ++i) {
      if (process.size() == process.capacity() || (process.size() > 1 && random.chance(0.45))) {
        const int gone = static_cast<int>(random.uniform(0.0, process.size() - 1e-9));
        process.remove(gone);
        samples.erase(samples.begin() + gone);
      } else {
        const GpSample next = sample(random);
        ASSERT_TRUE(process.append(next));
        samples.push_back(next);
      }
    }
    for (int i = 0; i < 20; ++i) {
      const Vector3 at = random.vector(6e-3);
      double variance = 0.0;
      const double mean = mean_by_inverse(hyperparameters, origin, normal, samples, at, variance);
      const GpPrediction ours = process.predict(at);
      EXPECT_NEAR(ours.mean, mean, 1e-6);
      EXPECT_NEAR(ours.variance, variance, 1e-6);
      const auto quick = process.mean_and_slope(at);
      EXPECT_NEAR(quick.mean, ours.mean, 1e-8);
      EXPECT_NEAR(quick.slope, normal.dot(ours.gradient), 1e-5);
    }
  }
}

TEST(LocalGp, TheGradientIsThatOfTheMean) {
  RandomValues random(7);
  LocalGp process(32);
  process.restart(Vector3::Zero(), random.rotation() * Vector3::UnitZ());
  while (process.size() < 32) {
    process.append(sample(random));
  }
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 50; ++i) {
    const Vector3 at = random.vector(5e-3);
    const Vector3 gradient = process.predict(at).gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 step = kStep * Vector3::Unit(axis);
      const double slope = (process.predict(at + step).mean - process.predict(at - step).mean) / (2.0 * kStep);
      EXPECT_NEAR(gradient[axis], slope, 1e-3 * (1.0 + std::abs(slope)));
    }
  }
}

TEST(LocalGp, WhatIsNoSampleChangesNothing) {
  RandomValues random(8);
  LocalGp process(3);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(process.append(sample(random)));
  }
  const double before = process.predict(Vector3::Zero()).mean;
  for (const GpSample& bad :
       {GpSample{{kNan, 0, 0}, 0.0, 1.0, 1.0}, GpSample{{0, 0, 0}, kNan, 1.0, 1.0}, GpSample{{0, 0, 0}, 0.0, kNan, 1.0},
        GpSample{{0, 0, 0}, 0.0, 1.0, 0.0}, GpSample{{0, 0, 0}, 0.0, 1.0, -1.0}}) {
    EXPECT_FALSE(process.append(bad));
  }
  EXPECT_TRUE(process.append(sample(random)));
  EXPECT_FALSE(process.append(sample(random)));  // full
  process.remove(2);
  EXPECT_NEAR(process.predict(Vector3::Zero()).mean, before, 1e-12);
  EXPECT_THROW(LocalGp(0), ConfigError);
}

}  // namespace
}  // namespace saras
