#include <algorithm>

#include "bind_model_mesh.hpp"

namespace saras::bindings {
namespace {

SurfaceMesh load_mesh(const py::object& vertices, const py::object& triangles) {
  SurfaceMesh mesh;
  mesh.vertices = load_rows(vertices, "vertices");
  using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
  const Indices indices = Indices::ensure(triangles);
  if (!indices || indices.ndim() != 2 || indices.shape(1) != 3) {
    PyErr_Clear();
    throw py::value_error("triangles: expected whole numbers of shape (n, 3)");
  }
  for (py::ssize_t i = 0; i < indices.shape(0); ++i) {
    std::array<std::int32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t vertex = indices.data()[3 * i + static_cast<py::ssize_t>(k)];
      triangle[k] = static_cast<std::int32_t>(std::clamp<std::int64_t>(vertex, -1, 0x7FFFFFFF));
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

py::tuple store_matches(const std::vector<MeshMatch>& matches) {
  std::vector<Vector3> points;
  std::vector<Vector3> weights;
  py::array_t<std::int32_t> triangles(static_cast<py::ssize_t>(matches.size()));
  Array squared(static_cast<py::ssize_t>(matches.size()));
  for (std::size_t i = 0; i < matches.size(); ++i) {
    points.push_back(matches[i].point);
    weights.push_back(matches[i].barycentric);
    triangles.mutable_data()[i] = matches[i].triangle;
    squared.mutable_data()[i] = matches[i].squared;
  }
  return py::make_tuple(store_rows(points), triangles, store_rows(weights), squared);
}

void bind_mesh(py::module_& m) {
  py::class_<IndexedMesh, std::shared_ptr<IndexedMesh>>(m, "Mesh", "Triangles with a tree for closest points.")
      .def(py::init([](const py::object& vertices, const py::object& triangles) {
             return std::make_shared<IndexedMesh>(load_mesh(vertices, triangles));
           }),
           py::arg("vertices"), py::arg("triangles"),
           "vertices (n, 3) [m], triangles (m, 3) counter-clockwise from outside. Raises ModelError: empty, not "
           "finite, an\n"
           "index out of range, no area, not manifold, another unit than metres.")
      .def(
          "likely",
          [](const IndexedMesh& self, const py::object& points, const py::object& covariances) {
            const auto given = load_points_on(points, covariances);
            std::vector<MeshMatch> matches(given.size());
            {
              const py::gil_scoped_release release;
              for (std::size_t i = 0; i < given.size(); ++i) {
                const Eigen::Matrix3d metric = given[i].covariance.inverse();
                matches[i] = self.tree.likely(given[i].position, metric);
              }
            }
            return store_matches(matches);
          },
          py::arg("points"), py::arg("covariances"),
          "Where (n, 3) points with (n, 3, 3) covariances of their errors most likely came from: points (n, 3), "
          "triangles\n"
          "(n,), barycentric weights (n, 3), squared deviations (n,).")
      .def(
          "closest",
          [](const IndexedMesh& self, const py::object& points) {
            const auto given = load_rows(points, "points");
            std::vector<MeshMatch> matches(given.size());
            {
              const py::gil_scoped_release release;
              for (std::size_t i = 0; i < given.size(); ++i) {
                matches[i] = self.tree.closest(given[i]);
              }
            }
            return store_matches(matches);
          },
          py::arg("points"), "The closest points of the surface, as `likely`; squared distances [m^2].")
      .def_property_readonly(
          "vertices", [](const IndexedMesh& self) { return store_rows(self.mesh.vertices); }, "(n, 3) [m]")
      .def_property_readonly(
          "triangles",
          [](const IndexedMesh& self) {
            py::array_t<std::int32_t> array({static_cast<py::ssize_t>(self.mesh.triangles.size()), py::ssize_t{3}});
            for (std::size_t i = 0; i < self.mesh.triangles.size(); ++i) {
              std::copy_n(self.mesh.triangles[i].data(), 3, array.mutable_data() + 3 * i);
            }
            return array;
          },
          "(m, 3)")
      .def_property_readonly(
          "vertex_normals", [](const IndexedMesh& self) { return store_rows(self.normals); },
          "(n, 3) outward, area-weighted")
      .def_property_readonly("closed", [](const IndexedMesh& self) { return self.mesh.closed(); });
}

}  // namespace

std::vector<SurfacePoint> load_points_on(const py::object& positions, const py::object& covariances) {
  std::vector<SurfacePoint> points;
  for (const Vector3& position : load_rows(positions, "points")) {
    points.push_back({});
    points.back().position = position;
  }
  if (!covariances.is_none()) {
    const Array array = Array::ensure(covariances);
    if (!array || array.ndim() != 3 || array.shape(0) != static_cast<py::ssize_t>(points.size()) ||
        array.shape(1) != 3 || array.shape(2) != 3) {
      PyErr_Clear();
      throw py::value_error("covariances: expected shape (" + std::to_string(points.size()) + ", 3, 3)");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].covariance = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(array.data() + 9 * i);
    }
  }
  return points;
}

void bind_model_registration(py::module_& m) {
  bind_mesh(m);
  using R = Registration;
  py::class_<R>(m, "Registration", "Where a mesh lies, and how well that is known.")
      .def_property_readonly(
          "base_T_mesh", [](const R& r) { return r.base_T_mesh; }, "(4, 4)")
      .def_property_readonly(
          "covariance", [](const R& r) { return Eigen::MatrixXd(r.covariance); },
          "(6, 6) of saras.displacement(estimate, truth) at the points' middle: [m, rad]")
      .def_property_readonly(
          "matches", [](const R& r) { return store_matches(r.matches); }, "as Mesh.likely gives them, mesh frame")
      .def_readonly("used", &R::used, "n flags; False: left out by the gate")
      .def_readonly("rms_m", &R::rms_m, "distance of the used points from the mesh [m]")
      .def_readonly("iterations", &R::iterations)
      .def_readonly("converged", &R::converged);
  const RegistrationOptions defaults;
  m.def(
      "register_rigid",
      [](const IndexedMesh& mesh, const py::object& points, const py::object& covariances, const Pose& base_T_mesh,
         double gate, double mesh_noise_m, int max_iterations, double tolerance_m, bool most_likely,
         const Pose& base_T_prior, double prior_shift_m, double prior_turn_rad) {
        const auto given = load_points_on(points, covariances);
        RegistrationOptions options;
        options.gate = gate;
        options.mesh_noise_m = mesh_noise_m;
        options.max_iterations = max_iterations;
        options.tolerance_m = tolerance_m;
        options.most_likely = most_likely;
        options.prior = {base_T_prior, prior_shift_m, prior_turn_rad};
        const py::gil_scoped_release release;
        return register_rigid(mesh.mesh, mesh.tree, given, base_T_mesh, options);
      },
      py::arg("mesh"), py::arg("points"), py::arg("covariances") = py::none(), py::arg("base_T_mesh") = Pose{},
      py::kw_only(), py::arg("gate") = defaults.gate, py::arg("mesh_noise_m") = defaults.mesh_noise_m,
      py::arg("max_iterations") = defaults.max_iterations, py::arg("tolerance_m") = defaults.tolerance_m,
      py::arg("most_likely") = true, py::arg("base_T_prior") = Pose{},
      py::arg("prior_shift_m") = defaults.prior.shift_m, py::arg("prior_turn_rad") = defaults.prior.turn_rad,
      "Iterative most likely point registration (Billings, Boctor, Taylor 2015). points (n, 3) [m] on the surface,\n"
      "covariances (n, 3, 3) of their errors [m^2] (None: 1 mm), base_T_mesh (4, 4) to start from. gate: squared "
      "deviation\n"
      "above which a point is left out; most_likely=False: plain ICP. prior_shift_m, prior_turn_rad: standard "
      "deviations "
      "of\n"
      "how far from base_T_prior (4, 4) the mesh is believed to lie. Raises ModelError.");
}

}  // namespace saras::bindings
