#include "bind_csa.hpp"
#include "saras/csa/border_wrench.hpp"
#include "saras/csa/virtual_fixture.hpp"

namespace saras::bindings {

using namespace csa;

void bind_csa_border(py::module_& m) {
  using C = BorderWrenchConfig;
  Struct<C>(m, "BorderWrenchConfig", "Gains of BorderWrench. Raises ConfigError.")
      .field("stiffness_N_m", &C::stiffness_N_m, "[N/m]")
      .field("damping_N_s_m", &C::damping_N_s_m, "[N s/m]")
      .field("force_limit_N", &C::force_limit_N, "[N]")
      .field("dt_max_s", &C::dt_max_s, "longest time step [s]");
  using O = BorderWrenchOutput;
  Struct<O>(m, "BorderWrenchOutput", "Result of BorderWrench.step.")
      .field("wrench", &O::wrench, "(6,) on the hand, base axes")
      .field("way", &O::way, "(3,) shortest back to where all fixtures are obeyed; zero inside [m]")
      .field("status", &O::status, "LIMITED: cut at the limit, or fixtures that contradict each other");
  Struct<BorderWrenchState>(m, "BorderWrenchState", "Nothing is remembered.").cls().attr("_fields") = py::list();
  py::class_<BorderWrench>(m, "BorderWrench",
                           "What the hand feels of virtual fixtures: a one-sided spring back to where the tip may be.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](BorderWrench& self, const std::optional<FixtureOutput>& fixtures, const Vector3& velocity, Seconds dt) {
            return self.step({fixtures ? &fixtures->rows : nullptr, velocity}, dt);
          },
          py::arg("fixtures"), py::arg("velocity"), py::arg("dt"),
          "fixtures: FixtureOutput at the point that the hand leads, None: none; velocity: (3,) of that point, base\n"
          "axes. Rows of remote centres are left out.")
      .def("reset", &BorderWrench::reset, py::arg("state") = BorderWrenchState{})
      .def_property_readonly("config", [](const BorderWrench& self) { return self.config(); })
      .def_property_readonly("state", [](const BorderWrench& self) { return self.state(); });
}

}  // namespace saras::bindings
