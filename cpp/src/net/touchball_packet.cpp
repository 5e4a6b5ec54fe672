#include "saras/net/touchball_packet.hpp"

#include <cstring>

#include "saras/net/crc32.hpp"
#include "saras/spatial/errors.hpp"
#include "wire.hpp"

namespace saras {
namespace {

constexpr std::uint32_t kUpMagic = 0x55425453;         // "STBU" as bytes
constexpr std::uint32_t kDownMagic = 0x44425453;       // "STBD" as bytes
constexpr std::uint32_t kHandshakeMagic = 0x48425453;  // "STBH" as bytes
constexpr std::uint16_t kAuthenticatedFlag = 1;
constexpr std::size_t kChecksumSize = 4;
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

template <typename Wire>
void body(Wire& wire, const TouchballUp& packet) {
  up_body(wire, packet);
}
template <typename Wire>
void body(Wire& wire, const TouchballDown& packet) {
  down_body(wire, packet);
}
void body(wire::Reader& wire, TouchballUp& packet) { up_body(wire, packet); }
void body(wire::Reader& wire, TouchballDown& packet) { down_body(wire, packet); }

template <typename Wire, typename Packet>
void handshake_body(Wire& wire, Packet& packet) {
  for (auto& byte : packet.nonce) {
    wire.integer(byte);
  }
  for (auto& byte : packet.echo) {
    wire.integer(byte);
  }
}
void body(wire::Writer& wire, const TouchballHandshake& packet) { handshake_body(wire, packet); }
void body(wire::Reader& wire, TouchballHandshake& packet) { handshake_body(wire, packet); }

/// Frame of each packet.
template <typename Packet>
struct Frame;
template <>
struct Frame<TouchballUp> {
  static constexpr std::uint32_t magic = kUpMagic;
  static constexpr std::size_t size = kTouchballUpSize;
};
template <>
struct Frame<TouchballDown> {
  static constexpr std::uint32_t magic = kDownMagic;
  static constexpr std::size_t size = kTouchballDownSize;
};
template <>
struct Frame<TouchballHandshake> {
  static constexpr std::uint32_t magic = kHandshakeMagic;
  static constexpr std::size_t size = kTouchballHandshakeSize;
};

template <typename Packet>
PacketFault encode_as(const Packet& packet, std::array<std::uint8_t, Frame<Packet>::size>& bytes,
                      Authentication authentication) noexcept {
  wire::Writer writer(bytes.data());
  writer.integer(Frame<Packet>::magic);
  writer.integer(kTouchballVersion);
  writer.integer(authentication == Authentication::kTag ? kAuthenticatedFlag : std::uint16_t{0});
  body(writer, packet);
  std::memset(bytes.data() + bytes.size() - kTouchballTrailerSize, 0, kTouchballTrailerSize);
  if (authentication == Authentication::kNone) {
    wire::put(bytes.data() + bytes.size() - kChecksumSize, crc32(bytes.data(), bytes.size() - kChecksumSize), 4);
  }
  return writer.fault();
}

PacketFault fault(PacketError error, const char* field, double value, double expected) {
  return {error, "", field, -1, value, expected, expected};
}

/// What the sender cannot have meant for this receiver, or for a receiver with (without) a key.
template <typename Packet>
PacketFault frame_fault(const std::uint8_t* data, std::size_t size, Authentication authentication) noexcept {
  if (data == nullptr || size != Frame<Packet>::size) {
    return fault(PacketError::kSize, "size", static_cast<double>(size), static_cast<double>(Frame<Packet>::size));
  }
  const auto magic = wire::get(data, 4);
  if (magic != Frame<Packet>::magic) {
    return fault(PacketError::kMagic, "magic", static_cast<double>(magic), static_cast<double>(Frame<Packet>::magic));
  }
  const auto version = wire::get(data + 4, 2);
  if (version != kTouchballVersion) {
    return fault(PacketError::kVersion, "version", static_cast<double>(version), kTouchballVersion);
  }
  const auto flags = wire::get(data + 6, 2);
  if (flags & ~std::uint64_t{kAuthenticatedFlag}) {
    return fault(PacketError::kReserved, "flags", static_cast<double>(flags), 0);
  }
  const bool wanted = authentication == Authentication::kTag;
  if ((flags == kAuthenticatedFlag) != wanted) {
    return fault(wanted ? PacketError::kUnauthenticated : PacketError::kAuthenticated, "flags",
                 static_cast<double>(flags), wanted ? 1 : 0);
  }
  return {};
}

PacketFault trailer_fault(const std::uint8_t* data, std::size_t size, Authentication authentication) noexcept {
  const auto checksum = wire::get(data + size - kChecksumSize, 4);
  const auto computed = crc32(data, size - kChecksumSize);
  if (checksum != computed) {
    return fault(PacketError::kChecksum, "checksum", static_cast<double>(checksum), static_cast<double>(computed));
  }
  for (std::size_t i = 0; authentication == Authentication::kNone && i < kTouchballTagSize; ++i) {
    const auto byte = data[size - kTouchballTrailerSize + i];
    if (byte != 0) {
      return fault(PacketError::kReserved, "authentication", byte, 0);
    }
  }
  return {};
}

template <typename Packet>
PacketFault decode_as(const std::uint8_t* data, std::size_t size, Packet& packet,
                      Authentication authentication) noexcept {
  if (const PacketFault frame = frame_fault<Packet>(data, size, authentication)) {
    return frame;
  }
  if (const PacketFault trailer = trailer_fault(data, size, authentication)) {
    return trailer;
  }
  Packet decoded;
  wire::Reader reader(data + 8);
  body(reader, decoded);
  if (!reader.fault()) {
    packet = decoded;
  }
  return reader.fault();
}

template <typename Bytes, typename Packet>
Bytes encode_or_throw(const Packet& packet, Authentication authentication) {
  Bytes bytes;
  if (const PacketFault refused = encode(packet, bytes, authentication)) {
    throw ProtocolError(to_string(refused));
  }
  return bytes;
}

template <typename Packet>
Packet decode_or_throw(const std::uint8_t* data, std::size_t size, Authentication authentication) {
  Packet packet;
  if (const PacketFault refused = decode_as(data, size, packet, authentication)) {
    throw ProtocolError(to_string(refused));
  }
  return packet;
}

}  // namespace

PacketFault encode(const TouchballUp& packet, TouchballUpBytes& bytes, Authentication authentication) noexcept {
  return encode_as(packet, bytes, authentication);
}
PacketFault encode(const TouchballDown& packet, TouchballDownBytes& bytes, Authentication authentication) noexcept {
  return encode_as(packet, bytes, authentication);
}
void encode(const TouchballHandshake& packet, TouchballHandshakeBytes& bytes) noexcept {
  encode_as(packet, bytes, Authentication::kTag);
}

void seal(std::uint8_t* bytes, std::size_t size, const std::uint8_t* tag) noexcept {
  std::memcpy(bytes + size - kTouchballTrailerSize, tag, kTouchballTagSize);
  wire::put(bytes + size - kChecksumSize, crc32(bytes, size - kChecksumSize), 4);
}

template <typename Packet>
PacketFault check_frame(const std::uint8_t* data, std::size_t size, Authentication authentication) noexcept {
  return frame_fault<Packet>(data, size, authentication);
}
template PacketFault check_frame<TouchballUp>(const std::uint8_t*, std::size_t, Authentication) noexcept;
template PacketFault check_frame<TouchballDown>(const std::uint8_t*, std::size_t, Authentication) noexcept;
template PacketFault check_frame<TouchballHandshake>(const std::uint8_t*, std::size_t, Authentication) noexcept;

PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballUp& packet,
                   Authentication authentication) noexcept {
  return decode_as(data, size, packet, authentication);
}
PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballDown& packet,
                   Authentication authentication) noexcept {
  return decode_as(data, size, packet, authentication);
}
PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballHandshake& packet) noexcept {
  return decode_as(data, size, packet, Authentication::kTag);
}

TouchballUpBytes encode(const TouchballUp& packet, Authentication authentication) {
  return encode_or_throw<TouchballUpBytes>(packet, authentication);
}
TouchballDownBytes encode(const TouchballDown& packet, Authentication authentication) {
  return encode_or_throw<TouchballDownBytes>(packet, authentication);
}
TouchballUp decode_up(const std::uint8_t* data, std::size_t size, Authentication authentication) {
  return decode_or_throw<TouchballUp>(data, size, authentication);
}
TouchballDown decode_down(const std::uint8_t* data, std::size_t size, Authentication authentication) {
  return decode_or_throw<TouchballDown>(data, size, authentication);
}
TouchballHandshake decode_handshake(const std::uint8_t* data, std::size_t size) {
  return decode_or_throw<TouchballHandshake>(data, size, Authentication::kTag);
}

}  // namespace saras
