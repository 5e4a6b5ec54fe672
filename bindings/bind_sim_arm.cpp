#include "law.hpp"
#include "saras/sim/servo_arm.hpp"

namespace saras::bindings {

void bind_sim_arm(py::module_& m) {
  using C = ServoArmConfig;
  using O = ServoArmOutput;
  using S = ServoArmState;
  py::enum_<ArmMode>(m, "ArmMode", "How the arm keeps the direction of its shaft.")
      .value("PIVOT", ArmMode::kPivot, "the shaft passes through the trocar")
      .value("PARALLEL", ArmMode::kParallel, "the shaft keeps its direction");
  Struct<C> config(m, "ServoArmConfig", "Joint dynamics and measurement of the simulated SARAS arm.");
  config
      .field("natural_frequency_rad_s", &C::natural_frequency_rad_s,
             "(6,) per joint; unequal ones bend the remote centre")
      .field("damping_ratio", &C::damping_ratio, "(6,) per joint, > 0")
      .field("effective_mass_kg", &C::effective_mass_kg, "of the tip, in every direction [kg], > 0")
      .field("jaw_speed_max_1_s", &C::jaw_speed_max_1_s, "jaw 0 closed to 1 open [1/s], > 0")
      .field("joint_resolution", &C::joint_resolution, "(6,) step of the measured joints, 0 none [rad, m]")
      .field("joint_noise", &C::joint_noise, "(6,) standard deviation of the measured joints [rad, m]")
      .field("seed", &C::seed, "of the noise")
      .field("dt_max_s", &C::dt_max_s, "longest step [s], > 0");
  config.cls().def("initial_q", &C::initial_q, "(6,) joints with the tip 0.1 m straight below the nominal trocar");
  Struct<O>(m, "ServoArmOutput", "Result of ServoArm.step.")
      .field("q", &O::q, "(6,) true joints [rad], insertion [m]")
      .field("q_rate", &O::q_rate, "(6,) true rates [rad/s], [m/s]")
      .field("base_T_tip", &O::base_T_tip, "(4, 4) true")
      .field("tip_velocity", &O::tip_velocity, "(3,) true, base frame [m/s]")
      .field("measured_q", &O::measured_q, "(6,) with resolution and noise")
      .field("measured_base_T_tip", &O::measured_base_T_tip, "(4, 4) forward kinematics of measured_q")
      .field("trocar_deviation", &O::trocar_deviation,
             "(3,) from the trocar to the nearest point of the shaft's line [m]")
      .field("rcm_deviation_m", &O::rcm_deviation_m, "its length [m]")
      .field("jaw", &O::jaw, "0 closed to 1 open")
      .field("status", &O::status, "saras.Status; LIMITED: target out of reach or speed scaled")
      .cls()
      .def_property_readonly(
          "violation", [](const O& self) { return describe(self.violation); },
          "why the target is not followed; empty when it is");
  Struct<S>(m, "ServoArmState", "All that a ServoArm remembers.")
      .field("q", &S::q, "(6,)")
      .field("q_rate", &S::q_rate, "(6,)")
      .field("q_target", &S::q_target, "(6,) the last target in reach")
      .field("roll_reference", &S::roll_reference, "[rad]")
      .field("jaw", &S::jaw, "0 closed to 1 open");
  py::class_<ServoArm>(
      m, "ServoArm",
      "Six servoed joints with second-order dynamics that follow a pivoting tip and yield to a force on it.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](ServoArm& self, const Vector3& target_tip, double target_roll, const Vector3& rcm,
             const Vector3& reaction_force, double dt, double target_jaw, double roll_speed, double jaw_speed,
             ArmMode mode) {
            return self.step({target_tip, target_roll, rcm, reaction_force, target_jaw, roll_speed, jaw_speed, mode},
                             dt);
          },
          py::arg("target_tip"), py::arg("target_roll"), py::arg("rcm"), py::arg("reaction_force"), py::arg("dt"),
          py::arg("target_jaw") = 0.0, py::arg("roll_speed_max_rad_s") = 1e9, py::arg("jaw_speed_max_1_s") = 1e9,
          py::arg("mode") = ArmMode::kPivot,
          "One tick: target tip (3,) [m], roll joint [rad] and trocar (3,) [m] in the base frame; reaction_force (3,) "
          "is\n"
          "what the surroundings exert on the tip [N], minus the wrench exerted; dt [s]; jaw 0 closed to 1 open.")
      .def(
          "reset", [](ServoArm& self, const Vector6& q) { self.reset(q); }, py::arg("q"),
          "At rest in the joints q (6,). Raises ConfigError when they leave the limits.")
      .def(
          "reset", [](ServoArm& self, const S& state) { self.reset(state); }, py::arg("state"))
      .def("reset", [](ServoArm& self) { self.reset(); })
      .def_property_readonly("config", [](const ServoArm& self) { return self.config(); })
      .def_property_readonly("state", [](const ServoArm& self) { return self.state(); });
}

}  // namespace saras::bindings
