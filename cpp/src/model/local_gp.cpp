#include "saras/model/local_gp.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {

void GpHyperparameters::validate() const {
  validate::in_range("force_scale_N", force_scale_N, 1e-3, 1e4);
  validate::in_range("stiffness_scale_N_m", stiffness_scale_N_m, 1e-2, 1e7);
  validate::in_range("bend_scale_N_m2", bend_scale_N_m2, 0.0, 1e9);
  validate::in_range("tangential_length_m", tangential_length_m, 1e-4, 10.0);
  validate::in_range("damping_s_m", damping_s_m, 0.0, 1e4);
  validate::in_range("damping_scale_s_m", damping_scale_s_m, 0.0, 1e4);
  validate::in_range("noise_N", noise_N, 1e-5, 1e2);
}

LocalGp::LocalGp(int capacity, GpHyperparameters hyperparameters)
    : capacity_((validate::in_range("capacity", capacity, 1, 512), capacity)),
      points_(3, capacity),
      powers_(capacity),
      values_(capacity),
      factor_(Eigen::MatrixXd::Zero(capacity, capacity)),
      whitened_(capacity),
      weights_(capacity),
      columns_(capacity, 4) {
  adopt(hyperparameters);
}

void LocalGp::adopt(const GpHyperparameters& hyperparameters) {
  hyperparameters.validate();
  const auto squared = [](double value) { return value * value; };
  hyperparameters_ = hyperparameters;
  force_variance_ = squared(hyperparameters.force_scale_N);
  stiffness_variance_ = squared(hyperparameters.stiffness_scale_N_m);
  bend_variance_ = squared(hyperparameters.bend_scale_N_m2);
  damping_variance_ = squared(hyperparameters.damping_scale_s_m);
  restart(origin_, normal_);
}

void LocalGp::restart(const Vector3& origin, const Vector3& normal) noexcept {
  size_ = 0;
  weights_made_ = false;
  origin_ = origin;
  normal_ = normal;
  const Vector3 across = normal.unitOrthogonal();
  axes_.row(0) = across;
  axes_.row(1) = normal.cross(across);
  axes_.row(2) = normal;
}

Vector3 LocalGp::local(const Vector3& position) const noexcept {
  Vector3 point = axes_ * (position - origin_);
  point.head<2>() /= hyperparameters_.tangential_length_m;
  return point;
}

Vector3 LocalGp::position(int i) const {
  Vector3 point = points_.col(i);
  point.head<2>() *= hyperparameters_.tangential_length_m;
  return origin_ + axes_.transpose() * point;
}

double LocalGp::polynomial(double u, double v) const noexcept {
  const double product = u * v;
  return force_variance_ + product * (stiffness_variance_ + product * bend_variance_);
}

void LocalGp::covariances(const Vector3& point, double power_W) const noexcept {
  for (int i = 0; i < size_; ++i) {
    const double near = std::exp(-0.5 * (points_.col(i).head<2>() - point.head<2>()).squaredNorm());
    columns_(i, 0) = near * polynomial(points_(2, i), point.z()) + damping_variance_ * powers_[i] * power_W;
  }
  work_ += static_cast<std::uint64_t>(size_);
}

void LocalGp::forward(int columns) const noexcept {
  // By hand: as small as these are, Eigen's blocked solver would copy, and a column at a time is contiguous.
  for (int c = 0; c < columns; ++c) {
    auto column = columns_.col(c);
    for (int i = 0; i < size_; ++i) {
      column[i] /= factor_(i, i);
      const int below = size_ - i - 1;
      column.segment(i + 1, below).noalias() -= column[i] * factor_.col(i).segment(i + 1, below);
    }
  }
  work_ += static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(size_) * static_cast<std::uint64_t>(size_);
}

void LocalGp::whiten(int from) noexcept {
  // whitened_[0 .. from) still holds.
  for (int i = from; i < size_; ++i) {
    whitened_[i] = (values_[i] - factor_.row(i).head(i).dot(whitened_.head(i))) / factor_(i, i);
  }
  weights_made_ = false;
  work_ += static_cast<std::uint64_t>(size_ - from) * static_cast<std::uint64_t>(size_);
}

void LocalGp::solve_weights() const noexcept {
  weights_.head(size_) = whitened_.head(size_);
  for (int i = size_ - 1; i >= 0; --i) {
    const int below = size_ - i - 1;
    weights_[i] =
        (weights_[i] - factor_.col(i).segment(i + 1, below).dot(weights_.segment(i + 1, below))) / factor_(i, i);
  }
  weights_made_ = true;
  work_ += static_cast<std::uint64_t>(size_) * static_cast<std::uint64_t>(size_);
}

bool LocalGp::append(const GpSample& sample) noexcept {
  const Vector3 point = local(sample.position);
  if (size_ == capacity_ || !point.allFinite() || !std::isfinite(sample.value_N) || !std::isfinite(sample.power_W) ||
      !(sample.noise_variance_N2 > 0.0) || !std::isfinite(sample.noise_variance_N2)) {
    return false;
  }
  covariances(point, sample.power_W);
  forward(1);
  const auto row = columns_.col(0).head(size_);
  const double variance = polynomial(point.z(), point.z()) + damping_variance_ * sample.power_W * sample.power_W;
  const double pivot = variance + sample.noise_variance_N2 - row.squaredNorm();
  if (!(pivot > 1e-14 * variance)) {
    return false;
  }
  factor_.row(size_).head(size_) = row.transpose();
  factor_(size_, size_) = std::sqrt(pivot);
  points_.col(size_) = point;
  powers_[size_] = sample.power_W;
  values_[size_] = sample.value_N;
  ++size_;
  whiten(size_ - 1);
  return true;
}

void LocalGp::remove(int gone) noexcept {
  // What the lost column carried is given to the rows below it: a positive rank-1 update, which cannot fail.
  const int below = size_ - gone - 1;
  auto carried = columns_.col(0).head(below);
  carried = factor_.col(gone).segment(gone + 1, below);
  for (int i = gone; i < size_ - 1; ++i) {
    factor_.row(i).head(gone) = factor_.row(i + 1).head(gone);
    points_.col(i) = points_.col(i + 1);
    powers_[i] = powers_[i + 1];
    values_[i] = values_[i + 1];
  }
  for (int column = gone; column < size_ - 1; ++column) {
    const int at = column - gone;
    const double old_pivot = factor_(column + 1, column + 1);
    const double pivot = std::hypot(old_pivot, carried[at]);
    const double cosine = old_pivot / pivot;
    const double sine = carried[at] / pivot;
    factor_(column, column) = pivot;
    for (int row = column + 1; row < size_ - 1; ++row) {
      const double old = factor_(row + 1, column + 1);
      factor_(row, column) = cosine * old + sine * carried[row - gone];
      carried[row - gone] = cosine * carried[row - gone] - sine * old;
    }
  }
  work_ += static_cast<std::uint64_t>(below) * static_cast<std::uint64_t>(size_);
  --size_;
  whiten(gone);
}

LocalGp::MeanAndSlope LocalGp::mean_and_slope(const Vector3& at) const noexcept {
  if (!weights_made_) {
    solve_weights();
  }
  const Vector3 point = local(at);
  const double u = point.z();
  MeanAndSlope result{0.0, 0.0};
  for (int i = 0; i < size_; ++i) {
    const double share = weights_[i] * std::exp(-0.5 * (points_.col(i).head<2>() - point.head<2>()).squaredNorm());
    const double v = points_(2, i);
    result.mean += share * polynomial(u, v);
    result.slope += share * v * (stiffness_variance_ + 2.0 * u * v * bend_variance_);
  }
  work_ += static_cast<std::uint64_t>(size_);
  return result;
}

GpPrediction LocalGp::predict(const Vector3& at, double power_W) const noexcept {
  const Vector3 point = local(at);
  const double u = point.z();
  const double inverse_length = 1.0 / hyperparameters_.tangential_length_m;
  for (int i = 0; i < size_; ++i) {
    const Eigen::Vector2d offset = points_.col(i).head<2>() - point.head<2>();
    const double near = std::exp(-0.5 * offset.squaredNorm());
    const double v = points_(2, i);
    const double covariance = near * polynomial(u, v);
    columns_(i, 0) = covariance + damping_variance_ * powers_[i] * power_W;
    columns_(i, 1) = covariance * offset.x() * inverse_length;
    columns_(i, 2) = covariance * offset.y() * inverse_length;
    columns_(i, 3) = near * v * (stiffness_variance_ + 2.0 * u * v * bend_variance_);
  }
  work_ += static_cast<std::uint64_t>(size_);
  forward(4);
  const auto columns = columns_.topRows(size_);
  const Eigen::Vector4d means = columns.transpose().lazyProduct(whitened_.head(size_));
  const Eigen::Matrix4d explained = columns.transpose().lazyProduct(columns);
  const double variance = polynomial(u, u);
  const double tangential = variance * inverse_length * inverse_length;
  Eigen::Matrix3d covariance = -explained.bottomRightCorner<3, 3>();
  covariance.diagonal() += Vector3(tangential, tangential, stiffness_variance_ + 4.0 * u * u * bend_variance_);
  GpPrediction prediction;
  prediction.mean = means[0];
  prediction.variance = std::max(0.0, variance + damping_variance_ * power_W * power_W - explained(0, 0));
  prediction.gradient = axes_.transpose() * means.tail<3>();
  prediction.gradient_covariance = axes_.transpose() * covariance * axes_;
  return prediction;
}

double LocalGp::log_marginal_likelihood() const noexcept {
  constexpr double kLogTwoPi = 1.8378770664093453;
  return -0.5 * whitened_.head(size_).squaredNorm() - factor_.diagonal().head(size_).array().log().sum() -
         0.5 * kLogTwoPi * size_;
}

}  // namespace saras
