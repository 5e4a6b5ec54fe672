// Exact discretisation of x'' = -stiffness x - damping x' + u with u held over the step.
#pragma once

#include <cmath>

#include "saras/spatial/types.hpp"

namespace saras {

/// One step of a second-order system: x+ = a_xx x + a_xv v + b_x u, v+ = a_vx x + a_vv v + b_v u.
struct SecondOrderStep {
  double a_xx = 1.0, a_xv = 0.0, a_vx = 0.0, a_vv = 1.0, b_x = 0.0, b_v = 0.0;
};

/// Zero-order-hold step from the matrix exponential of the system augmented by its input (Van Loan 1978), by Taylor
/// series with scaling and squaring. Holds for every sign of stiffness and damping, zero included.
/// stiffness [1/s^2], damping [1/s], dt [s]
inline SecondOrderStep second_order_step(double stiffness, double damping, Seconds dt) noexcept {
  Eigen::Matrix3d exponent = Eigen::Matrix3d::Zero();
  exponent(0, 1) = dt;
  exponent(1, 0) = -stiffness * dt;
  exponent(1, 1) = -damping * dt;
  exponent(1, 2) = dt;
  int squarings = 0;
  std::frexp(exponent.cwiseAbs().maxCoeff() * 8.0, &squarings);
  squarings = squarings < 0 ? 0 : squarings;
  exponent *= std::ldexp(1.0, -squarings);
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
  for (int order = 1; order <= 10; ++order) {  // |exponent| <= 1/8: the rest is below 1e-16
    term = (term * exponent / order).eval();
    sum += term;
  }
  for (; squarings > 0; --squarings) {
    sum = (sum * sum).eval();
  }
  return {sum(0, 0), sum(0, 1), sum(1, 0), sum(1, 1), sum(0, 2), sum(1, 2)};
}

}  // namespace saras
