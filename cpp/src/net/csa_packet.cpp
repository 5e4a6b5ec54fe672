#include "saras/net/csa_packet.hpp"

#include "frame.hpp"

namespace saras {
namespace {

constexpr double kPositionLimit_m = 10.0;  // refuses millimetres sent as metres

// Layouts. `Packet` is const when writing. The order of the lines is the order of the bytes.

/// All places are sent; those behind the last joint must be 0, so that equal packets are equal bytes.
template <typename Wire, typename Joints>
void joints_body(Wire& to, const char* field, Joints& values, std::uint32_t joints) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool used = i < joints;
    to.number(field, values[i], used ? -wire::kUnbounded : 0.0, used ? wire::kUnbounded : 0.0, static_cast<int>(i));
  }
}

template <typename Wire, typename Stream>
void stream_body(Wire& wire, Stream& stream) {
  wire.integer(stream.session);
  wire.integer(stream.seq);
  wire.integer(stream.sender_time_ns);
  wire.integer(stream.echo_session);
  wire.integer(stream.echo_seq);
  wire.integer(stream.echo_time_ns);
  wire.integer(stream.echo_hold_ns);
}

template <typename Wire, typename AnyPose>
void pose_body(Wire& wire, AnyPose& pose) {
  wire.vector("tip_position", pose.translation, -kPositionLimit_m, kPositionLimit_m);
  wire.quaternion("tip_quaternion", pose.rotation);
}

template <typename Wire, typename Up>
void up_body(Wire& wire, Up& up) {
  stream_body(wire, up);
  wire.flags(up.homed, up.has_force);
  wire.enumeration("state", up.state, CsaSlaveState::kFault);
  wire.enumeration("hold", up.hold, CsaHold::kDeviceFault);
  wire.count("joints", up.joints, 1, kCsaMaxJoints);
  wire.integer(up.engagement);
  joints_body(wire, "position", up.position, up.joints);
  joints_body(wire, "velocity", up.velocity, up.joints);
  joints_body(wire, "effort", up.effort, up.joints);
  pose_body(wire, up.base_T_tip);
  wire.vector("tip_twist.linear", up.tip_twist.linear);
  wire.vector("tip_twist.angular", up.tip_twist.angular);
  wire.vector("tip_wrench.force", up.tip_wrench.force);
  wire.vector("tip_wrench.torque", up.tip_wrench.torque);
}

template <typename Wire, typename Down>
void down_body(Wire& wire, Down& down) {
  stream_body(wire, down);
  wire.enumeration("mode", down.mode, CsaMode::kCartesian);
  const bool in_joints = down.mode == CsaMode::kJoints;
  wire.count("joints", down.joints, in_joints ? 1 : 0, in_joints ? kCsaMaxJoints : 0);
  wire.integer(down.engagement);
  joints_body(wire, "position", down.position, down.joints);
  pose_body(wire, down.base_T_tip);
}

}  // namespace

template <>
struct wire::Frame<CsaUp> {
  static constexpr std::uint32_t magic = 0x55534353;  // "SCSU" as bytes
  static constexpr std::uint16_t version = kCsaVersion;
  static constexpr std::size_t size = kCsaUpSize;
  template <typename Wire, typename Packet>
  static void body(Wire& to, Packet& packet) {
    up_body(to, packet);
  }
};
template <>
struct wire::Frame<CsaDown> {
  static constexpr std::uint32_t magic = 0x44534353;  // "SCSD" as bytes
  static constexpr std::uint16_t version = kCsaVersion;
  static constexpr std::size_t size = kCsaDownSize;
  template <typename Wire, typename Packet>
  static void body(Wire& to, Packet& packet) {
    down_body(to, packet);
  }
};
template <>
struct wire::Frame<CsaHandshake> {
  static constexpr std::uint32_t magic = 0x48534353;  // "SCSH" as bytes
  static constexpr std::uint16_t version = kCsaVersion;
  static constexpr std::size_t size = kHandshakeSize;
  template <typename Wire, typename Packet>
  static void body(Wire& to, Packet& packet) {
    handshake_body(to, packet);
  }
};

PacketFault encode(const CsaUp& packet, CsaUpBytes& bytes, Authentication authentication) noexcept {
  return wire::encode_frame(packet, bytes, authentication);
}
PacketFault encode(const CsaDown& packet, CsaDownBytes& bytes, Authentication authentication) noexcept {
  return wire::encode_frame(packet, bytes, authentication);
}
void encode(const CsaHandshake& packet, CsaHandshakeBytes& bytes) noexcept {
  wire::encode_frame(packet, bytes, Authentication::kTag);
}

template PacketFault check_frame<CsaUp>(const std::uint8_t*, std::size_t, Authentication) noexcept;
template PacketFault check_frame<CsaDown>(const std::uint8_t*, std::size_t, Authentication) noexcept;
template PacketFault check_frame<CsaHandshake>(const std::uint8_t*, std::size_t, Authentication) noexcept;

PacketFault decode(const std::uint8_t* data, std::size_t size, CsaUp& packet, Authentication authentication) noexcept {
  return wire::decode_frame(data, size, packet, authentication);
}
PacketFault decode(const std::uint8_t* data, std::size_t size, CsaDown& packet,
                   Authentication authentication) noexcept {
  return wire::decode_frame(data, size, packet, authentication);
}
PacketFault decode(const std::uint8_t* data, std::size_t size, CsaHandshake& packet) noexcept {
  return wire::decode_frame(data, size, packet, Authentication::kTag);
}

CsaUpBytes encode(const CsaUp& packet, Authentication authentication) {
  return wire::encode_or_throw(packet, authentication);
}
CsaDownBytes encode(const CsaDown& packet, Authentication authentication) {
  return wire::encode_or_throw(packet, authentication);
}
CsaUp decode_csa_up(const std::uint8_t* data, std::size_t size, Authentication authentication) {
  return wire::decode_or_throw<CsaUp>(data, size, authentication);
}
CsaDown decode_csa_down(const std::uint8_t* data, std::size_t size, Authentication authentication) {
  return wire::decode_or_throw<CsaDown>(data, size, authentication);
}
CsaHandshake decode_csa_handshake(const std::uint8_t* data, std::size_t size) {
  return wire::decode_or_throw<CsaHandshake>(data, size, Authentication::kTag);
}

}  // namespace saras
