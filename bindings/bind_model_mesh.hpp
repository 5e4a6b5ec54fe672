// Shared by the files that bind meshes of the room `model`.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "bind_model.hpp"
#include "saras/model/registration.hpp"

namespace saras::bindings {

/// A mesh and its tree, which refers to it.
struct MeshWithTree {
  explicit MeshWithTree(SurfaceMesh given) : mesh((given.validate(), std::move(given))), tree(mesh) {}
  MeshWithTree(const MeshWithTree&) = delete;
  MeshWithTree& operator=(const MeshWithTree&) = delete;
  SurfaceMesh mesh;
  MeshTree tree;
};

/// (n, 3) positions; covariances: (n, 3, 3), or None for the default.
std::vector<SurfacePoint> load_points_on(const py::object& positions, const py::object& covariances);

}  // namespace saras::bindings
