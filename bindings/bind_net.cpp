#include "bind_net.hpp"

#include "rooms.hpp"
#include "saras/net/crc32.hpp"
#include "saras/net/link_age.hpp"
#include "saras/net/replay_window.hpp"
#include "saras/net/sequence_filter.hpp"
#include "saras/net/touchball_packet.hpp"

namespace saras::bindings {
namespace {

void bind_parts(py::module_& m) {
  py::enum_<ChannelState>(m, "ChannelState", "Whether one side teleoperates. Same numbers as saras_ros1/ChannelState.")
      .value("WAITING", ChannelState::kWaiting)
      .value("READY", ChannelState::kReady)
      .value("ENGAGED", ChannelState::kEngaged)
      .value("HOLD", ChannelState::kHold);
  Struct<SimballJoints>(m, "SimballJoints", "Joints of the Simball handle.")
      .field("yaw_rad", &SimballJoints::yaw_rad, "[rad]")
      .field("pitch_rad", &SimballJoints::pitch_rad, "[rad]")
      .field("roll_rad", &SimballJoints::roll_rad, "[rad]; turns the instrument")
      .field("insertion_m", &SimballJoints::insertion_m, "[m]");
  Struct<PortLedger>(m, "PortLedger", "Energy sent to the peer's tank, cumulative over a session.")
      .field("session", &PortLedger::session, "larger for every restart of the sending tank")
      .field("seq", &PortLedger::seq, "counts messages of this session")
      .field("sent_J", &PortLedger::sent_J, "cumulative energy sent in this session [J], >= 0")
      .field("requesting", &PortLedger::requesting, "the sender's tank asks for energy")
      .field("has_room", &PortLedger::has_room, "the sender's tank can take more");
  Struct<GuardState>(m, "GuardState", "The port guard's tank, for display and recording only.")
      .field("energy_J", &GuardState::energy_J, "stored energy [J]")
      .field("minimum_J", &GuardState::minimum_J, "threshold [J]")
      .field("request_J", &GuardState::request_J, "threshold [J]")
      .field("available_J", &GuardState::available_J, "threshold [J]")
      .field("maximum_J", &GuardState::maximum_J, "threshold [J]")
      .field("reduction", &GuardState::reduction, "K_E in [0, 1]")
      .field("scale", &GuardState::scale, "alpha in [0, 1]")
      .field("damping", &GuardState::damping, "(6,) B now [N s/m, N m s/rad]")
      .field("work_out_J", &GuardState::work_out_J, "cumulative work done on the operator [J]")
      .field("received_J", &GuardState::received_J, "cumulative energy credited from tank_master [J]")
      .field("vented_J", &GuardState::vented_J, "cumulative energy discarded [J]")
      .field("granted_J", &GuardState::granted_J, "cumulative energy granted [J]")
      .field("status", &GuardState::status, "saras.Status");
}

void bind_up(py::module_& m) {
  Struct<TouchballUpSide> side(m, "TouchballUpSide", "One handle, console to platform.");
  side.field("present", &TouchballUpSide::present, "a handle is attached and gives valid readings")
      .field("calibrated", &TouchballUpSide::calibrated, "its joints and clip were calibrated")
      .field("clutch", &TouchballUpSide::clutch, "pressed; a level, repeated in every datagram")
      .field("clip", &TouchballUpSide::clip, "the clip is closed; a level")
      .field("simball_T_handle", &TouchballUpSide::simball_T_handle, "(4, 4) handle in simball_base")
      .field(
          "handle_position_m", [](const TouchballUpSide& s) -> Vector3 { return s.simball_T_handle.translation; },
          [](TouchballUpSide& s, const Vector3& v) { s.simball_T_handle.translation = v; }, "(3,) as on the wire [m]")
      .field(
          "handle_quaternion_xyzw",
          [](const TouchballUpSide& s) -> Eigen::Vector4d { return s.simball_T_handle.rotation.coeffs(); },
          [](TouchballUpSide& s, const Eigen::Vector4d& v) { s.simball_T_handle.rotation.coeffs() = v; },
          "(4,) unit quaternion as on the wire, scalar last");
  nested(side, "joints", &TouchballUpSide::joints, "SimballJoints");
  side.field("grip", &TouchballUpSide::grip, "opening of the clip: 0 closed to 1 open");
  nested(side, "ledger", &TouchballUpSide::ledger, "the port guard's, to tank_master");
  nested(side, "guard", &TouchballUpSide::guard, "the port guard's tank, for display");

  Struct<TouchballUp> packet(m, "TouchballUp", "Datagram from a console to the platform.");
  packet.field("session", &TouchballUp::session, "larger for every restart of the console")
      .field("seq", &TouchballUp::seq, "counts datagrams of this session")
      .field("sender_time_ns", &TouchballUp::sender_time_ns, "sender's monotonic clock [ns]");
  nested(packet, "left", &TouchballUp::left, "TouchballUpSide");
  nested(packet, "right", &TouchballUp::right, "TouchballUpSide");
  bind_codec(packet, decode_up, kTouchballUpSize);
}

void bind_down(py::module_& m) {
  Struct<TouchballDownSide> side(m, "TouchballDownSide", "One handle, platform to console.");
  side.field("touch_wrench", &TouchballDownSide::touch_wrench, "(6,) to exert on the hand, touch frame [N, N m]")
      .field("state", &TouchballDownSide::state, "ChannelState")
      .field("engagement", &TouchballDownSide::engagement, "counts engagements");
  nested(side, "ledger", &TouchballDownSide::ledger, "tank_master's, to this port guard");

  Struct<TouchballDown> packet(m, "TouchballDown", "Datagram from the platform to a console.");
  packet.field("session", &TouchballDown::session, "larger for every restart of the platform's sender")
      .field("seq", &TouchballDown::seq, "counts datagrams of this session")
      .field("sender_time_ns", &TouchballDown::sender_time_ns, "sender's monotonic clock [ns]")
      .field("echo_session", &TouchballDown::echo_session, "newest up datagram seen; 0: none yet")
      .field("echo_seq", &TouchballDown::echo_seq, "its seq")
      .field("echo_time_ns", &TouchballDown::echo_time_ns, "its sender_time_ns")
      .field("echo_hold_ns", &TouchballDown::echo_hold_ns, "from its arrival to the sending of this datagram [ns]");
  nested(packet, "left", &TouchballDown::left, "TouchballDownSide");
  nested(packet, "right", &TouchballDown::right, "TouchballDownSide");
  bind_codec(packet, decode_down, kTouchballDownSize);
}

void bind_seal(py::module_& m) {
  m.def(
      "seal",
      [](const py::bytes& data, const py::bytes& tag) {
        std::string bytes = data;
        const std::string value = tag;
        if (bytes.size() < kPacketTrailerSize || value.size() != kPacketTagSize) {
          throw ProtocolError("seal: " + std::to_string(bytes.size()) + " bytes with a tag of " +
                              std::to_string(value.size()) + ": must be at least 20 and 16");
        }
        seal(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size(),
             reinterpret_cast<const std::uint8_t*>(value.data()));
        return py::bytes(bytes);
      },
      py::arg("data"), py::arg("tag"),
      "An encoded datagram with its tag (16 bytes) and checksum at the end. The tag is that of data[:-TRAILER_SIZE].");
  m.attr("TAG_SIZE") = kPacketTagSize;
  m.attr("TRAILER_SIZE") = kPacketTrailerSize;
}

void bind_stream(py::module_& m) {
  Struct<SequenceCounts>(m, "SequenceCounts", "What a SequenceFilter saw [datagrams].")
      .field("accepted", &SequenceCounts::accepted, "newer than all before")
      .field("duplicate", &SequenceCounts::duplicate, "already received")
      .field("out_of_order", &SequenceCounts::out_of_order, "older than the newest")
      .field("old_session", &SequenceCounts::old_session, "from an earlier run of the sender")
      .field("gaps", &SequenceCounts::gaps, "numbers skipped by an accepted one")
      .field("sessions", &SequenceCounts::sessions, "sessions seen");
  py::class_<SequenceFilter>(m, "SequenceFilter", "Newest-wins filter: nothing is delivered backwards or twice.")
      .def(py::init<>())
      .def("accept", &SequenceFilter::accept, py::arg("session"), py::arg("seq"), "True when strictly newer.")
      .def("restart", &SequenceFilter::restart, "A handshake began a new session: the next datagram is newest.")
      .def_property_readonly("counts", [](const SequenceFilter& self) { return self.counts(); })
      .def_property_readonly("session", &SequenceFilter::session)
      .def_property_readonly("seq", &SequenceFilter::seq);
  py::enum_<ReplayVerdict>(m, "ReplayVerdict", "What a ReplayWindow says to a sequence number.")
      .value("NEW", ReplayVerdict::kNew)
      .value("REPLAYED", ReplayVerdict::kReplayed)
      .value("TOO_OLD", ReplayVerdict::kTooOld)
      .value("FAR_AHEAD", ReplayVerdict::kFarAhead);
  py::class_<ReplayWindow>(m, "ReplayWindow", "Newest 64 sequence numbers of an authenticated session (RFC 6479).")
      .def(py::init<>())
      .def("accept", &ReplayWindow::accept, py::arg("seq"),
           "ReplayVerdict; notes seq when NEW, else changes nothing. For authenticated datagrams only.")
      .def("reset", &ReplayWindow::reset, "For a new session.")
      .def_property_readonly("newest", &ReplayWindow::newest)
      .def_property_readonly_static("SIZE", [](const py::object&) { return std::uint64_t{ReplayWindow::kSize}; })
      .def_property_readonly_static("MOST_AHEAD",
                                    [](const py::object&) { return std::uint64_t{ReplayWindow::kMostAhead}; });
  py::class_<LinkAge>(m, "LinkAge", "Age of received information above the link's least delay.")
      .def(py::init([](double rise_rate) { return LinkAge({rise_rate}); }),
           py::arg("rise_rate") = LinkAgeConfig{}.rise_rate)
      .def("received", &LinkAge::received, py::arg("send_ns"), py::arg("receive_ns"),
           "Age of this packet on arrival [s].")
      .def("age_s", &LinkAge::age_s, py::arg("now_ns"),
           "Age of the newest information [s]; inf before the first packet.")
      .def("reset", &LinkAge::reset, "Forget the minimum (new session, new clock).");
}

}  // namespace

void bind_net(py::module_& m) {
  bind_parts(m);
  bind_up(m);
  bind_down(m);
  bind_handshake<TouchballHandshake>(m, "TouchballHandshake", decode_handshake);
  bind_seal(m);
  bind_stream(m);
  bind_net_csa(m);
  m.def(
      "crc32", [](const py::buffer& data) { return decode_buffer(data, crc32); }, py::arg("data"),
      "CRC-32 of IEEE 802.3, as zlib.crc32.");
}

}  // namespace saras::bindings
