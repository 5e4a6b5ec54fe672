#include <algorithm>

#include "bind_collision.hpp"
#include "saras/collision/proximity_monitor.hpp"
#include "saras/collision/repulsive_force.hpp"

namespace saras::bindings {
namespace {

/// ProximityMonitorOutput with as many tools as there are.
struct MonitorOutput {
  std::vector<ToolProximity> tools;
  Status status = Status::kOk;
};

void bind_tool_proximity(py::module_& m) {
  py::enum_<ProximityState>(m, "ProximityState", "What the monitor says of a tool.")
      .value("UNKNOWN", ProximityState::kUnknown)
      .value("CLEAR", ProximityState::kClear)
      .value("WARNING", ProximityState::kWarning)
      .value("COLLISION", ProximityState::kCollision);
  using T = ToolProximity;
  Struct<T>(m, "ToolProximity", "Of one tool: state, distance, with whom, what is unknown, how fast it may move.")
      .field("state", &T::state, "ProximityState")
      .field("distance_m", &T::distance_m, "[m]; NaN when UNKNOWN, infinite when there is nothing to meet")
      .field("known", &T::known, "SignedDistance from the tool to the nearest known thing; NaN when nothing is known")
      .field("partner", &T::partner, "TOOL, REGION or NONE")
      .field("partner_index", &T::partner_index, "of that tool or region; -1 for none")
      .field("tool_unknown", &T::tool_unknown, "why UNKNOWN: this tool")
      .field("other_tool_unknown", &T::other_tool_unknown, "why UNKNOWN: another tool")
      .field("regions_unknown", &T::regions_unknown, "why UNKNOWN: the regions")
      .field("max_speed_scale", &T::max_speed_scale, "0..1, for the velocity integrator")
      .field("approach_direction", &T::approach_direction, "(3,) towards what is near; zero: nothing known")
      .field("approach_speed_limit_m_s", &T::approach_speed_limit_m_s, "along it [m/s]; infinite: no bound");
}

void bind_proximity_monitor(py::module_& m) {
  using C = ProximityMonitorConfig;
  Struct<C>(m, "ProximityMonitorConfig", "Thresholds and speeds of ProximityMonitor.")
      .field("collision_m", &C::collision_m, "at most this far is a collision [m]")
      .field("warning_m", &C::warning_m, "below it is a warning [m]")
      .field("hysteresis_m", &C::hysteresis_m, "a state is left this much further out [m]")
      .field("slowdown_start_m", &C::slowdown_start_m, "up to here a tool may approach at full speed [m]")
      .field("slowdown_stop_m", &C::slowdown_stop_m, "from here on it may not approach [m]")
      .field("speed_limit_m_s", &C::speed_limit_m_s, "full speed [m/s]")
      .field("unknown_speed_limit_m_s", &C::unknown_speed_limit_m_s, "while something is unknown [m/s]");
  bind_tool_proximity(m);
  Struct<MonitorOutput>(m, "ProximityMonitorOutput", "Result of ProximityMonitor.step.")
      .field("tools", &MonitorOutput::tools, "a ToolProximity each")
      .field("status", &MonitorOutput::status, "STALE: something is unknown; LIMITED: some tool is slowed down");
  using S = ProximityMonitorState;
  Struct<S>(m, "ProximityMonitorState", "What hysteresis remembers.")
      .field("levels", &S::levels, "ProximityState of each tool when it was last known");
  py::class_<ProximityMonitor>(m, "ProximityMonitor",
                               "State and speed of each tool from its distances. Unknown is never clear.")
      .def(py::init([](const C& config, int tools, const py::object& regions) {
             return ProximityMonitor(config, tools, shapes_of(load_regions(regions)));
           }),
           py::arg("config"), py::arg("tools"), py::arg("regions") = py::tuple(),
           "tools: how many, 1..16. regions: (n, 8, 3) [m]. Raises ConfigError.")
      .def(
          "step",
          [](ProximityMonitor& self, const py::sequence& tools, Seconds dt, const Pose& base_T_regions,
             bool regions_known) {
            const std::vector<SceneTool> given = load_tools(tools);
            if (given.size() != static_cast<std::size_t>(self.tools())) {
              throw py::value_error("tools: expected " + std::to_string(self.tools()) + ", got " +
                                    std::to_string(given.size()));
            }
            ProximityMonitorInput input;
            std::copy(given.begin(), given.end(), input.tools.begin());
            input.base_T_regions = base_T_regions;
            input.regions_known = regions_known;
            const ProximityMonitorOutput output = self.step(input, dt);
            return MonitorOutput{{output.tools.begin(), output.tools.begin() + self.tools()}, output.status};
          },
          py::arg("tools"), py::arg("dt"), py::arg("base_T_regions") = Pose{}, py::arg("regions_known") = true,
          "One tick. tools: (a (3,), b (3,), radius) [m], Capsule, or None for one that is lost or too old;\n"
          "or (n, 7) numbers a, b, radius, with a row that is not finite for such a one.\n"
          "base_T_regions: (4, 4) from the regions' frame to that of the tools; regions_known: it is fresh.")
      .def("reset", &ProximityMonitor::reset, py::arg("state") = S{})
      .def_property_readonly("config", [](const ProximityMonitor& self) { return self.config(); })
      .def_property_readonly("state", [](const ProximityMonitor& self) { return self.state(); })
      .def_property_readonly("tools", [](const ProximityMonitor& self) { return self.tools(); })
      .def_property_readonly("regions", [](const ProximityMonitor& self) { return self.regions(); });
}

void bind_repulsive_force(py::module_& m) {
  using C = RepulsiveForceConfig;
  Struct<C>(m, "RepulsiveForceConfig", "A spring before what is near.")
      .field("start_distance_m", &C::start_distance_m, "nearer than this the force begins [m]")
      .field("stiffness_N_m", &C::stiffness_N_m, "force per metre nearer [N/m]")
      .field("force_limit_N", &C::force_limit_N, "largest force [N]")
      .field("dt_max_s", &C::dt_max_s, "longest time step [s]");
  using O = RepulsiveForceOutput;
  Struct<O>(m, "RepulsiveForceOutput", "Result of RepulsiveForce.step.")
      .field("wrench", &O::wrench, "(6,) on the operator's hand, in the frame of the normal")
      .field("status", &O::status, "STALE: distance unknown, zero force");
  Struct<RepulsiveForceState>(m, "RepulsiveForceState", "Nothing is remembered.").cls().attr("_fields") = py::list();
  py::class_<RepulsiveForce>(m, "RepulsiveForce", "A force on the hand away from what the tool comes near to.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](RepulsiveForce& self, double distance_m, const Vector3& normal, Seconds dt) {
            return self.step({distance_m, normal}, dt);
          },
          py::arg("distance_m"), py::arg("normal"), py::arg("dt"),
          "One tick. distance_m: signed [m], NaN when unknown (zero force); normal: (3,) unit, tool -> what is near.")
      .def("reset", &RepulsiveForce::reset, py::arg("state") = RepulsiveForceState{})
      .def_property_readonly("config", [](const RepulsiveForce& self) { return self.config(); })
      .def_property_readonly("state", [](const RepulsiveForce& self) { return self.state(); });
}

}  // namespace

void bind_collision_laws(py::module_& m) {
  bind_proximity_monitor(m);
  bind_repulsive_force(m);
}

}  // namespace saras::bindings
