// The frame of every datagram: magic, version and flags before the body, tag and CRC-32 behind it.
//
// A packet says its magic, version, size and body in a specialisation of Frame; the rest is the same for all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "saras/net/crc32.hpp"
#include "saras/net/packet_fault.hpp"
#include "saras/spatial/errors.hpp"
#include "wire.hpp"

namespace saras::wire {

inline constexpr std::uint16_t kAuthenticatedFlag = 1;
inline constexpr std::size_t kChecksumSize = 4;
inline constexpr std::size_t kHeaderSize = 8;

/// magic, version, size, and body(wire, packet): `packet` is const when writing, the order of its lines is the order of
/// the bytes.
template <typename Packet>
struct Frame;

template <typename Packet>
using BytesOf = std::array<std::uint8_t, Frame<Packet>::size>;

template <typename Wire, typename Packet>
void handshake_body(Wire& wire, Packet& packet) {
  for (auto& byte : packet.nonce) {
    wire.integer(byte);
  }
  for (auto& byte : packet.echo) {
    wire.integer(byte);
  }
}

template <typename Packet>
PacketFault encode_frame(const Packet& packet, BytesOf<Packet>& bytes, Authentication authentication) noexcept {
  Writer writer(bytes.data());
  writer.integer(Frame<Packet>::magic);
  writer.integer(Frame<Packet>::version);
  writer.integer(authentication == Authentication::kTag ? kAuthenticatedFlag : std::uint16_t{0});
  Frame<Packet>::body(writer, packet);
  std::memset(bytes.data() + bytes.size() - kPacketTrailerSize, 0, kPacketTrailerSize);
  if (authentication == Authentication::kNone) {
    put(bytes.data() + bytes.size() - kChecksumSize, crc32(bytes.data(), bytes.size() - kChecksumSize), 4);
  }
  return writer.fault();
}

inline PacketFault frame_refusal(PacketError error, const char* field, double value, double expected) noexcept {
  return {error, "", field, -1, value, expected, expected};
}

/// What the sender cannot have meant for this receiver, or for a receiver with (without) a key.
template <typename Packet>
PacketFault frame_fault(const std::uint8_t* data, std::size_t size, Authentication authentication) noexcept {
  if (data == nullptr || size != Frame<Packet>::size) {
    return frame_refusal(PacketError::kSize, "size", static_cast<double>(size),
                         static_cast<double>(Frame<Packet>::size));
  }
  const auto magic = get(data, 4);
  if (magic != Frame<Packet>::magic) {
    return frame_refusal(PacketError::kMagic, "magic", static_cast<double>(magic),
                         static_cast<double>(Frame<Packet>::magic));
  }
  const auto version = get(data + 4, 2);
  if (version != Frame<Packet>::version) {
    return frame_refusal(PacketError::kVersion, "version", static_cast<double>(version), Frame<Packet>::version);
  }
  const auto flags = get(data + 6, 2);
  if (flags & ~std::uint64_t{kAuthenticatedFlag}) {
    return frame_refusal(PacketError::kReserved, "flags", static_cast<double>(flags), 0);
  }
  const bool wanted = authentication == Authentication::kTag;
  if ((flags == kAuthenticatedFlag) != wanted) {
    return frame_refusal(wanted ? PacketError::kUnauthenticated : PacketError::kAuthenticated, "flags",
                         static_cast<double>(flags), wanted ? 1 : 0);
  }
  return {};
}

inline PacketFault trailer_fault(const std::uint8_t* data, std::size_t size, Authentication authentication) noexcept {
  const auto checksum = get(data + size - kChecksumSize, 4);
  const auto computed = crc32(data, size - kChecksumSize);
  if (checksum != computed) {
    return frame_refusal(PacketError::kChecksum, "checksum", static_cast<double>(checksum),
                         static_cast<double>(computed));
  }
  for (std::size_t i = 0; authentication == Authentication::kNone && i < kPacketTagSize; ++i) {
    const auto byte = data[size - kPacketTrailerSize + i];
    if (byte != 0) {
      return frame_refusal(PacketError::kReserved, "authentication", byte, 0);
    }
  }
  return {};
}

/// On a fault `packet` stays as it was.
template <typename Packet>
PacketFault decode_frame(const std::uint8_t* data, std::size_t size, Packet& packet,
                         Authentication authentication) noexcept {
  if (const PacketFault frame = frame_fault<Packet>(data, size, authentication)) {
    return frame;
  }
  if (const PacketFault trailer = trailer_fault(data, size, authentication)) {
    return trailer;
  }
  Packet decoded;
  Reader reader(data + kHeaderSize);
  Frame<Packet>::body(reader, decoded);
  if (!reader.fault()) {
    packet = decoded;
  }
  return reader.fault();
}

template <typename Packet>
BytesOf<Packet> encode_or_throw(const Packet& packet, Authentication authentication) {
  BytesOf<Packet> bytes;
  if (const PacketFault refused = encode_frame(packet, bytes, authentication)) {
    throw ProtocolError(to_string(refused));
  }
  return bytes;
}

template <typename Packet>
Packet decode_or_throw(const std::uint8_t* data, std::size_t size, Authentication authentication) {
  Packet packet;
  if (const PacketFault refused = decode_frame(data, size, packet, authentication)) {
    throw ProtocolError(to_string(refused));
  }
  return packet;
}

}  // namespace saras::wire

namespace saras {

template <typename Packet>
PacketFault check_frame(const std::uint8_t* data, std::size_t size, Authentication authentication) noexcept {
  return wire::frame_fault<Packet>(data, size, authentication);
}

}  // namespace saras
