#include "law.hpp"
#include "rooms.hpp"
#include "saras/contact/contact_force.hpp"

namespace saras::bindings {

void bind_contact(py::module_& m) {
  using C = ContactForceConfig;
  Struct<C>(m, "ContactForceConfig", "Of the tissue, and what is believed of a reading.")
      .field("stiffness_N_m", &C::stiffness_N_m, "K [N/m^exponent]")
      .field("exponent", &C::exponent, "n of depth^n; 1: a spring")
      .field("damping_N_s_m2", &C::damping_N_s_m2, "lambda of Hunt and Crossley [N s/m^(1+n)]; 0: none")
      .field("rate_cutoff_hz", &C::rate_cutoff_hz, "low-pass of the depth's rate [Hz]")
      .field("depth_limit_m", &C::depth_limit_m, "a deeper reading is not believed [m]")
      .field("force_limit_N", &C::force_limit_N, "beyond it there is no estimate (saturated) [N]")
      .field("age_limit_s", &C::age_limit_s, "an older reading gives no estimate [s]")
      .field("dt_max_s", &C::dt_max_s, "longest time step [s]");
  using O = ContactForceOutput;
  Struct<O>(m, "ContactForceOutput", "Result of ContactForce.step.")
      .field("has_estimate", &O::has_estimate, "false: unknown, which is not zero")
      .field("exerted", &O::exerted, "(6,) by the tool on the tissue, in the frame of the direction; NaN when unknown")
      .field("reaction", &O::reaction, "(3,) on the tool: its opposite [N]; NaN when unknown")
      .field("depth_m", &O::depth_m, "[m], >= 0; NaN when unknown")
      .field("age_s", &O::age_s, "of the reading behind it [s]")
      .field("status", &O::status, "WAITING, STALE, INVALID_INPUT, LIMITED (saturated): no estimate");
  using S = ContactForceState;
  Struct<S>(m, "ContactForceState", "The reading that is held.")
      .field("known", &S::known, "")
      .field("depth_m", &S::depth_m, "[m]")
      .field("rate_m_s", &S::rate_m_s, "[m/s]")
      .field("normal", &S::normal, "(3,) unit")
      .field("age_s", &S::age_s, "[s]");
  py::class_<ContactForce>(m, "ContactForce", "Force of a contact that a camera sees, held between its readings.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](ContactForce& self, Seconds dt, std::optional<double> depth_m, const std::optional<Vector3>& direction,
             Seconds age_s) {
            ContactForceInput input;
            input.is_new = depth_m.has_value();
            input.depth_m = depth_m.value_or(input.depth_m);
            input.direction = direction.value_or(input.direction);
            input.age_s = age_s;
            return self.step(input, dt);
          },
          py::arg("dt"), py::arg("depth_m") = py::none(), py::arg("direction") = py::none(), py::arg("age_s") = 0.0,
          "One tick. depth_m: a new reading [m], None: none came; direction: (3,) outward normal of the tissue, of "
          "any\n"
          "length but 0; age_s: of that reading. A depth of NaN says that it is not known.")
      .def("reset", &ContactForce::reset, py::arg("state") = S{})
      .def_property_readonly("config", [](const ContactForce& self) { return self.config(); })
      .def_property_readonly("state", [](const ContactForce& self) { return self.state(); });
}

}  // namespace saras::bindings
