// Normal equations of a bending step: sparse, with the same pattern whatever the points are matched to.
#pragma once

#include <Eigen/SparseCholesky>
#include <vector>

#include "saras/model/deformation.hpp"

namespace saras {

class DeformationEquations {
 public:
  /// strain_m: standard deviation of neighbouring corners' difference; travel_m: of a corner's displacement.
  DeformationEquations(const DeformationGrid& grid, double strain_m, double travel_m);

  /// Leaves only what is believed without points.
  void restart();
  /// A point that says: the weighted sum of the displacements is `target`, with this information.
  void add(const std::vector<std::pair<std::int32_t, double>>& weights, const Eigen::Matrix3d& information,
           const Vector3& target);
  /// The most probable displacements. False: not to be had in floating point; they are as before.
  bool solve(std::vector<Vector3>& displacements);

 private:
  void allocate();
  /// Adds to the block in the lower triangle (row >= column).
  void add_block(std::int32_t row, std::int32_t column, const Eigen::Matrix3d& block);

  const std::vector<std::vector<std::int32_t>>& coupled_;  ///< the grid's
  Eigen::SparseMatrix<double> matrix_;
  std::vector<double> believed_;
  Eigen::VectorXd right_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace saras
