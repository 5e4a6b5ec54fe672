#include "saras/net/touchball_packet.hpp"

#include "frame.hpp"

namespace saras {
namespace {

constexpr std::uint32_t kUpMagic = 0x55425453;         // "STBU" as bytes
constexpr std::uint32_t kDownMagic = 0x44425453;       // "STBD" as bytes
constexpr std::uint32_t kHandshakeMagic = 0x48425453;  // "STBH" as bytes
constexpr double kPositionLimit_m = 10.0;  // a handle is within arm's reach: refuses millimetres sent as metres

// Layouts. `Packet` is const when writing. The order of the lines is the order of the bytes.

template <typename Wire, typename Ledger>
void ledger_body(Wire& wire, Ledger& ledger) {
  wire.integer(ledger.session);
  wire.integer(ledger.seq);
  wire.number("ledger.sent_J", ledger.sent_J, 0.0);
}

template <typename Wire, typename Guard>
void guard_body(Wire& wire, Guard& guard) {
  wire.number("guard.energy_J", guard.energy_J);
  wire.number("guard.minimum_J", guard.minimum_J);
  wire.number("guard.request_J", guard.request_J);
  wire.number("guard.available_J", guard.available_J);
  wire.number("guard.maximum_J", guard.maximum_J);
  wire.number("guard.reduction", guard.reduction, 0.0, 1.0);
  wire.number("guard.scale", guard.scale, 0.0, 1.0);
  wire.vector("guard.damping", guard.damping);
  wire.number("guard.work_out_J", guard.work_out_J);
  wire.number("guard.received_J", guard.received_J);
  wire.number("guard.vented_J", guard.vented_J);
  wire.number("guard.granted_J", guard.granted_J);
}

template <typename Wire, typename Side>
void up_side_body(Wire& wire, const char* name, Side& side) {
  wire.side(name);
  wire.flags(side.present, side.calibrated, side.clutch, side.clip, side.ledger.requesting, side.ledger.has_room);
  wire.enumeration("guard.status", side.guard.status, Status::kRateExceeded);
  wire.vector("handle_position", side.simball_T_handle.translation, -kPositionLimit_m, kPositionLimit_m);
  wire.quaternion("handle_quaternion", side.simball_T_handle.rotation);
  wire.number("joints.yaw_rad", side.joints.yaw_rad);
  wire.number("joints.pitch_rad", side.joints.pitch_rad);
  wire.number("joints.roll_rad", side.joints.roll_rad);
  wire.number("joints.insertion_m", side.joints.insertion_m, -kPositionLimit_m, kPositionLimit_m);
  wire.number("grip", side.grip, 0.0, 1.0);
  ledger_body(wire, side.ledger);
  guard_body(wire, side.guard);
}

template <typename Wire, typename Side>
void down_side_body(Wire& wire, const char* name, Side& side) {
  wire.side(name);
  wire.flags(side.ledger.requesting, side.ledger.has_room);
  wire.enumeration("state", side.state, ChannelState::kHold);
  wire.integer(side.engagement);
  wire.vector("touch_wrench.force", side.touch_wrench.force);
  wire.vector("touch_wrench.torque", side.touch_wrench.torque);
  ledger_body(wire, side.ledger);
}

template <typename Wire, typename Packet>
void stream_body(Wire& wire, Packet& packet) {
  wire.integer(packet.session);
  wire.integer(packet.seq);
  wire.integer(packet.sender_time_ns);
}

template <typename Wire, typename Packet>
void up_body(Wire& wire, Packet& packet) {
  stream_body(wire, packet);
  up_side_body(wire, "left", packet.left);
  up_side_body(wire, "right", packet.right);
}

template <typename Wire, typename Packet>
void down_body(Wire& wire, Packet& packet) {
  stream_body(wire, packet);
  wire.integer(packet.echo_session);
  wire.integer(packet.echo_seq);
  wire.integer(packet.echo_time_ns);
  wire.integer(packet.echo_hold_ns);
  down_side_body(wire, "left", packet.left);
  down_side_body(wire, "right", packet.right);
}

}  // namespace

template <>
struct wire::Frame<TouchballUp> {
  static constexpr std::uint32_t magic = kUpMagic;
  static constexpr std::uint16_t version = kTouchballVersion;
  static constexpr std::size_t size = kTouchballUpSize;
  template <typename Wire, typename Packet>
  static void body(Wire& wire, Packet& packet) {
    up_body(wire, packet);
  }
};
template <>
struct wire::Frame<TouchballDown> {
  static constexpr std::uint32_t magic = kDownMagic;
  static constexpr std::uint16_t version = kTouchballVersion;
  static constexpr std::size_t size = kTouchballDownSize;
  template <typename Wire, typename Packet>
  static void body(Wire& wire, Packet& packet) {
    down_body(wire, packet);
  }
};
template <>
struct wire::Frame<TouchballHandshake> {
  static constexpr std::uint32_t magic = kHandshakeMagic;
  static constexpr std::uint16_t version = kTouchballVersion;
  static constexpr std::size_t size = kTouchballHandshakeSize;
  template <typename Wire, typename Packet>
  static void body(Wire& to, Packet& packet) {
    handshake_body(to, packet);
  }
};

PacketFault encode(const TouchballUp& packet, TouchballUpBytes& bytes, Authentication authentication) noexcept {
  return wire::encode_frame(packet, bytes, authentication);
}
PacketFault encode(const TouchballDown& packet, TouchballDownBytes& bytes, Authentication authentication) noexcept {
  return wire::encode_frame(packet, bytes, authentication);
}
void encode(const TouchballHandshake& packet, TouchballHandshakeBytes& bytes) noexcept {
  wire::encode_frame(packet, bytes, Authentication::kTag);
}

template PacketFault check_frame<TouchballUp>(const std::uint8_t*, std::size_t, Authentication) noexcept;
template PacketFault check_frame<TouchballDown>(const std::uint8_t*, std::size_t, Authentication) noexcept;
template PacketFault check_frame<TouchballHandshake>(const std::uint8_t*, std::size_t, Authentication) noexcept;

PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballUp& packet,
                   Authentication authentication) noexcept {
  return wire::decode_frame(data, size, packet, authentication);
}
PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballDown& packet,
                   Authentication authentication) noexcept {
  return wire::decode_frame(data, size, packet, authentication);
}
PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballHandshake& packet) noexcept {
  return wire::decode_frame(data, size, packet, Authentication::kTag);
}

TouchballUpBytes encode(const TouchballUp& packet, Authentication authentication) {
  return wire::encode_or_throw(packet, authentication);
}
TouchballDownBytes encode(const TouchballDown& packet, Authentication authentication) {
  return wire::encode_or_throw(packet, authentication);
}
TouchballUp decode_up(const std::uint8_t* data, std::size_t size, Authentication authentication) {
  return wire::decode_or_throw<TouchballUp>(data, size, authentication);
}
TouchballDown decode_down(const std::uint8_t* data, std::size_t size, Authentication authentication) {
  return wire::decode_or_throw<TouchballDown>(data, size, authentication);
}
TouchballHandshake decode_handshake(const std::uint8_t* data, std::size_t size) {
  return wire::decode_or_throw<TouchballHandshake>(data, size, Authentication::kTag);
}

}  // namespace saras
