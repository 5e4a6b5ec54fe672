#include "bind_model_mesh.hpp"
#include "saras/model/deformation.hpp"

namespace saras::bindings {
namespace {

/// A grid, and the mesh that it encloses.
struct GridOfMesh {
  GridOfMesh(std::shared_ptr<const IndexedMesh> of, double spacing)
      : mesh(std::move(of)), spacing_m(spacing), grid(mesh->mesh, spacing) {}
  std::shared_ptr<const IndexedMesh> mesh;
  double spacing_m;
  DeformationGrid grid;
};

}  // namespace

void bind_model_deformation(py::module_& m) {
  using D = Deformation;
  py::class_<D>(m, "Deformation", "How a mesh is bent.")
      .def_property_readonly(
          "displacements", [](const D& d) { return store_rows(d.displacements); }, "(k, 3) of the grid's corners [m]")
      .def_property_readonly(
          "vertices", [](const D& d) { return store_rows(d.vertices); }, "(n, 3) of the bent mesh, mesh frame [m]")
      .def_readonly("used", &D::used, "flags of the points; False: left out by the gate")
      .def_readonly("rms_m", &D::rms_m, "distance of the used points from the bent mesh [m]")
      .def_readonly("rounds", &D::rounds, "of matching and solving")
      .def_readonly("converged", &D::converged);
  const DeformationOptions defaults;
  using G = GridOfMesh;
  py::class_<G>(m, "DeformationGrid", "Cubes around a mesh whose corners carry displacements.")
      .def(py::init([](const std::shared_ptr<IndexedMesh>& mesh, double spacing_m) {
             return std::make_unique<G>(mesh, spacing_m);
           }),
           py::arg("mesh"), py::arg("spacing_m") = defaults.spacing_m, "Raises ModelError, ConfigError.")
      .def(
          "deform",
          [](const G& self, const py::object& points, const py::object& covariances, const Pose& base_T_mesh,
             double strain, double travel_m, double gate, int max_rounds, double tolerance_m, const py::object& start) {
            const auto given = load_points_on(points, covariances);
            const auto from = start.is_none() ? std::vector<Vector3>{} : load_rows(start, "start");
            DeformationOptions options;
            options.spacing_m = self.spacing_m;
            options.strain = strain;
            options.travel_m = travel_m;
            options.gate = gate;
            options.max_rounds = max_rounds;
            options.tolerance_m = tolerance_m;
            const py::gil_scoped_release release;
            return deform(self.mesh->mesh, self.mesh->tree, self.grid, given, base_T_mesh, options, from);
          },
          py::arg("points"), py::arg("covariances") = py::none(), py::arg("base_T_mesh") = Pose{}, py::kw_only(),
          py::arg("strain") = defaults.strain, py::arg("travel_m") = defaults.travel_m, py::arg("gate") = defaults.gate,
          py::arg("max_rounds") = defaults.max_rounds, py::arg("tolerance_m") = defaults.tolerance_m,
          py::arg("start") = py::none(),
          "Bends the mesh to (n, 3) points [m] in the base frame, with (n, 3, 3) covariances [m^2] (None: 1 mm). "
          "strain:\n"
          "standard deviation of neighbouring corners' difference per spacing; travel_m: of a corner's way. start:\n"
          "displacements of the last call. Raises ModelError.")
      .def(
          "apply",
          [](const G& self, const py::object& displacements) {
            const auto given = load_rows(displacements, "displacements");
            if (given.size() != self.grid.corners()) {
              throw py::value_error("displacements: expected " + std::to_string(self.grid.corners()) + " rows, got " +
                                    std::to_string(given.size()));
            }
            std::vector<Vector3> moved;
            self.grid.apply(self.mesh->mesh, given, moved);
            return store_rows(moved);
          },
          py::arg("displacements"), "(n, 3) vertices moved by (k, 3) displacements of the corners.")
      .def_property_readonly(
          "corners", [](const G& self) { return store_rows(self.grid.positions()); }, "(k, 3) [m]");
}

}  // namespace saras::bindings
