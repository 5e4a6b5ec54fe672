#include "bind_csa.hpp"
#include "saras/csa/teleop_states.hpp"

namespace saras::bindings {
namespace {

using namespace csa;

void bind_table(py::module_& m) {
  py::enum_<ContactState>(m, "ContactState", "Who is in contact.")
      .value("NO_CONTACT", ContactState::kNoContact)
      .value("PROXY_CONTACT", ContactState::kProxyContact)
      .value("SLAVE_CONTACT", ContactState::kSlaveContact)
      .value("FULL_CONTACT", ContactState::kFullContact);
  py::enum_<Synchronisation>(m, "Synchronisation", "Whether the proxy goes to the slave.")
      .value("NEVER", Synchronisation::kNever)
      .value("ALWAYS", Synchronisation::kAlways)
      .value("WHEN_MISMATCHED", Synchronisation::kWhenMismatched);
  using T = ContactTransition;
  Struct<T>(m, "ContactTransition", "One row of the table of contact states.")
      .field("state", &T::state, "ContactState")
      .field("master_feels", &T::master_feels, "compliance wrench; else zero")
      .field("mode", &T::mode, "SlaveMode")
      .field("synchronise", &T::synchronise, "Synchronisation");
  m.def("contact_transition", &contact_transition, py::arg("from_state"), py::arg("slave_contact"),
        py::arg("proxy_contact"), "The table of contact states: pure.");
  using D = ContactDetector;
  Struct<D>(m, "ContactDetector", "A contact with hysteresis and debounce.")
      .field("contact", &D::contact, "")
      .field("pending_s", &D::pending_s, "for how long the signal has said otherwise [s]");
}

void bind_structs(py::module_& m) {
  using C = CsaTeleopConfig;
  Struct<C>(m, "CsaTeleopConfig", "Thresholds, forces and ramp of CsaTeleop. Raises ConfigError.")
      .field("scale", &C::scale, "slave metres per master metre")
      .field("contact_on_N", &C::contact_on_N, "[N]")
      .field("contact_off_N", &C::contact_off_N, "[N]")
      .field("proxy_on_m", &C::proxy_on_m, "depth in the model [m]")
      .field("proxy_off_m", &C::proxy_off_m, "[m]")
      .field("debounce_s", &C::debounce_s, "[s]")
      .field("stiffness_N_m", &C::stiffness_N_m, "k_d [N/m]")
      .field("desired_force_N", &C::desired_force_N, "F_d in FULL_CONTACT [N]")
      .field("force_cap_N", &C::force_cap_N, "largest F_d [N]")
      .field("mismatch_tolerance_m", &C::mismatch_tolerance_m, "[m]")
      .field("force_limit_N", &C::force_limit_N, "largest force on the hand [N]")
      .field("torque_limit_Nm", &C::torque_limit_Nm, "[N m]")
      .field("ramp_s", &C::ramp_s, "from nothing to the limit at the fastest [s]")
      .field("dt_max_s", &C::dt_max_s, "longest time step [s]");
  using O = CsaTeleopOutput;
  Struct<O>(m, "CsaTeleopOutput", "Result of CsaTeleop.step.")
      .field("state", &O::state, "ContactState")
      .field("desired", &O::desired, "(4, 4) x_d, for slave and proxy")
      .field("hold", &O::hold, "nobody moves")
      .field("synchronise", &O::synchronise, "set the proxy to the slave before it steps")
      .field("mode", &O::mode, "SlaveMode")
      .field("normal", &O::normal, "(3,) for the slave; zero: along its force")
      .field("desired_force_N", &O::desired_force_N, "[N]")
      .field("wrench", &O::wrench, "(6,) on the hand, ramped")
      .field("mismatch_m", &O::mismatch_m, "slave to proxy, after synchronisation [m]")
      .field("status", &O::status, "Status");
  using S = CsaTeleopState;
  Struct<S>(m, "CsaTeleopState", "What CsaTeleop remembers.")
      .field("state", &S::state, "ContactState")
      .field("slave", &S::slave, "ContactDetector")
      .field("proxy", &S::proxy, "ContactDetector")
      .field("has_reference", &S::has_reference, "")
      .field("master_reference", &S::master_reference, "(4, 4)")
      .field("slave_reference", &S::slave_reference, "(4, 4)")
      .field("wrench", &S::wrench, "(6,)");
}

}  // namespace

void bind_csa_teleop(py::module_& m) {
  bind_table(m);
  bind_structs(m);
  py::class_<CsaTeleop>(m, "CsaTeleop",
                        "Contact states of slave and proxy, what each means for both ends, mismatch correction.")
      .def(py::init<CsaTeleopConfig>(), py::arg("config") = CsaTeleopConfig{})
      .def(
          "step",
          [](CsaTeleop& self, const Pose& master_pose, const Pose& slave_pose, const Pose& proxy_pose, Seconds dt,
             const std::optional<double>& slave_force_N, const std::optional<double>& proxy_depth_m,
             const Vector3& proxy_normal, const Wrench& compliance_wrench, bool clutch, bool enabled, bool stale,
             const Wrench& fixture_wrench) {
            CsaTeleopInput input;
            input.master_pose = master_pose;
            input.slave_pose = slave_pose;
            input.proxy_pose = proxy_pose;
            input.force_known = slave_force_N.has_value();
            input.slave_force_N = slave_force_N.value_or(0.0);
            input.model_known = proxy_depth_m.has_value();
            input.proxy_depth_m = proxy_depth_m.value_or(0.0);
            input.proxy_normal = proxy_normal;
            input.compliance_wrench = compliance_wrench;
            input.fixture_wrench = fixture_wrench;
            input.clutch = clutch;
            input.enabled = enabled;
            input.stale = stale;
            return self.step(input, dt);
          },
          py::arg("master_pose"), py::arg("slave_pose"), py::arg("proxy_pose"), py::arg("dt"), py::arg("slave_force_N"),
          py::arg("proxy_depth_m"), py::arg("proxy_normal"), py::arg("compliance_wrench"), py::arg("clutch") = false,
          py::arg("enabled") = true, py::arg("stale") = false, py::arg("fixture_wrench") = Wrench{},
          "One tick, the slave's base axes. Poses: (4, 4) of handle, slave's set-point, proxy. slave_force_N: norm of\n"
          "the filtered contact force, None: unknown. proxy_depth_m: in the model, negative outside, None: no model.\n"
          "proxy_normal: (3,) outward. compliance_wrench: (6,) from the proxy's interaction.\n"
          "fixture_wrench: (6,) of BorderWrench, felt in every state.")
      .def("reset", &CsaTeleop::reset, py::arg("state") = CsaTeleopState{})
      .def_property_readonly("config", [](const CsaTeleop& self) { return self.config(); })
      .def_property_readonly("state", [](const CsaTeleop& self) { return self.state(); });
}

}  // namespace saras::bindings
