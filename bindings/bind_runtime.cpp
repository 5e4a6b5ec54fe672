#include <pybind11/stl.h>

#include "law.hpp"
#include "rooms.hpp"
#include "saras/runtime/teleop_host.hpp"

namespace saras::bindings {

void bind_runtime_flight(py::module_& m);
void bind_runtime_model(py::module_& m);

namespace {

using ReleaseGil = py::call_guard<py::gil_scoped_release>;

int side_index(const std::string& side) {
  if (side != "left" && side != "right") {
    throw py::value_error("side = '" + side + "': must be left or right");
  }
  return side == "left" ? 0 : 1;
}

void bind_loop(py::module_& m) {
  py::enum_<Pacing>(m, "Pacing", "What wakes the loop.")
      .value("DATAGRAM", Pacing::kDatagram)
      .value("TICK", Pacing::kTick);
  using Q = RealtimeRequest;
  Struct<Q>(m, "RealtimeRequest", "What is asked of the machine; a refusal is reported, not raised.")
      .field("priority", &Q::priority, "of SCHED_FIFO, 1..99; 0: an ordinary thread")
      .field("lock_memory", &Q::lock_memory, "keep all pages in memory");
  using R = RealtimeReport;
  py::class_<R>(m, "RealtimeReport", "What of it the loop's thread got, and why not.")
      .def_readonly("fifo", &R::fifo, "SCHED_FIFO obtained")
      .def_readonly("priority", &R::priority, "in effect")
      .def_readonly("fifo_reason", &R::fifo_reason, "why not; empty when obtained")
      .def_readonly("memory_locked", &R::memory_locked, "pages of now are locked")
      .def_readonly("future_locked", &R::future_locked, "and those of later")
      .def_readonly("memory_reason", &R::memory_reason, "why not, or why only those of now")
      .def_readonly("timer_slack", &R::timer_slack, "timers of the thread are not delayed to join wake-ups")
      .def("text", &R::text, "All that in one line.");
  using C = LoopConfig;
  Struct<C> loop(m, "LoopConfig", "Period and punctuality of the loop.");
  loop.field("period_s", &C::period_s, "[s], 0.0001..0.1")
      .field("pacing", &C::pacing, "Pacing")
      .field("hold_after_s", &C::hold_after_s, "time lost by overruns in a row that asks for HOLD [s]");
  nested(loop, "realtime", &C::realtime, "RealtimeRequest");
  using H = HistogramSnapshot;
  py::class_<H>(m, "Histogram", "Distribution of durations, to 3 %.")
      .def_readonly("count", &H::count)
      .def_readonly("max_ns", &H::max_ns)
      .def_property_readonly("mean_ns", &H::mean_ns)
      .def("quantile_ns", &H::quantile_ns, py::arg("p"), "Duration that the share p (0..1) does not exceed [ns].");
  using S = LoopStatistics;
  py::class_<S>(m, "LoopStatistics", "Counters of the loop since its construction.")
      .def_readonly("wakes", &S::wakes)
      .def_readonly("by_datagram", &S::by_datagram)
      .def_readonly("overruns", &S::overruns, "wake-ups more than a period late")
      .def_readonly("missed_periods", &S::missed_periods, "whole periods lost in them")
      .def_readonly("holds", &S::holds)
      .def_readonly("lateness", &S::lateness, "of timer wake-ups behind their deadline")
      .def_readonly("execution", &S::execution, "of the steps");
}

void bind_socket(py::module_& m) {
  using C = ConsoleSocketConfig;
  Struct<C>(m, "ConsoleSocketConfig", "The platform's end of the Touchball UDP link.")
      .field("bind_host", &C::bind_host, "numeric IPv4")
      .field("bind_port", &C::bind_port, "0: any free one")
      .field("console_host", &C::console_host, "numeric IPv4; other datagrams are refused")
      .field("console_port", &C::console_port, "1..65535")
      .field("age_limit_s", &C::age_limit_s, "a datagram older than this on arrival is dropped [s]")
      .field("keyed", &C::keyed, "only authenticated datagrams are believed; else loopback only")
      .field("session", &C::session, "of the datagrams down: larger for every restart");
}

py::dict counts_of(const ConsoleCounts& c) {
  py::dict counts;
  const std::pair<const char*, std::uint64_t> all[] = {
      {"accepted", c.accepted},       {"gaps", c.gaps},
      {"duplicate", c.duplicate},     {"out_of_order", c.out_of_order},
      {"old_session", c.old_session}, {"sessions", c.sessions},
      {"overdue", c.overdue},         {"malformed", c.malformed},
      {"foreign", c.foreign},         {"unauthenticated", c.unauthenticated},
      {"replayed", c.replayed},       {"too_old", c.too_old},
      {"far_ahead", c.far_ahead},     {"handshake_refused", c.handshake_refused}};
  for (const auto& [name, value] : all) {
    counts[name] = value;
  }
  return counts;
}

HmacKey key_of(const py::bytes& bytes, const char* name) {
  const std::string_view view(bytes);
  HmacKey key;
  if (view.size() != key.size()) {
    throw py::value_error(std::string(name) + ": a key of " + std::to_string(view.size()) + " bytes: must be 32");
  }
  std::copy(view.begin(), view.end(), key.begin());
  return key;
}

void bind_host(py::module_& m) {
  using C = HostConfig;
  Struct<C> config(m, "HostConfig", "Loop, console link, pipeline and flight recorder of a TeleopHost.");
  nested(config, "loop", &C::loop, "LoopConfig");
  nested(config, "console", &C::console, "ConsoleSocketConfig");
  nested(config, "pipeline", &C::pipeline, "saras.pipeline.PipelineConfig");
  config.field("silent_period_s", &C::silent_period_s, "while no console is heard: a step this often [s]")
      .field("record_s", &C::record_s, "length of the flight recorder [s]; 0: none");
  using F = FlightTick;
  py::class_<F>(m, "FlightTick", "One step.")
      .def_readonly("index", &F::index, "counts steps since the start")
      .def_readonly("now_ns", &F::now_ns, "monotonic clock [ns]")
      .def_readonly("stamp_ns", &F::stamp_ns, "wall clock of the newest datagram [ns]")
      .def_readonly("dt_s", &F::dt_s, "[s]")
      .def_readonly("input", &F::input, "saras.pipeline.PipelineInput")
      .def_readonly("output", &F::output, "saras.pipeline.PipelineOutput");
  using S = HostSnapshot;
  py::class_<S>(m, "HostSnapshot", "What one step did.")
      .def_readonly("tick", &S::tick, "FlightTick")
      .def_property_readonly(
          "up", [](const S& s) { return s.has_up ? std::optional<TouchballUp>(s.up) : std::nullopt; },
          "the newest saras.net.TouchballUp, or None")
      .def_property_readonly(
          "distances",
          [](const S& s) {
            return std::vector<ToolProximity>(s.distances.tools.begin(), s.distances.tools.begin() + s.tools);
          },
          "a saras.collision.ToolProximity for each tool; empty without the pipeline's own monitor")
      .def_property_readonly(
          "capsules",
          [](const S& s) {
            Array rows({static_cast<py::ssize_t>(s.tools), static_cast<py::ssize_t>(7)});
            for (int i = 0; i < s.tools; ++i) {
              const SceneTool& tool = s.capsules[static_cast<std::size_t>(i)];
              Eigen::Map<Eigen::Matrix<double, 7, 1>> row(rows.mutable_data(i, 0));
              row << tool.capsule.a, tool.capsule.b, tool.capsule.radius_m;
              if (!tool.known) {
                row.setConstant(std::numeric_limits<double>::quiet_NaN());
              }
            }
            return rows;
          },
          "(n, 7) tip, trocar, radius of each tool in the world; NaN where unknown")
      .def_readonly("held", &S::held, "the loop was too late: a side stands until its next engagement");
  using T = HostStatistics;
  py::class_<T>(m, "HostStatistics", "Counters and distributions of a host.")
      .def_readonly("loop", &T::loop, "LoopStatistics")
      .def_readonly("steps", &T::steps, "of the pipeline")
      .def_readonly("silent_steps", &T::silent_steps, "of those, without a datagram")
      .def_readonly("reply", &T::reply, "from a datagram's arrival in the kernel to the sending of the force")
      .def_readonly("handed", &T::handed, "from the same to the set-points in their mailbox")
      .def_readonly("left_out", &T::left_out, "steps that the flight recorder left out");
  py::class_<TeleopHost>(
      m, "TeleopHost",
      "Socket, pipeline and flight recorder in one real-time loop, in a thread of its own.\n\n"
      "Python starts, configures and observes it; nothing here holds the loop up. side: left, right.")
      .def(py::init<HostConfig>(), py::arg("config"), "Binds the socket. Raises ConfigError.")
      .def("start", &TeleopHost::start, ReleaseGil())
      .def("stop", &TeleopHost::stop, ReleaseGil())
      .def_property_readonly("running", &TeleopHost::running)
      .def_property_readonly(
          "report", [](const TeleopHost& h) { return h.loop().report(); }, "RealtimeReport; after start()")
      .def_property_readonly(
          "failure", [](const TeleopHost& h) { return h.loop().failure(); }, "why the loop ended by itself; or empty")
      .def_property_readonly(
          "port", [](TeleopHost& h) { return h.console().port(); }, "the bound UDP port")
      .def_property_readonly("config", [](const TeleopHost& h) { return h.config(); })
      .def(
          "set_arm_pose",
          [](TeleopHost& h, const std::string& side, const Pose& pose, std::int64_t stamp_ns) {
            h.set_arm_pose(side_index(side), pose, stamp_ns);
          },
          py::arg("side"), py::arg("base_T_tip"), py::arg("stamp_ns"), "(4, 4) measured, and when [ns].")
      .def(
          "set_arm_wrench",
          [](TeleopHost& h, const std::string& side, const Wrench& w) { h.set_arm_wrench(side_index(side), w); },
          py::arg("side"), py::arg("exerted"), "(6,) that the tip exerts on the tissue, base frame.")
      .def(
          "set_arm_rcm",
          [](TeleopHost& h, const std::string& side, const Vector3& p) { h.set_arm_rcm(side_index(side), p); },
          py::arg("side"), py::arg("rcm"), "(3,) trocar, base frame [m].")
      .def(
          "set_supervisor",
          [](TeleopHost& h, const std::string& side, int state, std::uint64_t engagement, bool clutch) {
            if (state < 0 || state > static_cast<int>(ChannelState::kHold)) {
              throw py::value_error("state = " + std::to_string(state) + ": must be 0 to 3");
            }
            h.set_supervisor(side_index(side), static_cast<ChannelState>(state), engagement, clutch);
          },
          py::arg("side"), py::arg("state"), py::arg("engagement"), py::arg("clutch"),
          "The supervisor's word; state: number of a saras.net.ChannelState.")
      .def(
          "set_nearness",
          [](TeleopHost& h, const std::string& side, const NearnessInput& n) { h.set_nearness(side_index(side), n); },
          py::arg("side"), py::arg("nearness"), "saras.pipeline.NearnessInput; its age runs from now on.")
      .def(
          "set_fixtures",
          [](TeleopHost& h, const std::string& side, const csa::FixtureWord& word) {
            h.set_fixtures(side_index(side), word);
          },
          py::arg("side"), py::arg("word"), "saras.csa.FixtureWord; holds until the next one.")
      .def("set_scene", &TeleopHost::set_scene, py::arg("scene"),
           "saras.pipeline.SceneInput; its age runs from now on.")
      .def("wait", &TeleopHost::wait, py::arg("timeout_s"), ReleaseGil(),
           "Waits for a step that this call has not seen; False after timeout_s. One thread at a time.")
      .def("snapshot", &TeleopHost::snapshot, "HostSnapshot of the step that wait() saw last.")
      .def("statistics", &TeleopHost::statistics, "HostStatistics")
      .def(
          "counts", [](TeleopHost& h) { return counts_of(h.console().counts()); },
          "Datagrams by name, since the start.")
      .def(
          "link_age_s", [](TeleopHost& h) { return h.console().age_s(); }, "Age of the console's information [s].")
      .def(
          "take_handshake",
          [](TeleopHost& h) -> std::optional<py::bytes> {
            TouchballHandshakeBytes bytes;
            if (!h.console().take_handshake(bytes)) {
              return std::nullopt;
            }
            return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
          },
          "The next datagram of a handshake, or None.")
      .def(
          "send",
          [](TeleopHost& h, const py::bytes& data) {
            const std::string_view view(data);
            h.console().send_raw(reinterpret_cast<const std::uint8_t*>(view.data()), view.size());
          },
          py::arg("data"), "Sends bytes to the console as they are: the answers of a handshake.")
      .def(
          "set_session",
          [](TeleopHost& h, const py::bytes& up, const py::bytes& down) {
            h.console().set_session({key_of(up, "up_key"), key_of(down, "down_key")});
          },
          py::arg("up_key"), py::arg("down_key"), "Keys (32 bytes each) of the session that a handshake began.")
      .def(
          "heard_ns", [](TeleopHost& h) { return h.console().heard_ns(); },
          "Monotonic time at which the session was heard last [ns]; 0: not yet.")
      .def("write_record", &TeleopHost::write_record, py::arg("path"), py::arg("reason"), ReleaseGil(),
           "Writes the flight record; returns its number of steps. Does not hold the loop up.");
}

}  // namespace

void bind_runtime(py::module_& m) {
  bind_loop(m);
  bind_socket(m);
  bind_host(m);
  bind_runtime_flight(m);
  bind_runtime_model(m);
}

}  // namespace saras::bindings
