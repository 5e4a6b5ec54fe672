// Points as (n, 3) and poses as (n, 4, 4), shared by the files of the calibration room.
#pragma once

#include <vector>

#include "law.hpp"

namespace saras::bindings {

std::vector<Vector3> load_points(const py::object& source, const char* what);
Array store_points(const std::vector<Vector3>& points);
/// (n, 4, 4); entries that are no rigid transform get NaN quaternions, which the room refuses by their number.
std::vector<Pose> load_poses(const py::object& source, const char* what);
Array store_matrix6(const Eigen::Matrix<double, 6, 6>& matrix);

void bind_calibration_hand_eye(py::module_& m);

}  // namespace saras::bindings
