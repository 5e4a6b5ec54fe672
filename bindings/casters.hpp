// numpy <-> core values: Pose as (4, 4), Twist and Wrench as (6,), linear/force first.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <string>

#include "saras/spatial/types.hpp"

namespace saras::bindings {

inline std::string shape_text(const pybind11::array& array) {
  std::string text = "(";
  for (pybind11::ssize_t i = 0; i < array.ndim(); ++i) {
    text += (i ? ", " : "") + std::to_string(array.shape(i));
  }
  return text + (array.ndim() == 1 ? ",)" : ")");
}

using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

inline Vector6 load_vector6(pybind11::handle source, const char* what) {
  const Array array = Array::ensure(source);
  if (!array || array.ndim() != 1 || array.shape(0) != 6) {
    PyErr_Clear();
    throw pybind11::value_error(std::string(what) + ": expected 6 numbers (linear/force first), got " +
                                (array ? "shape " + shape_text(array) : std::string("no array")));
  }
  return Eigen::Map<const Vector6>(array.data());
}

/// A matrix that is no rigid transform becomes a Pose with a NaN quaternion: laws answer INVALID_INPUT,
/// everything else refuses it by is_valid().
inline Pose load_pose(pybind11::handle source) {
  const Array array = Array::ensure(source);
  if (!array || array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) {
    PyErr_Clear();
    throw pybind11::value_error("pose: expected a (4, 4) matrix, got " +
                                (array ? "shape " + shape_text(array) : std::string("no array")));
  }
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(array.data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  Pose pose;
  pose.translation = matrix.topRightCorner<3, 1>();
  const bool rigid = rotation.allFinite() && (rotation.transpose() * rotation).isIdentity(1e-6) &&
                     rotation.determinant() > 0.0 && matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-9);
  if (rigid) {
    pose.rotation = Quaternion(rotation).normalized();
  } else {
    pose.rotation.coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return pose;
}

inline Array store_pose(const Pose& pose) {
  Array array({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(array.mutable_data());
  matrix.setIdentity();
  matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.translation;
  return array;
}

inline Array store_vector6(const Vector6& vector) {
  Array array(6);
  Eigen::Map<Vector6>(array.mutable_data()) = vector;
  return array;
}

}  // namespace saras::bindings

namespace pybind11::detail {

template <>
struct type_caster<saras::Pose> {
  PYBIND11_TYPE_CASTER(saras::Pose, io_name("numpy.typing.ArrayLike", "numpy.typing.NDArray[numpy.float64]"));
  bool load(handle source, bool) {
    value = saras::bindings::load_pose(source);
    return true;
  }
  static handle cast(const saras::Pose& pose, return_value_policy, handle) {
    return saras::bindings::store_pose(pose).release();
  }
};

template <>
struct type_caster<saras::Twist> {
  PYBIND11_TYPE_CASTER(saras::Twist, io_name("numpy.typing.ArrayLike", "numpy.typing.NDArray[numpy.float64]"));
  bool load(handle source, bool) {
    value = saras::to_twist(saras::bindings::load_vector6(source, "twist"));
    return true;
  }
  static handle cast(const saras::Twist& twist, return_value_policy, handle) {
    return saras::bindings::store_vector6(saras::to_vector(twist)).release();
  }
};

template <>
struct type_caster<saras::Wrench> {
  PYBIND11_TYPE_CASTER(saras::Wrench, io_name("numpy.typing.ArrayLike", "numpy.typing.NDArray[numpy.float64]"));
  bool load(handle source, bool) {
    value = saras::to_wrench(saras::bindings::load_vector6(source, "wrench"));
    return true;
  }
  static handle cast(const saras::Wrench& wrench, return_value_policy, handle) {
    return saras::bindings::store_vector6(saras::to_vector(wrench)).release();
  }
};

}  // namespace pybind11::detail
