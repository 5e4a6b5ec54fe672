// The numbers of a struct in field order, for the recording of laws (saras.law_trace) at their own rate.
#pragma once

#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <array>
#include <optional>
#include <type_traits>
#include <vector>

#include "casters.hpp"
#include "saras/spatial/types.hpp"

namespace saras::bindings {

template <typename T>
struct is_sequence : std::false_type {};
template <typename T>
struct is_sequence<std::vector<T>> : std::true_type {};
template <typename T, std::size_t N>
struct is_sequence<std::array<T, N>> : std::true_type {};
template <typename T>
struct is_optional : std::false_type {};
template <typename T>
struct is_optional<std::optional<T>> : std::true_type {};

/// Appends what numpy's ravel() of the Python value gives: matrices row by row, flags as 0 and 1, None as nothing.
/// Bound structs are asked through Python; what is no number raises TypeError.
template <typename T>
void append_numbers(const T& value, std::vector<double>& numbers) {
  if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    numbers.push_back(static_cast<double>(value));
  } else if constexpr (std::is_same_v<T, Pose>) {
    const Eigen::Matrix3d rotation = value.rotation.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
      numbers.insert(numbers.end(), {rotation(row, 0), rotation(row, 1), rotation(row, 2), value.translation[row]});
    }
    numbers.insert(numbers.end(), {0.0, 0.0, 0.0, 1.0});
  } else if constexpr (std::is_same_v<T, Twist> || std::is_same_v<T, Wrench>) {
    append_numbers(Vector6(to_vector(value)), numbers);
  } else if constexpr (std::is_base_of_v<Eigen::MatrixBase<T>, T>) {
    for (Eigen::Index row = 0; row < value.rows(); ++row) {
      for (Eigen::Index column = 0; column < value.cols(); ++column) {
        numbers.push_back(static_cast<double>(value(row, column)));
      }
    }
  } else if constexpr (is_optional<T>::value) {
    if (value) {
      append_numbers(*value, numbers);
    }
  } else if constexpr (is_sequence<T>::value) {
    for (const auto& item : value) {
      append_numbers(item, numbers);
    }
  } else if constexpr (std::is_base_of_v<pybind11::array, T>) {
    const Array array = Array::ensure(value);
    numbers.insert(numbers.end(), array.data(), array.data() + array.size());
  } else {
    const pybind11::object object = pybind11::cast(value);
    if (!pybind11::hasattr(object, "_numbers")) {
      throw pybind11::type_error("cannot flatten " + pybind11::repr(object).cast<std::string>());
    }
    for (const auto& number : object.attr("_numbers")()) {
      numbers.push_back(number.cast<double>());
    }
  }
}

}  // namespace saras::bindings
