#include "law.hpp"
#include "rooms.hpp"
#include "saras/sim/channel.hpp"
#include "saras/sim/operator.hpp"
#include "saras/sim/tissue.hpp"

namespace saras::bindings {

void bind_sim_arm(py::module_& m);

namespace {

void bind_operator(py::module_& m) {
  using C = OperatorConfig;
  Struct<C> config(m, "OperatorConfig", "A hand and the handle it holds. Presets: firm(), normal(), weak(), active().");
  config.field("stiffness_N_m", &C::stiffness_N_m, "of the hand around the intended position [N/m], >= 0")
      .field("damping_N_s_m", &C::damping_N_s_m, "of the hand [N s/m]; negative: an active hand")
      .field("hand_mass_kg", &C::hand_mass_kg, "[kg], > 0")
      .field("handle_mass_kg", &C::handle_mass_kg, "[kg], >= 0")
      .field("roll_stiffness_N_m_rad", &C::roll_stiffness_N_m_rad, "of the fingers [N m/rad], >= 0")
      .field("roll_damping_N_m_s_rad", &C::roll_damping_N_m_s_rad, "[N m s/rad]")
      .field("roll_inertia_kg_m2", &C::roll_inertia_kg_m2, "[kg m^2], > 0")
      .field("workspace_centre_m", &C::workspace_centre_m, "(3,) of the mechanical stops [m]")
      .field("workspace_radius_m", &C::workspace_radius_m, "inelastic stop [m], > 0")
      .field("speed_max_m_s", &C::speed_max_m_s, "no hand is faster [m/s], > 0")
      .field("dt_max_s", &C::dt_max_s, "longest step [s], > 0");
  config.cls()
      .def_static("firm", &C::firm, "400 N/m, 15 N s/m, 0.8 kg")
      .def_static("normal", &C::normal, "200 N/m, 6 N s/m, 0.4 kg")
      .def_static("weak", &C::weak, "50 N/m, 1 N s/m, 0.15 kg")
      .def_static("active", &C::active, "weak with negative damping: feeds every motion, for adversarial tests");
  Struct<OperatorOutput>(m, "OperatorOutput", "Result of Operator.step.")
      .field("position", &OperatorOutput::position, "(3,) of the handle, console frame [m]")
      .field("velocity", &OperatorOutput::velocity, "(3,) [m/s]")
      .field("roll", &OperatorOutput::roll, "[rad]")
      .field("roll_rate", &OperatorOutput::roll_rate, "[rad/s]")
      .field("status", &OperatorOutput::status, "saras.Status; LIMITED at a stop");
  Struct<OperatorState>(m, "OperatorState", "All that an Operator remembers.")
      .field("position", &OperatorState::position, "(3,) [m]")
      .field("velocity", &OperatorState::velocity, "(3,) [m/s]")
      .field("roll", &OperatorState::roll, "[rad]")
      .field("roll_rate", &OperatorState::roll_rate, "[rad/s]");
  py::class_<Operator>(
      m, "Operator",
      "A hand around an intended motion, holding the handle's mass: m x'' = k (x_i - x) + b (x_i' - x') + F,\n"
      "exact for inputs held over dt, so that force moves the hand.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](Operator& self, const Vector3& force, const Vector3& position, double dt, const Vector3& velocity,
             double roll_torque, double roll) {
            return self.step({force, roll_torque, position, velocity, roll}, dt);
          },
          py::arg("force"), py::arg("intended_position"), py::arg("dt"),
          py::arg("intended_velocity") = Vector3(Vector3::Zero()), py::arg("roll_torque") = 0.0,
          py::arg("intended_roll") = 0.0,
          "One tick. force (3,) [N] and roll_torque [N m] are what the handle exerts on the hand; intended motion (3,) "
          "[m],\n"
          "(3,) [m/s] and roll [rad] in the console frame; dt [s].")
      .def("reset", &Operator::reset, py::arg("state") = OperatorState{})
      .def_property_readonly("config", [](const Operator& self) { return self.config(); })
      .def_property_readonly("state", [](const Operator& self) { return self.state(); });
}

void bind_tissue(py::module_& m) {
  using C = TissueConfig;
  Struct<C>(m, "TissueConfig", "Soft tissue with a stiff Gaussian inclusion under a plane or spherical surface.")
      .field("base_T_surface", &C::base_T_surface, "(4, 4) origin on the surface, z = outward normal there")
      .field("curvature_1_m", &C::curvature_1_m, "1 / radius, > 0 bulges outward, 0 plane [1/m]")
      .field("stiffness_N_m", &C::stiffness_N_m, "K away from the inclusion [N/m^exponent], > 0")
      .field("inclusion_stiffness_N_m", &C::inclusion_stiffness_N_m, "K at its centre [N/m^exponent], > 0")
      .field("inclusion_x_m", &C::inclusion_x_m, "its centre, surface frame [m]")
      .field("inclusion_y_m", &C::inclusion_y_m, "[m]")
      .field("inclusion_radius_m", &C::inclusion_radius_m, "its standard deviation [m], > 0")
      .field("exponent", &C::exponent, "n of depth^n, 1 to 3")
      .field("damping_N_s_m2", &C::damping_N_s_m2, "lambda [N s/m^(1+n)], >= 0")
      .field("friction", &C::friction, "Coulomb coefficient, >= 0")
      .field("friction_speed_m_s", &C::friction_speed_m_s, "below it friction is viscous [m/s], > 0")
      .field("skin_stiffness_N_m", &C::skin_stiffness_N_m, "of the abdominal wall at the trocar [N/m], >= 0")
      .field("force_noise_N", &C::force_noise_N, "standard deviation of the sensor's noise per axis [N], >= 0")
      .field("seed", &C::seed, "of the noise");
  Struct<TissueOutput>(m, "TissueOutput", "Result of Tissue.step.")
      .field("wrench", &TissueOutput::wrench, "(6,) that the tool exerts on the tissue, base frame [N, N m]")
      .field("measured_wrench", &TissueOutput::measured_wrench, "(6,) the same with the sensor's noise")
      .field("skin_force", &TissueOutput::skin_force, "(3,) that the shaft exerts on the trocar's skin [N]")
      .field("normal", &TissueOutput::normal, "(3,) outward, base frame; zero when the input was bad")
      .field("depth", &TissueOutput::depth, "indentation [m]; negative: distance to the surface")
      .field("stiffness", &TissueOutput::stiffness, "K under the tip")
      .field("stored_energy_J", &TissueOutput::stored_energy_J, "elastic energy of the dent [J]")
      .field("contact", &TissueOutput::contact, "whether depth > 0")
      .field("status", &TissueOutput::status, "saras.Status");
  py::class_<Tissue>(m, "Tissue", "Hunt-Crossley contact with a stiffness field; never pulls, never makes energy.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](Tissue& self, const Vector3& position, const Vector3& velocity, double dt, const Vector3& deviation) {
            return self.step({position, velocity, deviation}, dt);
          },
          py::arg("tip_position"), py::arg("tip_velocity"), py::arg("dt"),
          py::arg("trocar_deviation") = Vector3(Vector3::Zero()),
          "One tick: tip (3,) [m] and its velocity (3,) [m/s] in the base frame, dt [s], the shaft's deviation from "
          "the\n"
          "trocar (3,) [m].")
      .def("reset", [](Tissue& self) { self.reset(); })
      .def_property_readonly("config", [](const Tissue& self) { return self.config(); });
}

void bind_channel(py::module_& m) {
  using C = ChannelConfig;
  Struct<C>(m, "ChannelConfig", "Impairments of a datagram link, one way.")
      .field("delay_s", &C::delay_s, "of every datagram [s], >= 0")
      .field("jitter_s", &C::jitter_s, "uniform addition in [0, jitter_s]; keeps the order [s], >= 0")
      .field("loss", &C::loss, "probability that a datagram is lost, 0 to 1")
      .field("duplicate", &C::duplicate, "probability that it comes twice, 0 to 1")
      .field("reorder", &C::reorder, "probability that it is overtaken, 0 to 1")
      .field("reorder_s", &C::reorder_s, "by how much an overtaken one or a copy comes late [s], >= 0")
      .field("burst_rate_hz", &C::burst_rate_hz, "how often a loss burst begins [1/s], >= 0")
      .field("burst_s", &C::burst_s, "how long a loss burst lasts [s], >= 0")
      .field("seed", &C::seed, "of all draws")
      .field("capacity", &C::capacity, "datagrams in flight; more are dropped and counted");
  Struct<ChannelCounters>(m, "ChannelCounters", "What a Channel did so far.")
      .field("sent", &ChannelCounters::sent, "datagrams given to the channel")
      .field("lost", &ChannelCounters::lost, "lost at random, in a burst or in a blackout")
      .field("duplicated", &ChannelCounters::duplicated, "datagrams that come twice")
      .field("reordered", &ChannelCounters::reordered, "datagrams that are overtaken")
      .field("overflowed", &ChannelCounters::overflowed, "dropped because capacity was reached")
      .field("delivered", &ChannelCounters::delivered, "copies that came out");
  py::class_<Channel>(m, "Channel",
                      "Impaired datagram link that carries ids; deterministic for a seed. Times are arguments [s].\n"
                      "saras.sim.Link carries Python objects over it.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def("send", &Channel::send, py::arg("id"), py::arg("now"), "Puts one datagram on the link at the time now [s].")
      .def(
          "receive",
          [](Channel& self, double now) {
            py::list ids;
            for (std::uint64_t id = 0; self.receive(now, id);) {
              ids.append(id);
            }
            return ids;
          },
          py::arg("now"), "Ids of all datagrams that are due at the time now [s], in order of arrival.")
      .def("blackout_until", &Channel::blackout_until, py::arg("time"), "Loses all that is sent before time [s].")
      .def("hold_until", &Channel::hold_until, py::arg("time"), "Delivers nothing before time [s], then all at once.")
      .def_property_readonly("next_arrival", &Channel::next_arrival, "when the next datagram comes out [s]; inf: none")
      .def_property_readonly("in_flight", &Channel::in_flight, "datagrams under way")
      .def_property_readonly("counters", [](const Channel& self) { return self.counters(); })
      .def_property_readonly("config", [](const Channel& self) { return self.config(); });
}

}  // namespace

void bind_sim(py::module_& m) {
  bind_operator(m);
  bind_tissue(m);
  bind_channel(m);
  bind_sim_arm(m);
}

}  // namespace saras::bindings
