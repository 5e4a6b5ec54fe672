#include "saras/net/touchball_packet.hpp"

#include "saras/net/crc32.hpp"
#include "saras/spatial/errors.hpp"
#include "wire.hpp"

namespace saras {
namespace {

constexpr std::uint32_t kUpMagic = 0x55425453;    // "STBU" as bytes
constexpr std::uint32_t kDownMagic = 0x44425453;  // "STBD" as bytes
constexpr std::uint16_t kAuthenticatedFlag = 1;
constexpr std::size_t kAuthenticationSize = 16;
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

template <typename Packet, std::size_t size>
PacketFault encode_as(std::uint32_t magic, const Packet& packet, std::array<std::uint8_t, size>& bytes) noexcept {
  wire::Writer writer(bytes.data());
  writer.integer(magic);
  writer.integer(kTouchballVersion);
  writer.integer(std::uint16_t{0});
  body(writer, packet);
  for (std::size_t i = 0; i < kAuthenticationSize; ++i) {
    writer.integer(std::uint8_t{0});
  }
  writer.integer(crc32(bytes.data(), size - kChecksumSize));
  return writer.fault();
}

PacketFault fault(PacketError error, const char* field, double value, double expected) {
  return {error, "", field, -1, value, expected, expected};
}

/// Magic and version come before the checksum, so that a foreign datagram is named as such.
PacketFault check_frame(const std::uint8_t* data, std::size_t size, std::size_t expected,
                        std::uint32_t magic) noexcept {
  if (data == nullptr || size != expected) {
    return fault(PacketError::kSize, "size", static_cast<double>(size), static_cast<double>(expected));
  }
  const auto seen_magic = wire::get(data, 4);
  if (seen_magic != magic) {
    return fault(PacketError::kMagic, "magic", static_cast<double>(seen_magic), static_cast<double>(magic));
  }
  const auto version = wire::get(data + 4, 2);
  if (version != kTouchballVersion) {
    return fault(PacketError::kVersion, "version", static_cast<double>(version), kTouchballVersion);
  }
  const auto checksum = wire::get(data + size - kChecksumSize, 4);
  const auto computed = crc32(data, size - kChecksumSize);
  if (checksum != computed) {
    return fault(PacketError::kChecksum, "checksum", static_cast<double>(checksum), static_cast<double>(computed));
  }
  const auto flags = wire::get(data + 6, 2);
  if (flags & kAuthenticatedFlag) {
    return fault(PacketError::kAuthenticated, "flags", static_cast<double>(flags), 0);
  }
  if (flags != 0) {
    return fault(PacketError::kReserved, "flags", static_cast<double>(flags), 0);
  }
  for (std::size_t i = 0; i < kAuthenticationSize; ++i) {
    const auto byte = data[size - kChecksumSize - kAuthenticationSize + i];
    if (byte != 0) {
      return fault(PacketError::kReserved, "authentication", byte, 0);
    }
  }
  return {};
}

template <typename Packet>
PacketFault decode_as(std::uint32_t magic, const std::uint8_t* data, std::size_t size, std::size_t expected,
                      Packet& packet) noexcept {
  if (const PacketFault frame = check_frame(data, size, expected, magic)) {
    return frame;
  }
  Packet decoded;
  wire::Reader reader(data + 8);
  body(reader, decoded);
  if (!reader.fault()) {
    packet = decoded;
  }
  return reader.fault();
}

template <typename Packet>
Packet decode_or_throw(const std::uint8_t* data, std::size_t size) {
  Packet packet;
  if (const PacketFault refused = decode(data, size, packet)) {
    throw ProtocolError(to_string(refused));
  }
  return packet;
}

template <typename Bytes, typename Packet>
Bytes encode_or_throw(const Packet& packet) {
  Bytes bytes;
  if (const PacketFault refused = encode(packet, bytes)) {
    throw ProtocolError(to_string(refused));
  }
  return bytes;
}

}  // namespace

PacketFault encode(const TouchballUp& packet, TouchballUpBytes& bytes) noexcept {
  return encode_as(kUpMagic, packet, bytes);
}
PacketFault encode(const TouchballDown& packet, TouchballDownBytes& bytes) noexcept {
  return encode_as(kDownMagic, packet, bytes);
}
PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballUp& packet) noexcept {
  return decode_as(kUpMagic, data, size, kTouchballUpSize, packet);
}
PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballDown& packet) noexcept {
  return decode_as(kDownMagic, data, size, kTouchballDownSize, packet);
}

TouchballUpBytes encode(const TouchballUp& packet) { return encode_or_throw<TouchballUpBytes>(packet); }
TouchballDownBytes encode(const TouchballDown& packet) { return encode_or_throw<TouchballDownBytes>(packet); }
TouchballUp decode_up(const std::uint8_t* data, std::size_t size) { return decode_or_throw<TouchballUp>(data, size); }
TouchballDown decode_down(const std::uint8_t* data, std::size_t size) {
  return decode_or_throw<TouchballDown>(data, size);
}

}  // namespace saras
