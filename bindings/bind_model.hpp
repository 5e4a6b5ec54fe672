// Shared by the files that bind the room `model`.
#pragma once

#include <vector>

#include "law.hpp"
#include "saras/model/local_model.hpp"

namespace saras::bindings {

/// (n, 3) from Python.
std::vector<Vector3> load_rows(const py::object& source, const char* what);
Array store_rows(const std::vector<Vector3>& rows);
/// A dict of arrays, one row an estimate.
py::dict store_estimates(const std::vector<SurfaceEstimate>& estimates);

void bind_model_grid(py::module_& m);
void bind_model_process(py::module_& m);
void bind_model_stiffness(py::module_& m);
void bind_model_registration(py::module_& m);
void bind_model_deformation(py::module_& m);
void bind_model_learning(py::module_& m);  ///< where the core has it: Ceres

}  // namespace saras::bindings
