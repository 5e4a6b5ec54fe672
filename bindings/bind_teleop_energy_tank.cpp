#include <optional>

#include "law.hpp"
#include "saras/teleop/energy_ledger.hpp"
#include "saras/teleop/energy_tank.hpp"

namespace saras::bindings {
namespace {

/// (n, 6) from Python -> one column a channel.
ChannelArray load_channels(const py::object& source, const char* name, int channels) {
  const Array array = Array::ensure(source);
  if (!array || array.ndim() != 2 || array.shape(0) != channels || array.shape(1) != 6) {
    PyErr_Clear();
    throw py::value_error(std::string(name) + ": expected shape (" + std::to_string(channels) + ", 6), got " +
                          (array ? shape_text(array) : std::string("no array")));
  }
  return Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic>>(array.data(), 6, channels);
}

Array store_channels(const ChannelArray& channels) {
  Array array({static_cast<py::ssize_t>(channels.cols()), static_cast<py::ssize_t>(6)});
  Eigen::Map<Eigen::Matrix<double, 6, Eigen::Dynamic>>(array.mutable_data(), 6, channels.cols()) = channels;
  return array;
}

ChannelArray load_any_channels(const py::object& source, const char* name) {
  const Array array = Array::ensure(source);
  const int channels = array && array.ndim() == 2 ? static_cast<int>(array.shape(0)) : 0;
  if (channels > kMaxTankChannels) {
    throw py::value_error(std::string(name) + ": more than " + std::to_string(kMaxTankChannels) + " channels");
  }
  return load_channels(source, name, channels);
}

EnergyTankOutput step(EnergyTank& tank, const py::object& desired, const py::object& conjugate, double dt,
                      double received_J, int peer_requests, bool peer_has_room, std::optional<double> work_J,
                      bool stale, const std::optional<py::object>& measured) {
  EnergyTankInput input;
  input.desired = load_channels(desired, "desired", tank.channels());
  input.conjugate = load_channels(conjugate, "conjugate", tank.channels());
  input.measured.resize(6, 0);
  if (measured) {
    input.measured = load_channels(*measured, "measured", tank.channels());
  }
  input.conjugate_stale = stale;
  input.has_work = work_J.has_value();
  input.work_J = work_J.value_or(0.0);
  input.received_J = received_J;
  input.requesting_peers = peer_requests;
  input.peer_has_room = peer_has_room;
  return tank.step(input, dt);
}

void bind_tank(py::module_& m) {
  using C = EnergyTankConfig;
  Struct<C>(m, "EnergyTankConfig",
            "Levels, damping and limits of an EnergyTank; 0 < minimum < request < available < maximum.")
      .field("initial_J", &C::initial_J, "level at construction, counted as granted; minimum_J for a restart [J]")
      .field("minimum_J", &C::minimum_J, "below it only damping acts [J]")
      .field("request_J", &C::request_J, "below it the tank asks its peers and reduces the command [J]")
      .field("available_J", &C::available_J, "above it the tank may give; asking stops here [J]")
      .field("maximum_J", &C::maximum_J, "capacity [J]")
      .field("exchange_W", &C::exchange_W, "largest power to one requesting peer [W]")
      .field("damping_min", &C::damping_min, "(6,) B with a full tank; 0 on axes without a motor")
      .field("damping_max", &C::damping_max, "(6,) B with an empty tank")
      .field("conjugate_rate", &C::conjugate_rate, "(6,) largest rate of change of the conjugate [unit/s]")
      .field("applied_limit", &C::applied_limit, "(6,) saturation of the output, per axis")
      .field("hold_s", &C::hold_s, "longest time the device keeps a command before it zeroes it [s]")
      .field("dt_max_s", &C::dt_max_s, "a longer interval is billed, and answered by zero [s]");
  using O = EnergyTankOutput;
  Struct<O>(m, "EnergyTankOutput", "Result of EnergyTank.step.")
      .field(
          "applied", [](const O& o) { return store_channels(o.applied); },
          [](O& o, const py::object& a) { o.applied = load_any_channels(a, "applied"); }, "(n, 6) goes to the device")
      .field("energy_J", &O::energy_J, "level after this tick [J]")
      .field("sent_J", &O::sent_J, "left for the peers in this tick: put it on the ledger [J]")
      .field("sent_overflow_J", &O::sent_overflow_J, "the part of sent_J that is overflow [J]")
      .field("requesting", &O::requesting, "ask the peers for energy")
      .field("has_room", &O::has_room, "the tank can take more")
      .field("reduction", &O::reduction, "K_E in [0, 1]")
      .field("scale", &O::scale, "alpha in [0, 1], what the budget over hold_s lets through")
      .field("damping", &O::damping, "(6,) B of this tick")
      .field("status", &O::status, "saras.Status");
  using S = EnergyTankState;
  Struct<S>(m, "EnergyTankState", "All that an EnergyTank remembers; cumulative joules since construction or restart.")
      .field("energy_J", &S::energy_J, "level [J]")
      .field("granted_J", &S::granted_J, "starting charge and grants [J]")
      .field("work_out_J", &S::work_out_J, "through the ports; negative: the surroundings put energy in [J]")
      .field("received_J", &S::received_J, "from peers [J]")
      .field("sent_J", &S::sent_J, "to peers [J]")
      .field("vented_J", &S::vented_J, "discarded because the tank was full [J]")
      .field("requesting", &S::requesting, "asks its peers for energy")
      .field("rate_locked", &S::rate_locked, "damping only until energy_J > minimum_J")
      .field("has_conjugate", &S::has_conjugate, "whether the last tick had a usable conjugate")
      .field(
          "applied", [](const S& s) { return store_channels(s.applied); },
          [](S& s, const py::object& a) { s.applied = load_any_channels(a, "applied"); }, "(n, 6) of the last tick")
      .field(
          "conjugate", [](const S& s) { return store_channels(s.conjugate); },
          [](S& s, const py::object& a) { s.conjugate = load_any_channels(a, "conjugate"); },
          "(n, 6) of the last tick");
  py::class_<EnergyTank>(
      m, "EnergyTank",
      "The passivity layer: bounds what motors may do by a store of energy.\n\n"
      "At a handle (port guard) desired/applied are wrenches on the hand and conjugate its twist; at an arm\n"
      "desired/applied are twists and conjugate the wrench exerted on the tissue. Always, to rounding:\n"
      "energy_J + work_out_J + sent_J + vented_J == granted_J + received_J.")
      .def(py::init<EnergyTankConfig, int>(), py::arg("config") = EnergyTankConfig{}, py::arg("channels") = 1)
      .def(
          "step", &step, py::arg("desired"), py::arg("conjugate"), py::arg("dt"), py::arg("received_J") = 0.0,
          py::arg("peer_requests") = 0, py::arg("peer_has_room") = true, py::arg("work_J") = py::none(),
          py::arg("stale") = false, py::arg("measured") = py::none(),
          "One tick.\n\n"
          "desired, conjugate: (n, 6), n channels; conjugate is the mean over the last interval.\n"
          "dt: seconds since the last tick. received_J: credited by the ledgers since then.\n"
          "peer_requests: how many peers ask for energy (bool or count). peer_has_room: some peer takes overflow.\n"
          "work_J: what really left through the ports; None bills applied_prev . conjugate . dt.\n"
          "stale: conjugate is too old: zero output. measured: (n, 6) the applied side as measured, for a lagging arm.")
      .def("grant", &EnergyTank::grant, py::arg("energy_J"),
           "Puts energy in from outside (engagement). Above maximum_J it is vented. ConfigError when negative or not "
           "finite.")
      .def(
          "reset",
          [](EnergyTank& tank, const std::optional<EnergyTankState>& state) {
            state ? tank.reset(*state) : tank.reset();
          },
          py::arg("state") = py::none(),
          "A restart (level minimum_J, all counters zero), or continuation from a recorded state.")
      .def_property_readonly("state", [](const EnergyTank& tank) { return tank.state(); })
      .def_property_readonly("config", [](const EnergyTank& tank) { return tank.config(); })
      .def_property_readonly("channels", &EnergyTank::channels)
      .def_property_readonly("damping_reserve_J", &EnergyTank::damping_reserve_J,
                             "deepest that damping alone can take the level below minimum_J [J]");
}

void bind_ledger(py::module_& m) {
  py::class_<LedgerSender>(m, "LedgerSender", "Sums what a tank sends to one peer in this session.")
      .def(py::init<std::uint64_t>(), py::arg("session"),
           "session: larger for every restart (such as a clock at start).")
      .def(
          "send",
          [](LedgerSender& s, double energy_J) {
            s.send(energy_J);
            return s.last().sent_J;
          },
          py::arg("energy_J"), "Adds joules that left the tank; returns the cumulative sum.")
      .def(
          "next",
          [](LedgerSender& s) {
            const auto m = s.next();
            return py::make_tuple(m.session, m.seq, m.sent_J);
          },
          "(session, seq, sent_J) for the next message on the wire.")
      .def_property_readonly("session", [](const LedgerSender& s) { return s.last().session; })
      .def_property_readonly("seq", [](const LedgerSender& s) { return s.last().seq; })
      .def_property_readonly("sent_J", [](const LedgerSender& s) { return s.last().sent_J; });
  using R = LedgerReceiverState;
  Struct<R>(m, "LedgerReceiverState", "All that a LedgerReceiver remembers.")
      .field("has_baseline", &R::has_baseline, "a message of this session was seen")
      .field("session", &R::session, "the sender's session")
      .field("seq", &R::seq, "newest message")
      .field("seen_J", &R::seen_J, "newest cumulative total [J]")
      .field("credited_J", &R::credited_J, "credited over all sessions [J]")
      .field("ignored", &R::ignored, "messages not used");
  py::class_<LedgerReceiver>(m, "LedgerReceiver", "Turns a peer's cumulative sums into credits, each joule once.")
      .def(py::init<>())
      .def(
          "credit",
          [](LedgerReceiver& r, std::uint64_t session, std::uint64_t seq, double sent_J) {
            return r.credit({session, seq, sent_J});
          },
          py::arg("session"), py::arg("seq"), py::arg("sent_J"),
          "Joules to credit. 0 for the first message of a session (the baseline), older sessions, repeats, bad "
          "numbers.")
      .def("reset", [](LedgerReceiver& r) { r.reset(); })
      .def_property_readonly("state", [](const LedgerReceiver& r) { return r.state(); });
}

}  // namespace

void bind_energy_tank(py::module_& m) {
  bind_tank(m);
  bind_ledger(m);
}

}  // namespace saras::bindings
