// Shared by the files that bind the room `collision`.
#pragma once

#include <vector>

#include "law.hpp"
#include "saras/collision/scene.hpp"

namespace saras::bindings {

/// (8, 3) from Python.
Corners load_corners(const py::object& source);
/// (n, 8, 3) from Python; an empty sequence is no regions.
std::vector<Corners> load_regions(const py::object& source);
Array store_corners(const Corners& corners);
Array store_regions(const std::vector<Corners>& regions);
/// Refusals name the index of the region.
std::vector<Parallelepiped> shapes_of(const std::vector<Corners>& regions);
/// A sequence of (a (3,), b (3,), radius_m), Capsule, or None (not known).
std::vector<SceneTool> load_tools(const py::sequence& source);

void bind_collision_shapes(py::module_& m);
void bind_collision_laws(py::module_& m);

}  // namespace saras::bindings
