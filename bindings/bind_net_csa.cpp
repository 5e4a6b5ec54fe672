#include "bind_net.hpp"
#include "saras/net/csa_packet.hpp"

namespace saras::bindings {
namespace {

using Position = Eigen::Vector3d;
using Coefficients = Eigen::Vector4d;

Array store_joints(const CsaJoints& values, std::uint32_t joints) {
  const auto count = static_cast<py::ssize_t>(std::min<std::uint32_t>(joints, kCsaMaxJoints));
  Array array(count);
  std::copy_n(values.begin(), count, array.mutable_data());
  return array;
}

/// Numbers behind the given ones are 0; more than fit are refused. Returns how many.
std::uint32_t load_joints(CsaJoints& values, const Array& array, const char* field) {
  if (array.ndim() != 1 || array.shape(0) > kCsaMaxJoints) {
    throw ProtocolError(std::string(field) + ": shape " + shape_text(array) + ": must be at most " +
                        std::to_string(kCsaMaxJoints) + " numbers");
  }
  values.fill(0.0);
  std::copy_n(array.data(), array.shape(0), values.begin());
  return static_cast<std::uint32_t>(array.shape(0));
}

/// A member of the stream, under the packet's own type.
template <typename Packet, typename Member>
Member Packet::*of(Member CsaStream::*member) {
  return member;
}

template <typename Packet>
void stream_fields(Struct<Packet>& packet) {
  packet.field("session", of<Packet>(&CsaStream::session), "larger for every restart of the sender")
      .field("seq", of<Packet>(&CsaStream::seq), "counts datagrams of this session")
      .field("sender_time_ns", of<Packet>(&CsaStream::sender_time_ns), "sender's monotonic clock [ns]")
      .field("echo_session", of<Packet>(&CsaStream::echo_session), "newest of the other direction; 0: none yet")
      .field("echo_seq", of<Packet>(&CsaStream::echo_seq), "its seq")
      .field("echo_time_ns", of<Packet>(&CsaStream::echo_time_ns), "its sender_time_ns")
      .field("echo_hold_ns", of<Packet>(&CsaStream::echo_hold_ns), "from its arrival to the sending of this one [ns]");
}

template <typename Packet>
void pose_fields(Struct<Packet>& packet) {
  packet.field("base_T_tip", &Packet::base_T_tip, "(4, 4) tip in the slave's base frame")
      .field(
          "tip_position_m", [](const Packet& self) -> Position { return self.base_T_tip.translation; },
          [](Packet& self, const Position& v) { self.base_T_tip.translation = v; }, "(3,) as on the wire [m]")
      .field(
          "tip_quaternion_xyzw", [](const Packet& self) -> Coefficients { return self.base_T_tip.rotation.coeffs(); },
          [](Packet& self, const Coefficients& v) { self.base_T_tip.rotation.coeffs() = v; },
          "(4,) unit quaternion as on the wire, scalar last");
}

/// position, whose length is the number of joints.
template <typename Packet>
void position_field(Struct<Packet>& packet, const char* doc) {
  packet.field(
      "position", [](const Packet& self) { return store_joints(self.position, self.joints); },
      [](Packet& self, const Array& value) { self.joints = load_joints(self.position, value, "position"); }, doc);
}

void bind_up(py::module_& m) {
  Struct<CsaUp> packet(m, "CsaUp", "Datagram of a slave arm: what it measures, and whether it follows.");
  stream_fields(packet);
  packet.field("homed", &CsaUp::homed, "ready to be enabled")
      .field("has_force", &CsaUp::has_force, "tip_wrench is measured; else it means nothing")
      .field("state", &CsaUp::state, "CsaSlaveState")
      .field("hold", &CsaUp::hold, "CsaHold")
      .field("engagement", &CsaUp::engagement, "the one that it follows, or that it ended");
  position_field(packet, "(n,) n = 1 … 12 joints [rad] or [m]");
  packet
      .field(
          "velocity", [](const CsaUp& self) { return store_joints(self.velocity, self.joints); },
          [](CsaUp& self, const Array& value) { load_joints(self.velocity, value, "velocity"); }, "(n,) [rad/s, m/s]")
      .field(
          "effort", [](const CsaUp& self) { return store_joints(self.effort, self.joints); },
          [](CsaUp& self, const Array& value) { load_joints(self.effort, value, "effort"); },
          "(n,) [N m, N]; 0 where it is not measured");
  pose_fields(packet);
  packet.field("tip_twist", &CsaUp::tip_twist, "(6,) of the tip, base axes")
      .field("tip_wrench", &CsaUp::tip_wrench, "(6,) exerted on the tissue, at the tip, base axes");
  bind_codec(packet, decode_csa_up, kCsaUpSize);
}

void bind_down(py::module_& m) {
  Struct<CsaDown> packet(m, "CsaDown", "Datagram to a slave arm: its set-point.");
  stream_fields(packet);
  packet.field("mode", &CsaDown::mode, "CsaMode")
      .field("engagement", &CsaDown::engagement, "larger for every engagement; 0: none");
  position_field(packet, "(n,) set-point with JOINTS, else empty [rad] or [m]");
  pose_fields(packet);
  bind_codec(packet, decode_csa_down, kCsaDownSize);
}

}  // namespace

void bind_net_csa(py::module_& m) {
  py::enum_<CsaSlaveState>(m, "CsaSlaveState", "Operating state of a slave arm, as in CRTK.")
      .value("DISABLED", CsaSlaveState::kDisabled)
      .value("ENABLED", CsaSlaveState::kEnabled)
      .value("PAUSED", CsaSlaveState::kPaused)
      .value("FAULT", CsaSlaveState::kFault);
  py::enum_<CsaHold>(m, "CsaHold", "Whether a slave follows, and why not.")
      .value("NONE", CsaHold::kNone)
      .value("NOT_ENGAGED", CsaHold::kNotEngaged)
      .value("NO_SET_POINT", CsaHold::kNoSetPoint)
      .value("REFUSED", CsaHold::kRefused)
      .value("DEVICE_FAULT", CsaHold::kDeviceFault);
  py::enum_<CsaMode>(m, "CsaMode", "What a slave is to follow.")
      .value("HOLD", CsaMode::kHold)
      .value("JOINTS", CsaMode::kJoints)
      .value("CARTESIAN", CsaMode::kCartesian);
  bind_up(m);
  bind_down(m);
  bind_handshake<CsaHandshake>(m, "CsaHandshake", decode_csa_handshake);
  m.attr("CSA_MAX_JOINTS") = kCsaMaxJoints;
}

}  // namespace saras::bindings
