#include "bind_collision.hpp"
#include "saras/collision/forbidden_regions.hpp"

namespace saras::bindings {
namespace {

Array load_shape(const py::object& source, const char* expected, py::ssize_t dimensions) {
  const Array array = Array::ensure(source);
  bool fits = array && array.ndim() == dimensions;
  fits = fits && array.shape(dimensions - 2) == 8 && array.shape(dimensions - 1) == 3;
  if (!fits) {
    PyErr_Clear();
    throw py::value_error(std::string("vertices: expected shape ") + expected + ", got " +
                          (array ? shape_text(array) : std::string("no array")));
  }
  return array;
}

Corners corners_from(const double* numbers) {
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = Eigen::Map<const Vector3>(numbers + 3 * i);
  }
  return corners;
}

void bind_parallelepiped(py::module_& m) {
  py::class_<Parallelepiped>(m, "Parallelepiped",
                             "A box, or a skewed box. Corners (8, 3) in the source's order: v1, v4, v3 are the\n"
                             "neighbours of v0 along x, y, z; edges 0-1 1-2 2-3 3-0 0-4 4-7 7-3 4-5 5-6 6-7 1-5 2-6.")
      .def(py::init([](const py::object& vertices) { return Parallelepiped::from_corners(load_corners(vertices)); }),
           py::arg("vertices"),
           "vertices: (8, 3) [m]. Raises ConfigError: not finite, zero volume, does not close (1e-6 m).")
      .def_property_readonly("vertices", [](const Parallelepiped& self) { return store_corners(self.corners()); })
      .def_property_readonly("center", [](const Parallelepiped& self) { return self.center(); })
      .def_property_readonly("rectangular", [](const Parallelepiped& self) { return self.rectangular(); })
      .def_property_readonly("volume", [](const Parallelepiped& self) { return self.volume(); })
      .def("__repr__", [](const Parallelepiped& self) {
        return std::string("Parallelepiped(") + (self.rectangular() ? "rectangular" : "skewed") + ", center " +
               py::repr(py::cast(self.center())).cast<std::string>() + ", volume " + std::to_string(self.volume()) +
               ")";
      });
}

void bind_distances(py::module_& m) {
  py::enum_<DistanceStatus>(m, "DistanceStatus", "What a SignedDistance says.")
      .value("SEPARATED", DistanceStatus::kSeparated)
      .value("TOUCHING", DistanceStatus::kTouching)
      .value("PENETRATING", DistanceStatus::kPenetrating)
      .value("UNKNOWN", DistanceStatus::kUnknown);
  using D = SignedDistance;
  Struct<D>(m, "SignedDistance",
            "Distance of b from a; negative: minus the least translation that separates. NaN everywhere: UNKNOWN.\n"
            "point_b = point_a + distance * normal.")
      .field("distance", &D::distance_m, "[m]")
      .field("point_a", &D::point_a, "(3,) on the surface of a [m]")
      .field("point_b", &D::point_b, "(3,) on the surface of b [m]")
      .field("normal", &D::normal, "(3,) unit, from a towards b")
      .field("status", &D::status, "DistanceStatus");
  m.def(
      "capsule_capsule",
      [](const Vector3& a0, const Vector3& a1, double ra, const Vector3& b0, const Vector3& b1, double rb) {
        return distance(Capsule{a0, a1, ra}, Capsule{b0, b1, rb});
      },
      py::arg("a0"), py::arg("a1"), py::arg("ra"), py::arg("b0"), py::arg("b1"), py::arg("rb"),
      "Signed distance of two capsules: ends of the axes (3,) [m], radii [m]. Input that is not finite gives UNKNOWN.");
  m.def(
      "capsule_parallelepiped",
      [](const Vector3& a0, const Vector3& a1, double r, const Parallelepiped& region) {
        return distance(Capsule{a0, a1, r}, region);
      },
      py::arg("a0"), py::arg("a1"), py::arg("r"), py::arg("region"),
      "Signed distance of a capsule (a) from a region (b) that was checked before: for loops.");
  m.def(
      "capsule_parallelepiped",
      [](const Vector3& a0, const Vector3& a1, double r, const py::object& vertices) {
        return distance(Capsule{a0, a1, r}, Parallelepiped::from_corners(load_corners(vertices)));
      },
      py::arg("a0"), py::arg("a1"), py::arg("r"), py::arg("vertices"),
      "Signed distance of a capsule (a), ends of the axis (3,) and radius [m], from a parallelepiped (b) of eight\n"
      "vertices (8, 3) [m]. A capsule that is not finite gives UNKNOWN; vertices that are none raise ConfigError.");
}

void bind_regions(py::module_& m) {
  const VerticesFileOptions defaults;
  m.def(
      "read_vertices",
      [](const std::string& path, double scale, const Pose& marker_T_file, std::uint64_t max_bytes,
         std::uint64_t max_count) {
        return store_regions(read_vertices(path, {scale, marker_T_file, max_bytes, max_count}));
      },
      py::arg("path"), py::arg("scale") = defaults.scale, py::arg("marker_T_file") = defaults.marker_T_file,
      py::arg("max_bytes") = defaults.max_bytes, py::arg("max_count") = defaults.max_count,
      "Regions (n, 8, 3) [m] of a vertices.txt: count, then eight lines 'x y z' a region.\n"
      "scale: metres per unit of the file; marker_T_file: (4, 4), applied after it. Raises ProtocolError naming line,\n"
      "value and bound; a file above max_bytes is refused unread.");
  m.def(
      "format_vertices", [](const py::object& regions) { return format_vertices(load_regions(regions)); },
      py::arg("regions"), "Text of a vertices.txt with all digits, from (n, 8, 3) [m].");
}

}  // namespace

Corners load_corners(const py::object& source) { return corners_from(load_shape(source, "(8, 3)", 2).data()); }

std::vector<Corners> load_regions(const py::object& source) {
  const Array any = Array::ensure(source);
  if (any && any.size() == 0) {
    return {};
  }
  PyErr_Clear();
  const Array array = load_shape(source, "(n, 8, 3)", 3);
  std::vector<Corners> regions;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    regions.push_back(corners_from(array.data() + 24 * i));
  }
  return regions;
}

Array store_corners(const Corners& corners) {
  Array array({8, 3});
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Eigen::Map<Vector3>(array.mutable_data() + 3 * i) = corners[i];
  }
  return array;
}

Array store_regions(const std::vector<Corners>& regions) {
  Array array({static_cast<py::ssize_t>(regions.size()), py::ssize_t{8}, py::ssize_t{3}});
  for (std::size_t i = 0; i < regions.size(); ++i) {
    for (std::size_t j = 0; j < 8; ++j) {
      Eigen::Map<Vector3>(array.mutable_data() + 24 * i + 3 * j) = regions[i][j];
    }
  }
  return array;
}

std::vector<Parallelepiped> shapes_of(const std::vector<Corners>& regions) {
  std::vector<Parallelepiped> shapes;
  shapes.reserve(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    try {
      shapes.push_back(Parallelepiped::from_corners(regions[i]));
    } catch (const ConfigError& error) {
      throw ConfigError("regions[" + std::to_string(i) + "]: " + error.what());
    }
  }
  return shapes;
}

void bind_collision_shapes(py::module_& m) {
  bind_parallelepiped(m);
  Struct<Capsule>(m, "Capsule", "All points within radius_m of the segment a - b.")
      .field("a", &Capsule::a, "(3,) one end of the axis, e.g. the tip [m]")
      .field("b", &Capsule::b, "(3,) the other end, e.g. the trocar [m]")
      .field("radius_m", &Capsule::radius_m, ">= 0 [m]");
  bind_distances(m);
  bind_regions(m);
}

}  // namespace saras::bindings
