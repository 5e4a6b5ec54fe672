// What all datagrams of this project share: a frame with a tag, and why one was refused.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace saras {

/// Whether a datagram carries an authentication tag. Which of the two a receiver wants is its configuration:
/// a datagram's own flag is only compared with it.
enum class Authentication : std::uint8_t { kNone = 0, kTag = 1 };

inline constexpr std::size_t kPacketTagSize = 16;
/// Tag and CRC-32 at the end of a datagram. The tag authenticates all bytes before itself.
inline constexpr std::size_t kPacketTrailerSize = kPacketTagSize + 4;

/// First message, answer and confirmation of the handshake that begins an authenticated session
/// (docs/protocols.md). Always authenticated. Each protocol has its own.
struct Handshake {
  std::array<std::uint8_t, 16> nonce{};  ///< drawn by the sender
  std::array<std::uint8_t, 16> echo{};   ///< the receiver's own nonce, as the sender heard it; 0: none
};
inline constexpr std::size_t kHandshakeSize = 60;

enum class PacketError : std::uint8_t {
  kNone = 0,
  kSize,             ///< not the length of this packet
  kChecksum,         ///< CRC-32 does not match
  kMagic,            ///< another protocol or direction
  kVersion,          ///< another version of this protocol
  kAuthenticated,    ///< has a tag, and the receiver has no key
  kUnauthenticated,  ///< has no tag, and the receiver has a key
  kReserved,         ///< a reserved bit or byte is set
  kNotFinite,
  kOutOfRange,
  kNotUnit,  ///< quaternion norm differs from 1 by more than 1e-6
};

/// Why a packet was refused. `side` and `field` are static strings; "" when not about a side.
struct PacketFault {
  PacketError error = PacketError::kNone;
  const char* side = "";
  const char* field = "";
  int element = -1;    ///< index within the field, -1 for a scalar
  double value = 0.0;  ///< the refused value
  double lowest = 0.0, highest = 0.0;
  explicit operator bool() const noexcept { return error != PacketError::kNone; }
};

/// "left.grip = 1.5: must be in [0, 1]"
std::string to_string(const PacketFault& fault);

/// What is checked before the tag: length, magic, version and whether there is a tag. Reads no other field.
template <typename Packet>
PacketFault check_frame(const std::uint8_t* data, std::size_t size, Authentication authentication) noexcept;

/// Puts tag and CRC-32 at the end of an encoded datagram of `size` bytes, which must be at least the trailer's.
void seal(std::uint8_t* bytes, std::size_t size, const std::uint8_t* tag) noexcept;

}  // namespace saras
