#include "bind_collision.hpp"

#include <utility>

#include "rooms.hpp"

namespace saras::bindings {
namespace {

py::object index_or_none(Partner partner, int index) {
  return partner == Partner::kNone ? py::object(py::none()) : py::int_(index);
}

void bind_scene(py::module_& m) {
  py::enum_<Partner>(m, "Partner", "What a distance is to.")
      .value("NONE", Partner::kNone)
      .value("TOOL", Partner::kTool)
      .value("REGION", Partner::kRegion);
  using D = ToolDistance;
  py::class_<D>(m, "ToolDistance", "The nearest known thing to one tool, and what is not known.")
      .def_property_readonly(
          "distance", [](const D& d) { return d.distance.distance_m; },
          "[m]; NaN when nothing is known. To what is known only: see the flags.")
      .def_property_readonly(
          "point_a", [](const D& d) { return d.distance.point_a; }, "(3,) on the tool [m]")
      .def_property_readonly(
          "point_b", [](const D& d) { return d.distance.point_b; }, "(3,) on the other [m]")
      .def_property_readonly(
          "normal", [](const D& d) { return d.distance.normal; }, "(3,) unit, from the tool towards the other")
      .def_property_readonly("status", [](const D& d) { return d.distance.status; })
      .def_readonly("partner", &D::partner, "TOOL, REGION, or NONE")
      .def_property_readonly(
          "index", [](const D& d) { return index_or_none(d.partner, d.index); }, "of that tool or region")
      .def_readonly("tool_unknown", &D::tool_unknown, "this tool is not known")
      .def_readonly("other_tool_unknown", &D::other_tool_unknown, "another tool is not known")
      .def_readonly("regions_unknown", &D::regions_unknown, "where the regions are is not known");
  py::class_<Scene>(m, "Scene", "Tools among regions that one rigid transform moves.")
      .def(
          py::init([](int tools, const py::object& regions) { return Scene(tools, shapes_of(load_regions(regions))); }),
          py::arg("tools"), py::arg("regions") = py::tuple(),
          "tools: how many. regions: (n, 8, 3) [m] in their own frame. Raises ConfigError naming the region.")
      .def(
          "distances",
          [](Scene& self, const py::sequence& tools, const Pose& base_T_regions, bool regions_known) {
            return self.distances(load_tools(tools), base_T_regions, regions_known);
          },
          py::arg("tools"), py::arg("base_T_regions") = Pose{}, py::arg("regions_known") = true,
          "One ToolDistance a tool. tools: (a (3,), b (3,), radius) [m], Capsule, or None (not known).")
      .def_property_readonly("tools", [](const Scene& self) { return self.tools(); })
      .def_property_readonly("regions", [](const Scene& self) { return self.regions(); });
}

}  // namespace

std::vector<SceneTool> load_tools(const py::sequence& source) {
  std::vector<SceneTool> tools;
  for (const auto& item : source) {
    if (item.is_none()) {
      tools.push_back({Capsule{}, false});
    } else if (py::isinstance<Capsule>(item)) {
      tools.push_back({item.cast<Capsule>(), true});
    } else if (py::len(item) == 7) {
      const auto row = item.cast<Eigen::Matrix<double, 7, 1>>();
      tools.push_back({Capsule{row.head<3>(), row.segment<3>(3), row[6]}, row.allFinite()});
    } else {
      const auto [a, b, radius_m] = item.cast<std::tuple<Vector3, Vector3, double>>();
      tools.push_back({Capsule{a, b, radius_m}, true});
    }
  }
  return tools;
}

void bind_collision(py::module_& m) {
  bind_collision_shapes(m);
  bind_scene(m);
  bind_collision_laws(m);
}

}  // namespace saras::bindings
