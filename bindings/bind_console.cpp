#include <pybind11/stl.h>

#include <optional>

#include "law.hpp"
#include "rooms.hpp"
#include "saras/console/port_guard.hpp"
#include "saras/console/simulated_handle.hpp"

namespace saras::bindings {
namespace {

using Triple = std::array<double, 3>;  // from tuples of floats: much cheaper than through numpy, at 1 kHz it counts

Eigen::Matrix3d matrix(const Quaternion& rotation) { return rotation.toRotationMatrix(); }

Quaternion rotation(const Eigen::Matrix3d& m) {
  if (!(m.allFinite() && (m.transpose() * m).isIdentity(1e-6) && m.determinant() > 0.0)) {
    throw ConfigError("touch_R_simball: must be a (3, 3) rotation");
  }
  return Quaternion(m).normalized();
}

template <typename C, typename S>
void touch_frame(S& bound) {
  bound.field(
      "touch_R_simball", [](const C& c) { return matrix(c.touch_R_simball); },
      [](C& c, const Eigen::Matrix3d& m) { c.touch_R_simball = rotation(m); },
      "(3, 3) turns simball_base vectors into the touch frame");
}

void bind_port_guard(py::module_& m) {
  using C = PortGuardConfig;
  Struct<C> config(m, "PortGuardConfig", "An energy tank of one channel at a handle.");
  config.field("tank", &C::tank, "EnergyTankConfig")
      .field("force_ramp_s", &C::force_ramp_s, "from full force to none, and back [s]");
  touch_frame<C>(config);
  using O = PortGuardOutput;
  Struct<O>(m, "PortGuardOutput", "Result of PortGuard.step.")
      .field("applied", &O::applied, "(6,) to the motors, touch frame [N, N m]")
      .field("tank", &O::tank, "EnergyTankOutput")
      .field("status", &O::status, "saras.Status, the tank's");
  using S = PortGuardState;
  Struct<S>(m, "PortGuardState", "All that a PortGuard remembers.")
      .field("tank", &S::tank, "EnergyTankState")
      .field("ramp", &S::ramp, "share of the wanted wrench that passes, 0 to 1")
      .field("has_previous", &S::has_previous, "whether the last tick had a pose")
      .field("simball_T_previous", &S::simball_T_previous, "(4, 4) pose of the last tick")
      .field("billed_J", &S::billed_J, "of the device's cumulative work [J]");
  py::class_<PortGuard>(m, "PortGuard",
                        "The passivity layer at one handle. Begins at minimum_J; grant() once an engagement.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](PortGuard& self, const std::optional<Pose>& pose, double work_J, const Wrench& wrench, double dt,
             bool active, double received_J, bool peer_requests, bool peer_has_room) {
            return self.step({wrench, active, pose.has_value(), pose.value_or(Pose{}), work_J, received_J,
                              peer_requests, peer_has_room},
                             dt);
          },
          py::arg("simball_T_handle"), py::arg("work_J"), py::arg("wrench"), py::arg("dt"), py::arg("active"),
          py::arg("received_J") = 0.0, py::arg("peer_requests") = false, py::arg("peer_has_room") = false,
          "One device tick.\n\n"
          "simball_T_handle: (4, 4), None without a valid reading. work_J: the device's cumulative work on the hand.\n"
          "wrench: (6,) newest from the platform, touch frame. active: engaged on a fresh link; else the force ramps "
          "to\n"
          "zero. received_J: credited by the ledger since the last tick.")
      .def("grant", &PortGuard::grant, "Fills the tank up to initial_J and counts it as granted.")
      .def(
          "reset",
          [](PortGuard& self, const std::optional<PortGuardState>& state) {
            state ? self.reset(*state) : self.reset();
          },
          py::arg("state") = py::none(), "A restart (level minimum_J), or continuation from a recorded state.")
      .def_property_readonly("state", [](const PortGuard& self) { return self.state(); })
      .def_property_readonly("config", [](const PortGuard& self) { return self.config(); });
}

void bind_simulated_handle(py::module_& m) {
  using C = SimulatedHandleConfig;
  Struct<C> config(m, "SimulatedHandleConfig", "A hand, the Simball it holds, the motors that push it.");
  config.field("hand", &C::hand, "saras.sim.OperatorConfig; its workspace is set from here")
      .field("simball", &C::simball, "saras.kinematics.SimballHandleConfig")
      .field("home_joints", &C::home_joints, "(4,) start, and origin of intentions [rad], insertion [m]")
      .field("workspace_radius_m", &C::workspace_radius_m, "mechanical stop around home [m]")
      .field("watchdog_s", &C::watchdog_s, "the motors fall back to zero when a wrench is this old [s]")
      .field("stall_max_s", &C::stall_max_s, "of a longer step only this much is simulated [s]");
  touch_frame<C>(config);
  using S = SimulatedHandleState;
  Struct<S>(m, "SimulatedHandleState", "All that a SimulatedHandle remembers.")
      .field("hand", &S::hand, "saras.sim.OperatorState")
      .field("work_J", &S::work_J, "cumulative work of the motors on the hand [J]");
  py::class_<SimulatedHandle>(m, "SimulatedHandle", "A haptic handle without the hardware.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](SimulatedHandle& self, const Triple& offset, const Triple& velocity, double roll,
             const std::optional<Wrench>& wrench, double dt) {
            const auto out =
                self.step({Vector3(offset.data()), Vector3(velocity.data()), roll, wrench.value_or(Wrench{})}, dt);
            return std::pair(out.valid ? std::optional<Vector4>(out.joints) : std::nullopt, out.work_J);
          },
          py::arg("intended_offset"), py::arg("intended_velocity"), py::arg("intended_roll"), py::arg("wrench"),
          py::arg("dt"),
          "One step of dt [s]: what the hand intends, from home in the handle's frame there (3,) [m], (3,) [m/s], "
          "[rad];\n"
          "wrench (6,) applied since the last step in the touch frame, None for none. Returns (joints (4,) or None,\n"
          "cumulative work on the hand [J]).")
      .def(
          "reset", [](SimulatedHandle& self) { self.reset(); }, "At rest at home.")
      .def_property_readonly("state", [](const SimulatedHandle& self) { return self.state(); })
      .def_property_readonly("config", [](const SimulatedHandle& self) { return self.config(); });
}

}  // namespace

void bind_console(py::module_& m) {
  bind_port_guard(m);
  bind_simulated_handle(m);
}

}  // namespace saras::bindings
