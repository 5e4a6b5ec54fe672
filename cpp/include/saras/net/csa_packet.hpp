// CSA UDP: the datagrams between the platform and a slave arm elsewhere on the network. Pure codec: no socket, no
// clock.
//
// Fixed little-endian layout, described byte by byte in docs/protocols.md. Up: what the slave measures and whether it
// follows. Down: the set-point, in joints or of the tip. The slave is the end that asks for a session.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "saras/net/packet_fault.hpp"
#include "saras/spatial/types.hpp"

namespace saras {

inline constexpr int kCsaMaxJoints = 12;
using CsaJoints = std::array<double, kCsaMaxJoints>;

/// Operating states of CRTK.
enum class CsaSlaveState : std::uint8_t { kDisabled = 0, kEnabled = 1, kPaused = 2, kFault = 3 };

/// Whether a slave follows the set-points, and why not.
enum class CsaHold : std::uint8_t {
  kNone = 0,     ///< it follows
  kNotEngaged,   ///< no engagement yet, or the platform said HOLD
  kNoSetPoint,   ///< the platform was silent for too long: a new engagement is needed
  kRefused,      ///< the set-point is none that it can follow: a new engagement is needed
  kDeviceFault,  ///< the device itself
};

/// What the slave is to follow.
enum class CsaMode : std::uint8_t { kHold = 0, kJoints = 1, kCartesian = 2 };

/// Stream of a direction, and what of the other one was seen last.
struct CsaStream {
  std::uint64_t session = 0;        ///< larger for every restart of the sender (wall-clock nanoseconds at its start)
  std::uint64_t seq = 0;            ///< counts datagrams of this session
  std::int64_t sender_time_ns = 0;  ///< sender's monotonic clock; not comparable between hosts
  std::uint64_t echo_session = 0;   ///< newest datagram of the other direction (0: none yet)
  std::uint64_t echo_seq = 0;
  std::int64_t echo_time_ns = 0;  ///< its sender_time_ns
  std::int64_t echo_hold_ns = 0;  ///< from its arrival to the sending of this one; round trip = now - time - hold
};

/// Slave to platform. Base frame of the slave.
struct CsaUp : CsaStream {
  bool homed = false;
  bool has_force = false;  ///< tip_wrench is measured; else it means nothing
  CsaSlaveState state = CsaSlaveState::kDisabled;
  CsaHold hold = CsaHold::kNotEngaged;
  std::uint32_t joints = 1;      ///< 1 … kCsaMaxJoints; the elements behind are 0
  std::uint64_t engagement = 0;  ///< the one that it follows, or that it ended
  CsaJoints position{};          ///< [rad] or [m]
  CsaJoints velocity{};          ///< [rad/s] or [m/s]
  CsaJoints effort{};            ///< [N m] or [N]; 0 where it is not measured
  Pose base_T_tip;
  Twist tip_twist;    ///< of the tip, base axes
  Wrench tip_wrench;  ///< exerted on the tissue, at the tip, base axes
};

/// Platform to slave.
struct CsaDown : CsaStream {
  CsaMode mode = CsaMode::kHold;
  std::uint32_t joints = 0;      ///< with kJoints 1 … kCsaMaxJoints, else 0; the elements behind are 0
  std::uint64_t engagement = 0;  ///< larger for every engagement; 0: none
  CsaJoints position{};          ///< set-point with kJoints
  Pose base_T_tip;               ///< set-point with kCartesian
};

struct CsaHandshake : Handshake {};

inline constexpr std::uint16_t kCsaVersion = 1;
inline constexpr std::size_t kCsaUpSize = 548;
inline constexpr std::size_t kCsaDownSize = 252;

using CsaUpBytes = std::array<std::uint8_t, kCsaUpSize>;
using CsaDownBytes = std::array<std::uint8_t, kCsaDownSize>;
using CsaHandshakeBytes = std::array<std::uint8_t, kHandshakeSize>;

/// As for Touchball: on a fault `bytes` are unspecified; with kTag the datagram is whole only after `seal`.
PacketFault encode(const CsaUp& packet, CsaUpBytes& bytes,
                   Authentication authentication = Authentication::kNone) noexcept;
PacketFault encode(const CsaDown& packet, CsaDownBytes& bytes,
                   Authentication authentication = Authentication::kNone) noexcept;
void encode(const CsaHandshake& packet, CsaHandshakeBytes& bytes) noexcept;

/// Decodes strictly; on a fault `packet` stays as it was. The tag is the caller's to check, before.
PacketFault decode(const std::uint8_t* data, std::size_t size, CsaUp& packet,
                   Authentication authentication = Authentication::kNone) noexcept;
PacketFault decode(const std::uint8_t* data, std::size_t size, CsaDown& packet,
                   Authentication authentication = Authentication::kNone) noexcept;
PacketFault decode(const std::uint8_t* data, std::size_t size, CsaHandshake& packet) noexcept;

/// The same, throwing ProtocolError with the fault's text.
CsaUpBytes encode(const CsaUp& packet, Authentication authentication = Authentication::kNone);
CsaDownBytes encode(const CsaDown& packet, Authentication authentication = Authentication::kNone);
CsaUp decode_csa_up(const std::uint8_t* data, std::size_t size, Authentication authentication = Authentication::kNone);
CsaDown decode_csa_down(const std::uint8_t* data, std::size_t size,
                        Authentication authentication = Authentication::kNone);
CsaHandshake decode_csa_handshake(const std::uint8_t* data, std::size_t size);

}  // namespace saras
