#include "deformation_equations.hpp"

#include <algorithm>

namespace saras {

DeformationEquations::DeformationEquations(const DeformationGrid& grid, double strain_m, double travel_m)
    : coupled_(grid.coupled()) {
  allocate();
  const Eigen::Matrix3d differ = Eigen::Matrix3d::Identity() / (strain_m * strain_m);
  const Eigen::Matrix3d stay = Eigen::Matrix3d::Identity() / (travel_m * travel_m);
  for (const auto& [a, b] : grid.neighbours()) {
    add_block(a, a, differ);
    add_block(b, b, differ);
    add_block(std::max(a, b), std::min(a, b), -differ);
  }
  for (std::size_t corner = 0; corner < coupled_.size(); ++corner) {
    const auto i = static_cast<std::int32_t>(corner);
    add_block(i, i, stay);
  }
  believed_.assign(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros());
  factor_.analyzePattern(matrix_);
}

void DeformationEquations::allocate() {
  const auto size = static_cast<Eigen::Index>(3 * coupled_.size());
  Eigen::VectorXi per_column(size);
  for (std::size_t corner = 0; corner < coupled_.size(); ++corner) {
    per_column.segment<3>(3 * static_cast<Eigen::Index>(corner))
        .setConstant(static_cast<int>(3 * coupled_[corner].size()));
  }
  matrix_.resize(size, size);
  matrix_.reserve(per_column);
  for (std::size_t corner = 0; corner < coupled_.size(); ++corner) {
    for (int c = 0; c < 3; ++c) {
      for (const std::int32_t other : coupled_[corner]) {
        for (int r = 0; r < 3; ++r) {
          matrix_.insert(3 * other + r, 3 * static_cast<Eigen::Index>(corner) + c) = 0.0;
        }
      }
    }
  }
  matrix_.makeCompressed();
  right_ = Eigen::VectorXd::Zero(size);
}

void DeformationEquations::add_block(std::int32_t row, std::int32_t column, const Eigen::Matrix3d& block) {
  const auto& mine = coupled_[static_cast<std::size_t>(column)];
  const auto place = std::lower_bound(mine.begin(), mine.end(), row) - mine.begin();
  for (int c = 0; c < 3; ++c) {
    double* values = matrix_.valuePtr() + matrix_.outerIndexPtr()[3 * column + c] + 3 * place;
    for (int r = 0; r < 3; ++r) {
      values[r] += block(r, c);
    }
  }
}

void DeformationEquations::restart() {
  std::copy(believed_.begin(), believed_.end(), matrix_.valuePtr());
  right_.setZero();
}

void DeformationEquations::add(const std::vector<std::pair<std::int32_t, double>>& weights,
                               const Eigen::Matrix3d& information, const Vector3& target) {
  const Vector3 pull = information * target;
  for (const auto& [a, weight_a] : weights) {
    right_.segment<3>(3 * static_cast<Eigen::Index>(a)) += weight_a * pull;
    for (const auto& [b, weight_b] : weights) {
      if (b >= a) {
        add_block(b, a, weight_a * weight_b * information);
      }
    }
  }
}

bool DeformationEquations::solve(std::vector<Vector3>& displacements) {
  factor_.factorize(matrix_);
  if (factor_.info() != Eigen::Success) {
    return false;
  }
  const Eigen::VectorXd found = factor_.solve(right_);
  if (!found.allFinite()) {
    return false;
  }
  for (std::size_t corner = 0; corner < displacements.size(); ++corner) {
    displacements[corner] = found.segment<3>(3 * static_cast<Eigen::Index>(corner));
  }
  return true;
}

}  // namespace saras
