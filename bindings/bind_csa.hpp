// Shared by the files that bind the room `csa`.
#pragma once

#include <string>

#include "law.hpp"
#include "saras/csa/constrained_motion.hpp"

namespace saras::bindings {

/// A vector of joints from Python; the core's vectors have a fixed capacity.
inline csa::JointVector load_joints(const char* name, const Eigen::VectorXd& values) {
  if (values.size() > csa::kMaxJoints) {
    throw py::value_error(std::string(name) + ": expected at most " + std::to_string(csa::kMaxJoints) +
                          " joints, got " + std::to_string(values.size()));
  }
  return values;
}

inline csa::TipJacobian load_jacobian(const Eigen::MatrixXd& values) {
  if (values.rows() != 6 || values.cols() > csa::kMaxJoints) {
    throw py::value_error("jacobian: expected shape (6, n) with n <= " + std::to_string(csa::kMaxJoints) + ", got (" +
                          std::to_string(values.rows()) + ", " + std::to_string(values.cols()) + ")");
  }
  return values;
}

/// A field of joints: (n,) in Python.
template <typename T>
Struct<T>& joint_field(Struct<T>& bound, const char* name, csa::JointVector T::*member, const char* doc) {
  return bound.field(
      name, [member](const T& self) -> Eigen::VectorXd { return self.*member; },
      [member, field = std::string(name)](T& self, const Eigen::VectorXd& values) {
        self.*member = load_joints(field.c_str(), values);
      },
      doc);
}

void bind_csa(py::module_& m);
void bind_csa_border(py::module_& m);
void bind_csa_fixtures(py::module_& m);
void bind_csa_slave(py::module_& m);
void bind_csa_teleop(py::module_& m);
void bind_csa_teleop_fixtures(py::module_& m);

}  // namespace saras::bindings
