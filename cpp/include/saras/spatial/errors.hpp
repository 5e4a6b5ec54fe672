// Exceptions thrown outside step(). Python sees the same names under saras.
#pragma once

#include <stdexcept>
#include <string>

namespace saras {

/// Base of all exceptions of this library.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A configuration value is refused. The message names field, value and bound.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// A datagram or file does not follow its format.
class ProtocolError : public Error {
 public:
  using Error::Error;
};

/// A kinematic question has no answer (unreachable pose, wrong number of joints).
class KinematicsError : public Error {
 public:
  using Error::Error;
};

}  // namespace saras
