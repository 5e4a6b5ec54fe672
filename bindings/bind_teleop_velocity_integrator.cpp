#include "law.hpp"
#include "saras/teleop/velocity_integrator.hpp"

namespace saras::bindings {
namespace {

void bind_config(py::module_& m) {
  using Config = VelocityIntegratorConfig;
  Struct<Config>(m, "VelocityIntegratorConfig", "Bounds of a VelocityIntegrator.")
      .field("speed_limit_m_s", &Config::speed_limit_m_s, "no set-point step is longer than this times dt [m/s]")
      .field("speed_limit_rad_s", &Config::speed_limit_rad_s, "the same for rotation [rad/s]")
      .field("lead_limit_m", &Config::lead_limit_m, "set-point ahead of measured [m]")
      .field("lead_limit_rad", &Config::lead_limit_rad, "set-point ahead of measured [rad]")
      .field("cone_axis", &Config::cone_axis, "(3,) unit, base frame: from the trocar into the patient")
      .field("cone_half_angle_rad", &Config::cone_half_angle_rad, "(0, pi/2) [rad]")
      .field("insertion_min_m", &Config::insertion_min_m, "least distance trocar - tip [m]")
      .field("insertion_max_m", &Config::insertion_max_m, "greatest distance trocar - tip [m]")
      .field("measured_jump_m", &Config::measured_jump_m, "measured further than this from the last is refused [m]")
      .field("shaft_through_rcm", &Config::shaft_through_rcm,
             "orientation follows from the trocar; only roll is taken from the twist")
      .field("nominal_dt_s", &Config::nominal_dt_s, "one period: the first step, and the most after a stall [s]")
      .field("dt_max_s", &Config::dt_max_s, "a longer time step is a stall [s]");
}

void bind_output(py::module_& m) {
  using Output = VelocityIntegratorOutput;
  Struct<Output>(m, "VelocityIntegratorOutput", "Result of VelocityIntegrator.step.")
      .field("has_set_point", &Output::has_set_point, "false until a measured pose was seen: send nothing")
      .field("set_point", &Output::set_point, "(4, 4) base_T_tip, always finite")
      .field("lead_m", &Output::lead_m, "distance set-point - measured [m]")
      .field("speed_limited", &Output::speed_limited, "command above the speed limit")
      .field("approach_limited", &Output::approach_limited, "command above the approach limit")
      .field("lead_limited", &Output::lead_limited, "set-point too far ahead of measured")
      .field("cone_limited", &Output::cone_limited, "at the edge of the cone")
      .field("insertion_limited", &Output::insertion_limited, "at the least or greatest insertion")
      .field("fixture_limited", &Output::fixture_limited, "at a virtual fixture")
      .field("measured_jumped", &Output::measured_jumped, "measured pose refused")
      .field("status", &Output::status, "saras.Status");
}

}  // namespace

void bind_velocity_integrator(py::module_& m) {
  bind_config(m);
  bind_output(m);
  Struct<VelocityIntegratorState>(m, "VelocityIntegratorState", "All that a VelocityIntegrator remembers.")
      .field("started", &VelocityIntegratorState::started, "whether a measured pose was seen")
      .field("set_point", &VelocityIntegratorState::set_point, "(4, 4) last set-point")
      .field("measured_position", &VelocityIntegratorState::measured_position, "(3,) last accepted [m]");
  py::class_<VelocityIntegrator>(m, "VelocityIntegrator", "From a twist to the arm's set-point, within hard bounds.")
      .def(py::init<VelocityIntegratorConfig>(), py::arg("config") = VelocityIntegratorConfig{})
      .def(
          "step",
          [](VelocityIntegrator& self, const Twist& twist, const Pose& measured_pose, const Vector3& rcm, double dt,
             bool stale, double max_speed_scale, const std::optional<Vector3>& approach_direction,
             double approach_speed_limit_m_s) {
            return self.step({twist, measured_pose, rcm, stale, max_speed_scale,
                              approach_direction.value_or(Vector3::Zero()), approach_speed_limit_m_s},
                             dt);
          },
          py::arg("twist"), py::arg("measured_pose"), py::arg("rcm"), py::arg("dt"), py::arg("stale") = false,
          py::arg("max_speed_scale") = 1.0, py::arg("approach_direction") = py::none(),
          py::arg("approach_speed_limit_m_s") = std::numeric_limits<double>::infinity(),
          "One tick; everything in the arm's base frame.\n\n"
          "twist: (6,) of the tip. measured_pose: (4, 4). rcm: (3,) trocar [m]. dt: since the previous step [s].\n"
          "stale: the twist is older than its limit (taken as zero). max_speed_scale: 0..1 of both speed limits.\n"
          "approach_direction: (3,) towards what is near; approach_speed_limit_m_s: along it, retreat is free.")
      .def("reset", &VelocityIntegrator::reset, py::arg("state") = VelocityIntegratorState{},
           "Without argument: starts from measured again.")
      .def_property_readonly("config", [](const VelocityIntegrator& self) { return self.config(); })
      .def_property_readonly("state", [](const VelocityIntegrator& self) { return self.state(); });
}

}  // namespace saras::bindings
