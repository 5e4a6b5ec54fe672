// The exception of this room. Python sees the same name under saras.
#pragma once

#include "saras/spatial/errors.hpp"

namespace saras {

/// Samples, a mesh or a cost that no model may be made from: too few, not closed, another unit, not finite.
class ModelError : public Error {
 public:
  using Error::Error;
};

}  // namespace saras
