#include "bind_csa.hpp"
#include "saras/csa/fixture_force.hpp"
#include "saras/csa/fixture_integrator.hpp"

namespace saras::bindings {
namespace {

using namespace csa;

void bind_values(py::module_& m) {
  using F = TeleopFixture;
  Struct<F>(m, "TeleopFixture",
            "A fixture of ordinary teleoperation, in the arm's base frame.\n\n"
            "A hard one is a wall for the set-point and the hand; a soft one only tells the hand.")
      .field("fixture", &F::fixture, "saras.csa.Fixture, any but a remote centre")
      .field("stiffness_N_m", &F::stiffness_N_m, "force on the hand per metre nearer than start_m [N/m]")
      .field("start_m", &F::start_m, "the force begins this far on the allowed side [m]");
  using W = FixtureWord;
  Struct<W>(m, "FixtureWord", "What holds at the moment of all fixtures of a side.")
      .field("on", &W::on, "switched off: neither wall nor force")
      .field("known", &W::known, "whether it is known where they are; if not, the set-point stands");
  using C = FixtureForceConfig;
  Struct<C>(m, "FixtureForceConfig", "Limits of a FixtureForce.")
      .field("force_limit_N", &C::force_limit_N, "of one fixture, and of all together [N]")
      .field("ramp_s", &C::ramp_s, "the force moves by at most its limit in this time [s]")
      .field("dt_max_s", &C::dt_max_s, "longest time step [s]");
  using O = FixtureForceOutput;
  Struct<O>(m, "FixtureForceOutput", "Result of FixtureForce.step.")
      .field("wrench", &O::wrench, "(6,) on the operator's hand, base axes")
      .field("distance_m", &O::distance_m,
             "of the tip to each border, 16 numbers; negative: passed; NaN: unknown, none")
      .field("nearest", &O::nearest, "fixture with the least distance; -1: none")
      .field("closest", &O::closest, "(3,) its closest point, base frame [m]")
      .field("normal", &O::normal, "(3,) its direction towards what is allowed")
      .field("violation_m", &O::violation_m, "how far the tip is beyond the nearest border [m]")
      .field("status", &O::status, "saras.Status; LIMITED: a force is due; WAITING: none is there, or they are off");
}

void bind_force(py::module_& m) {
  using S = FixtureForceState;
  Struct<S>(m, "FixtureForceState", "All that a FixtureForce remembers.")
      .field("force", &S::force, "(3,) [N]")
      .field("fixtures", &S::fixtures, "FixtureState");
  py::class_<FixtureForce>(m, "FixtureForce", "What the hand feels of virtual fixtures.")
      .def(py::init<FixtureForceConfig, const std::vector<TeleopFixture>&>(), py::arg("config"), py::arg("fixtures"),
           "At most 16 TeleopFixture. Raises ConfigError.")
      .def(
          "step",
          [](FixtureForce& self, const Pose& base_T_tip, Seconds dt, const std::optional<Vector3>& hand_ahead,
             bool fixtures_on, bool fixtures_known) {
            return self.step({base_T_tip, hand_ahead.value_or(Vector3::Zero()), {fixtures_on, fixtures_known}}, dt);
          },
          py::arg("base_T_tip"), py::arg("dt"), py::arg("hand_ahead") = py::none(), py::arg("fixtures_on") = true,
          py::arg("fixtures_known") = true,
          "base_T_tip: (4, 4) measured; dt: since the last step [s]; hand_ahead: (3,) from the tip to where the hand\n"
          "wants it [m]; fixtures_on, fixtures_known: as FixtureWord.")
      .def(
          "reset", [](FixtureForce& self, const S& state) { self.reset(state); }, py::arg("state") = S{})
      .def_property_readonly("config", [](const FixtureForce& self) { return self.config(); })
      .def_property_readonly("state", [](const FixtureForce& self) { return self.state(); });
}

void bind_integrator(py::module_& m) {
  using S = FixtureIntegratorState;
  Struct<S>(m, "FixtureIntegratorState", "All that a FixtureIntegrator remembers.")
      .field("integrator", &S::integrator, "saras.teleop.VelocityIntegratorState")
      .field("fixtures", &S::fixtures, "FixtureState");
  py::class_<FixtureIntegrator>(
      m, "FixtureIntegrator",
      "saras.teleop.VelocityIntegrator whose set-point does not pass hard fixtures; without one it is that law.")
      .def(py::init<VelocityIntegratorConfig, const std::vector<TeleopFixture>&>(), py::arg("config"),
           py::arg("fixtures"), "config: saras.teleop.VelocityIntegratorConfig. Raises ConfigError.")
      .def(
          "step",
          [](FixtureIntegrator& self, const Twist& twist, const Pose& measured_pose, const Vector3& rcm, double dt,
             bool stale, double max_speed_scale, const std::optional<Vector3>& approach_direction,
             double approach_speed_limit_m_s, bool fixtures_on, bool fixtures_known) {
            return self.step({{twist, measured_pose, rcm, stale, max_speed_scale,
                               approach_direction.value_or(Vector3::Zero()), approach_speed_limit_m_s},
                              {fixtures_on, fixtures_known}},
                             dt);
          },
          py::arg("twist"), py::arg("measured_pose"), py::arg("rcm"), py::arg("dt"), py::arg("stale") = false,
          py::arg("max_speed_scale") = 1.0, py::arg("approach_direction") = py::none(),
          py::arg("approach_speed_limit_m_s") = std::numeric_limits<double>::infinity(), py::arg("fixtures_on") = true,
          py::arg("fixtures_known") = true,
          "As VelocityIntegrator.step; fixtures_on, fixtures_known: as FixtureWord. Gives a\n"
          "saras.teleop.VelocityIntegratorOutput, fixture_limited where a fixture held it back.")
      .def(
          "reset", [](FixtureIntegrator& self, const S& state) { self.reset(state); }, py::arg("state") = S{},
          "Without argument: starts from measured again.")
      .def_property_readonly("config", [](const FixtureIntegrator& self) { return self.config(); })
      .def_property_readonly("state", [](const FixtureIntegrator& self) { return self.state(); });
}

}  // namespace

void bind_csa_teleop_fixtures(py::module_& m) {
  bind_values(m);
  bind_force(m);
  bind_integrator(m);
}

}  // namespace saras::bindings
