// The exception of this room. Python sees the same name under saras.
#pragma once

#include "saras/spatial/errors.hpp"

namespace saras {

/// Measurements that no calibration may be made from: too few, degenerate, contradictory, implausible.
class CalibrationError : public Error {
 public:
  using Error::Error;
};

}  // namespace saras
