#include "bind_csa.hpp"
#include "saras/csa/teleop_fixture.hpp"

namespace saras::bindings {
namespace {

using namespace csa;

void bind_mesh(py::module_& m) {
  using P = MeshPoint;
  py::class_<P>(m, "MeshPoint", "The closest point on a mesh.")
      .def_readonly("distance_m", &P::distance_m, "signed: negative behind the surface; NaN: none within reach")
      .def_property_readonly(
          "point", [](const P& p) { return p.point; }, "(3,) on the surface [m]")
      .def_property_readonly(
          "normal", [](const P& p) { return p.normal; }, "(3,) unit, outward")
      .def_readonly("triangle", &P::triangle, "index as given; -1: none");
  py::class_<TriangleMesh, std::shared_ptr<TriangleMesh>>(m, "TriangleMesh",
                                                          "Triangles in a tree, for closest points in microseconds.")
      .def(py::init<const TriangleMesh::Vertices&, const TriangleMesh::Triangles&>(), py::arg("vertices"),
           py::arg("triangles"),
           "vertices: (v, 3) [m]; triangles: (t, 3) indices, counter-clockwise from outside. Raises ConfigError.")
      .def(
          "closest",
          [](const TriangleMesh& self, const Vector3& point, double within_m, int hint) {
            return self.closest(point, within_m, hint);
          },
          py::arg("point"), py::arg("within_m") = std::numeric_limits<double>::infinity(), py::arg("hint") = -1,
          "MeshPoint nearest to (3,) [m], no further than within_m. hint: a triangle that may be near.")
      .def(
          "nearby",
          [](const TriangleMesh& self, const Vector3& point, double within_m, int capacity) {
            std::vector<MeshPoint> found(static_cast<std::size_t>(std::clamp(capacity, 1, 1000)));
            found.resize(
                static_cast<std::size_t>(self.nearby(point, within_m, found.data(), static_cast<int>(found.size()))));
            return found;
          },
          py::arg("point"), py::arg("within_m"), py::arg("capacity") = 6,
          "Up to capacity MeshPoints within within_m, nearest first, with normals that differ.")
      .def_property_readonly("triangles", &TriangleMesh::triangles)
      .def_property_readonly("vertices", &TriangleMesh::vertices);
}

template <typename Geometry>
Fixture fixture(const std::string& name, Geometry geometry, bool soft) {
  Fixture made{name, std::move(geometry), soft};
  made.validate();
  return made;
}

/// As records hold it: a kind by its number and all its numbers in a row.
void bind_plain(py::class_<Fixture>& bound) {
  bound
      .def(py::init([](const std::string& name, bool soft, int kind, const std::vector<double>& numbers) {
             return fixture(name, to_geometry(kind, numbers), soft);
           }),
           py::kw_only(), py::arg("name"), py::arg("soft"), py::arg("kind"), py::arg("numbers"),
           "From a record: kind and numbers of another fixture. Raises ConfigError.")
      .def_property_readonly(
          "kind", [](const Fixture& self) { return static_cast<int>(self.geometry.index()); },
          "0 plane, 1 line, 2 path, 3 remote centre, 4 hull, 5 mesh")
      .def_property_readonly(
          "numbers", [](const Fixture& self) { return to_numbers(self.geometry); }, "of its geometry, in a row");
  bound.attr("_fields") = std::vector<std::string>{"name", "soft", "kind", "numbers"};
}

void bind_geometries(py::module_& m) {
  py::class_<Fixture> bound(m, "Fixture",
                            "One virtual fixture; make it with plane, line, path, remote_centre, hull, mesh.");
  bind_plain(bound);
  bound.def_readonly("name", &Fixture::name)
      .def_readonly("soft", &Fixture::soft)
      .def_static(
          "plane",
          [](const std::string& name, const Vector3& point, const Vector3& normal, double margin_m, bool soft) {
            return fixture(name, PlaneFixture{point, normal, margin_m}, soft);
          },
          py::arg("name"), py::arg("point"), py::arg("normal"), py::arg("margin_m") = 0.0, py::arg("soft") = false,
          "The tip stays margin_m on the side of the unit normal (3,).")
      .def_static(
          "line",
          [](const std::string& name, const Vector3& point, const Vector3& direction, double radius_m, bool soft) {
            return fixture(name, LineFixture{point, direction, radius_m}, soft);
          },
          py::arg("name"), py::arg("point"), py::arg("direction"), py::arg("radius_m") = 0.0, py::arg("soft") = false,
          "The tip stays within radius_m of a line.")
      .def_static(
          "path",
          [](const std::string& name, const std::vector<Vector3>& points, double radius_m, bool soft) {
            return fixture(name, PathFixture{points, radius_m}, soft);
          },
          py::arg("name"), py::arg("points"), py::arg("radius_m") = 0.001, py::arg("soft") = false,
          "The tip stays within radius_m of a polyline (n, 3) and may move along it.")
      .def_static(
          "remote_centre",
          [](const std::string& name, const Vector3& centre, double tolerance_m, bool soft) {
            return fixture(name, RemoteCentreFixture{centre, tolerance_m}, soft);
          },
          py::arg("name"), py::arg("centre"), py::arg("tolerance_m") = 0.0, py::arg("soft") = false,
          "The shaft passes the point (3,) within tolerance_m.")
      .def_static(
          "hull",
          [](const std::string& name, const Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>& faces,
             bool keep_in, double margin_m, bool soft) {
            return fixture(name, HullFixture{faces, keep_in, margin_m, 0.0005}, soft);
          },
          py::arg("name"), py::arg("faces"), py::arg("keep_in") = true, py::arg("margin_m") = 0.0,
          py::arg("soft") = false,
          "faces: (n, 4) outward unit normal and offset, inside is n.x <= offset; see saras.csa.convex_hull.")
      .def_static(
          "mesh",
          [](const std::string& name, const std::shared_ptr<TriangleMesh>& mesh, bool keep_in, double margin_m,
             double reach_m, bool soft) {
            return fixture(name, MeshFixture{mesh, keep_in, margin_m, reach_m}, soft);
          },
          py::arg("name"), py::arg("mesh"), py::arg("keep_in") = false, py::arg("margin_m") = 0.0,
          py::arg("reach_m") = 0.005, py::arg("soft") = false,
          "The tip stays margin_m outside (keep_in: inside) a TriangleMesh. All raise ConfigError.");
}

void bind_set(py::module_& m) {
  using O = FixtureOutput;
  py::class_<O>(m, "FixtureOutput", "Result of FixtureSet.step; goes into the controllers as `fixtures`.")
      .def_property_readonly(
          "rows",
          [](const O& output) {
            QpSolver::RowMajor rows(output.rows.count, 8);
            for (int i = 0; i < output.rows.count; ++i) {
              const FixtureRow& row = output.rows.rows[static_cast<std::size_t>(i)];
              rows.row(i) << row.axis.transpose(), row.lower_m, row.upper_m;
            }
            return rows;
          },
          "(m, 8) axis on the tip's displacement and rotation vector, lower, upper [m]")
      .def_property_readonly(
          "row_fixtures",
          [](const O& output) {
            std::vector<int> fixtures;
            for (const FixtureRow& row : output.rows) {
              fixtures.push_back(row.fixture);
            }
            return fixtures;
          },
          "the fixture of each row")
      .def_property_readonly(
          "distance_m", [](const O& output) { return output.distance_m; },
          "of each fixture to its border, 16 numbers; negative: violated; NaN: no such fixture")
      .def_readonly("nearest", &O::nearest, "fixture with the least distance; -1: none")
      .def_property_readonly(
          "closest", [](const O& output) { return output.closest; }, "(3,) its closest point, base frame")
      .def_property_readonly(
          "normal", [](const O& output) { return output.normal; }, "(3,) towards what is allowed")
      .def_readonly("status", &O::status, "LIMITED: something is violated");
  using S = FixtureState;
  Struct<S>(m, "FixtureState", "Face, triangle or segment of each fixture, plus 1.").field("feature", &S::feature, "");
  py::class_<FixtureSet>(m, "FixtureSet", "All virtual fixtures of one tool, as rows on its motion.")
      .def(py::init<std::vector<Fixture>>(), py::arg("fixtures"), "At most 16. Raises ConfigError.")
      .def(
          "step",
          [](FixtureSet& self, const Pose& base_T_tip, Seconds dt, const Vector3& shaft, const Pose& base_T_fixtures) {
            return self.step({base_T_tip, shaft, base_T_fixtures}, dt);
          },
          py::arg("base_T_tip"), py::arg("dt"), py::arg("shaft") = Vector3(0.0, 0.0, 1.0),
          py::arg("base_T_fixtures") = Pose{},
          "base_T_tip: (4, 4); shaft: (3,) unit from trocar to tip, base axes; base_T_fixtures: (4, 4).")
      .def("reset", &FixtureSet::reset, py::arg("state") = S{})
      .def_property_readonly("state", [](const FixtureSet& self) { return self.state(); })
      .def_property_readonly("names", [](const FixtureSet& self) {
        std::vector<std::string> names;
        for (const Fixture& one : self.fixtures()) {
          names.push_back(one.name);
        }
        return names;
      });
}

}  // namespace

void bind_csa_fixtures(py::module_& m) {
  bind_mesh(m);
  bind_geometries(m);
  bind_set(m);
}

}  // namespace saras::bindings
