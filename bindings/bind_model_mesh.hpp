// Shared by the files that bind meshes of the room `model`.
#pragma once

#include <vector>

#include "bind_model.hpp"
#include "saras/model/registration.hpp"

namespace saras::bindings {

/// (n, 3) positions; covariances: (n, 3, 3), or None for the default.
std::vector<SurfacePoint> load_points_on(const py::object& positions, const py::object& covariances);

}  // namespace saras::bindings
