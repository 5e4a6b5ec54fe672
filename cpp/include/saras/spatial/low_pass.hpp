// First-order low-pass that is stable for every time step.
#pragma once

#include <cmath>

#include "saras/spatial/types.hpp"

namespace saras {

/// Gain g of y += g (x - y): the exact step response 1 - exp(-2 pi f dt) of a first-order low-pass.
inline double low_pass_gain(double cutoff_hz, Seconds dt) { return -std::expm1(-2.0 * M_PI * cutoff_hz * dt); }

inline void low_pass(Twist& filtered, const Twist& value, double gain) {
  filtered.linear += gain * (value.linear - filtered.linear);
  filtered.angular += gain * (value.angular - filtered.angular);
}

}  // namespace saras
