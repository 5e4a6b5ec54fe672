#include <pybind11/stl.h>

#include "bind_collision.hpp"
#include "law.hpp"
#include "rooms.hpp"
#include "saras/pipeline/pipeline.hpp"

namespace saras::bindings {
namespace {

/// One element of a pair of sides under the side's name; given out by reference where Python sets its fields in place.
template <typename Owner, typename Member>
void sides(Struct<Owner>& bound, std::array<Member, kSides> Owner::*member, const std::string& suffix,
           const char* doc) {
  for (int i = 0; i < kSides; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::string name = (i == 0 ? "left" : "right") + suffix;
    bound.field(
        name.c_str(), [member, at](Owner& self) -> Member& { return (self.*member)[at]; },
        [member, at](Owner& self, const Member& value) { (self.*member)[at] = value; }, doc);
  }
}

/// The same by value.
template <typename Owner, typename Member>
void side_values(Struct<Owner>& bound, std::array<Member, kSides> Owner::*member, const std::string& suffix,
                 const char* doc) {
  for (int i = 0; i < kSides; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::string name = (i == 0 ? "left" : "right") + suffix;
    bound.field(
        name.c_str(), [member, at](const Owner& self) -> Member { return (self.*member)[at]; },
        [member, at](Owner& self, const Member& value) { (self.*member)[at] = value; }, doc);
  }
}

void bind_config(py::module_& m) {
  using D = DistancesConfig;
  Struct<D>(m, "DistancesConfig", "The distances that the pipeline takes itself.")
      .field("enabled", &D::enabled, "else the nearness is an input")
      .field("monitor", &D::monitor, "saras.collision.ProximityMonitorConfig")
      .field("radius_m", &D::radius_m, "of a SARAS instrument's shaft [m]")
      .field("other_tools", &D::other_tools, "tools of other robots, 0..6")
      .field(
          "regions", [](D& d) { return store_regions(d.regions); },
          [](D& d, const py::object& regions) { d.regions = load_regions(regions); },
          "(n, 8, 3) vertices in the regions' frame [m]")
      .field("scene_timeout_s", &D::scene_timeout_s, "an older scene is unknown [s]");
  using C = PipelineConfig;
  Struct<C> config(m, "PipelineConfig", "Parameters of all laws of both sides, and how old their inputs may be.");
  sides(config, &C::mapping, "_mapping", "saras.teleop.FrameMappingConfig");
  nested(config, "transparency", &C::transparency, "saras.teleop.TransparencyConfig, both sides");
  nested(config, "slave_twist", &C::slave_twist, "saras.teleop.TwistEstimatorConfig of the tips");
  nested(config, "repulsion", &C::repulsion, "saras.collision.RepulsiveForceConfig");
  config.field("proximity_force", &C::proximity_force, "push the hand away from what its tool comes near to");
  nested(config, "tank_master", &C::tank_master, "saras.teleop.EnergyTankConfig");
  nested(config, "tank_slave", &C::tank_slave, "saras.teleop.EnergyTankConfig");
  sides(config, &C::integrator, "_integrator", "saras.teleop.VelocityIntegratorConfig");
  config.field("proximity_slowdown", &C::proximity_slowdown, "bound the speed near things and while they are unknown");
  side_values(config, &C::unknown_speed_m_s, "_unknown_speed_m_s", "speed limit while the nearness is unknown [m/s]");
  nested(config, "distances", &C::distances, "DistancesConfig");
  side_values(config, &C::fixtures, "_fixtures", "list of saras.csa.TeleopFixture in the arm's base frame");
  nested(config, "fixture_force", &C::fixture_force, "saras.csa.FixtureForceConfig");
  config.field("observe", &C::observe, "wrench on the tissue from the observer, else from the arm's input");
  nested(config, "observer", &C::observer, "saras.teleop.DisturbanceObserverConfig");
  config.field("handle_timeout_s", &C::handle_timeout_s, "an older handle is stale [s]")
      .field("arm_timeout_s", &C::arm_timeout_s, "an older pose or wrench of the arm is unknown [s]")
      .field("channel_timeout_s", &C::channel_timeout_s, "a supervisor silent for longer means HOLD [s]")
      .field("peer_timeout_s", &C::peer_timeout_s, "a port guard silent for longer wants nothing [s]")
      .field("nearness_timeout_s", &C::nearness_timeout_s, "an older nearness is unknown [s]")
      .field("session", &C::session, "of the tanks' ledgers: larger for every restart");
}

void bind_input(py::module_& m) {
  using H = HandleInput;
  Struct<H> handle(m, "HandleInput", "The newest datagram of a console about one handle.");
  handle.field("is_new", &H::is_new, "came since the last step, with a valid reading")
      .field("age_s", &H::age_s, "[s]; infinite: never came")
      .field("simball_T_handle", &H::simball_T_handle, "(4, 4)")
      .field("clutch", &H::clutch, "pressed");
  nested(handle, "ledger", &H::ledger, "saras.net.PortLedger of the port guard");
  using A = ArmInput;
  Struct<A>(m, "ArmInput", "The newest sample of an arm, in its base frame.")
      .field("is_new", &A::is_new, "came since the last step")
      .field("age_s", &A::age_s, "[s]")
      .field("interval_s", &A::interval_s, "of a new one: since the one seen before; 0: not known [s]")
      .field("base_T_tip", &A::base_T_tip, "(4, 4) measured")
      .field("target", &A::target, "(3,) tip position that its servo follows [m]")
      .field("has_rcm", &A::has_rcm, "whether the trocar is known")
      .field("rcm", &A::rcm, "(3,) trocar [m]")
      .field("wrench_age_s", &A::wrench_age_s, "[s]")
      .field("exerted_wrench", &A::exerted_wrench, "(6,) on the tissue");
  using C = SupervisorWord;
  Struct<C>(m, "SupervisorWord", "What the supervisor says of a side.")
      .field("age_s", &C::age_s, "[s]")
      .field("state", &C::state, "saras.net.ChannelState")
      .field("engagement", &C::engagement, "number of the last engagement")
      .field("clutch", &C::clutch, "pressed");
  using N = NearnessInput;
  Struct<N>(m, "NearnessInput", "What a monitor says of a side's tool, in the arm's base frame.")
      .field("age_s", &N::age_s, "[s]")
      .field("max_speed_scale", &N::max_speed_scale, "0..1, in any direction")
      .field("approach_direction", &N::approach_direction, "(3,) unit, towards what is near; zero: nothing known")
      .field("approach_speed_limit_m_s", &N::approach_speed_limit_m_s, "along it [m/s]; infinite: no bound")
      .field("distance_m", &N::distance_m, "[m]; NaN: unknown");
  using S = SideInput;
  Struct<S> side(m, "SideInput", "Inputs of one side.");
  nested(side, "handle", &S::handle, "HandleInput");
  nested(side, "arm", &S::arm, "ArmInput");
  nested(side, "channel", &S::channel, "SupervisorWord");
  nested(side, "nearness", &S::nearness, "NearnessInput; not read when the pipeline takes the distances itself");
  nested(side, "fixtures", &S::fixtures, "saras.csa.FixtureWord of the configured fixtures");
  using W = SceneInput;
  Struct<W> scene(m, "SceneInput", "Where everything is that the tools could meet, in the world.");
  scene.field("age_s", &W::age_s, "[s]");
  side_values(scene, &W::base_known, "_base_known", "whether world_T_base is known");
  side_values(scene, &W::world_T_base, "_world_T_base", "(4, 4)");
  scene
      .field(
          "others",
          [](W& w) {
            Array tools({static_cast<py::ssize_t>(kMaxOtherTools), static_cast<py::ssize_t>(7)});
            for (int i = 0; i < kMaxOtherTools; ++i) {
              const SceneTool& tool = w.others[static_cast<std::size_t>(i)];
              Eigen::Map<Eigen::Matrix<double, 7, 1>> row(tools.mutable_data(i, 0));
              row << tool.capsule.a, tool.capsule.b, tool.capsule.radius_m;
              if (!tool.known) {
                row.setConstant(std::numeric_limits<double>::quiet_NaN());
              }
            }
            return tools;
          },
          [](W& w, const py::sequence& tools) {
            const std::vector<SceneTool> given = load_tools(tools);
            if (given.size() > static_cast<std::size_t>(kMaxOtherTools)) {
              throw py::value_error("others: at most " + std::to_string(kMaxOtherTools) + " tools");
            }
            w.others.fill({{}, false});
            std::copy(given.begin(), given.end(), w.others.begin());
          },
          "tools of other robots: (n, 7) tip, trocar, radius, not finite where unknown")
      .field("regions_known", &W::regions_known, "whether world_T_regions is known")
      .field("world_T_regions", &W::world_T_regions, "(4, 4)");
  using I = PipelineInput;
  Struct<I> input(m, "PipelineInput", "Inputs of one step of both sides.");
  sides(input, &I::sides, "", "SideInput");
  nested(input, "scene", &I::scene, "SceneInput");
  input.field("overrun", &I::overrun, "the loop was late: integrators take one nominal period at most")
      .field("hold", &I::hold, "the loop was too late: both sides stand until their next engagement");
}

void bind_output(py::module_& m) {
  using O = PipelineSideOutput;
  Struct<O>(m, "PipelineSideOutput", "Of one side.")
      .field("state", &O::state, "saras.net.ChannelState in effect")
      .field("engagement", &O::engagement, "its number")
      .field("has_tracked", &O::has_tracked, "a handle was mapped since the start")
      .field("is_mapped", &O::is_mapped, "in this step")
      .field("tracked_pose", &O::tracked_pose, "(4, 4) base_T_tracked")
      .field("tracked_twist", &O::tracked_twist, "(6,) in the base frame")
      .field("tracked_twist_filtered", &O::tracked_twist_filtered, "(6,)")
      .field("handle_twist", &O::handle_twist, "(6,) the hand's own, also under clutch")
      .field("desired_wrench", &O::desired_wrench, "(6,) on the hand, of transparency")
      .field("desired_twist", &O::desired_twist, "(6,) of the tip, of transparency")
      .field("error", &O::error, "(6,) slave - mapped master")
      .field("base_wrench", &O::base_wrench, "(6,) on the hand, what passivity lets through")
      .field("touch_wrench", &O::touch_wrench, "(6,) the same in the touch frame")
      .field("twist", &O::twist, "(6,) of the tip, what passivity lets through")
      .field("has_set_point", &O::has_set_point, "and the arm is there to hold it")
      .field("set_point", &O::set_point, "(4, 4) base_T_tip")
      .field("lead_m", &O::lead_m, "set-point ahead of measured [m]")
      .field("wrench_known", &O::wrench_known, "whether tissue_wrench is known")
      .field("tissue_wrench", &O::tissue_wrench, "(6,) exerted on the tissue")
      .field("to_guard", &O::to_guard, "saras.net.PortLedger to the port guard")
      .field("nearness", &O::nearness, "NearnessInput as used")
      .field("fixtures", &O::fixtures, "saras.csa.FixtureForceOutput")
      .field("mapping", &O::mapping, "saras.Status of the frame mapping")
      .field("transparency", &O::transparency, "saras.Status of transparency")
      .field("integrator", &O::integrator, "saras.Status of the integrator")
      .field("speed_limited", &O::speed_limited, "command above the speed limit")
      .field("approach_limited", &O::approach_limited, "command above the approach limit")
      .field("lead_limited", &O::lead_limited, "set-point too far ahead of measured")
      .field("workspace_limited", &O::workspace_limited, "at the edge of cone or insertion")
      .field("fixture_limited", &O::fixture_limited, "at a virtual fixture");
  using T = TankOutput;
  Struct<T>(m, "TankOutput", "Of one tank; cumulative joules since the start.")
      .field("energy_J", &T::energy_J, "level [J]")
      .field("work_out_J", &T::work_out_J, "through the ports [J]")
      .field("received_J", &T::received_J, "from peers [J]")
      .field("sent_J", &T::sent_J, "to peers [J]")
      .field("vented_J", &T::vented_J, "discarded [J]")
      .field("granted_J", &T::granted_J, "granted [J]")
      .field("reduction", &T::reduction, "K_E in [0, 1]")
      .field("scale", &T::scale, "alpha in [0, 1]")
      .field("damping", &T::damping, "(6,) B")
      .field("requesting", &T::requesting, "asks its peers for energy")
      .field("has_room", &T::has_room, "can take more")
      .field("status", &T::status, "saras.Status")
      .field(
          "to_peer", [](T& t) { return std::tuple(t.to_peer.session, t.to_peer.seq, t.to_peer.sent_J); },
          [](T& t, const std::tuple<std::uint64_t, std::uint64_t, double>& v) {
            t.to_peer = {std::get<0>(v), std::get<1>(v), std::get<2>(v)};
          },
          "(session, seq, sent_J) to the other tank");
  using P = PipelineOutput;
  Struct<P> output(m, "PipelineOutput", "Of one step of both sides.");
  side_values(output, &P::sides, "", "PipelineSideOutput");
  output.field("tank_master", &P::tank_master, "TankOutput")
      .field("tank_slave", &P::tank_slave, "TankOutput")
      .field("proximity", &P::proximity, "saras.Status of the distances")
      .field("status", &P::status, "saras.Status: the worst of the engaged sides");
}

void bind_law(py::module_& m) {
  using S = PipelineState;
  Struct<S>(m, "PipelineState", "All that a Pipeline remembers; to be kept and given back whole.")
      .field(
          "tank_master", [](const S& s) { return s.tank_master.tank; },
          [](S& s, const EnergyTankState& tank) { s.tank_master.tank = tank; }, "saras.teleop.EnergyTankState")
      .field(
          "tank_slave", [](const S& s) { return s.tank_slave.tank; },
          [](S& s, const EnergyTankState& tank) { s.tank_slave.tank = tank; }, "saras.teleop.EnergyTankState");
  py::class_<Pipeline>(m, "Pipeline",
                       "Both sides in one step: hands' poses to set-points, and back to the wrenches on the hands.\n\n"
                       "The laws of the separate nodes in their order, as one value.")
      .def(py::init<PipelineConfig>(), py::arg("config"), "Raises ConfigError.")
      .def("step", &Pipeline::step, py::arg("input"), py::arg("dt"),
           "One step: PipelineInput, seconds since the last one. Returns PipelineOutput.")
      .def(
          "reset", [](Pipeline& self, const std::optional<S>& state) { state ? self.reset(*state) : self.reset(); },
          py::arg("state") = py::none(), "As constructed, or continuation from a recorded state.")
      .def_property_readonly("state", [](const Pipeline& self) { return self.state(); })
      .def_property_readonly("config", [](const Pipeline& self) { return self.config(); })
      .def_property_readonly(
          "distances",
          [](const Pipeline& self) {
            const auto& tools = self.distances().tools;
            return std::vector<ToolProximity>(tools.begin(), tools.begin() + self.tools());
          },
          "a saras.collision.ToolProximity for each SARAS instrument and each other tool, of the last step");
}

}  // namespace

void bind_pipeline(py::module_& m) {
  bind_config(m);
  bind_input(m);
  bind_output(m);
  bind_law(m);
}

}  // namespace saras::bindings
