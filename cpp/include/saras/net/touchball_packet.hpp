// Touchball UDP: the datagrams between a console and the platform. Pure codec: no socket, no clock.
//
// Fixed little-endian layout, described byte by byte in docs/protocols.md. Up: both handles and their port
// guards. Down: both wrenches, operating states and tank_master's ledgers. Energies travel as cumulative
// joules of a session (a ledger), so that lost or doubled datagrams never make energy.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "saras/net/packet_fault.hpp"
#include "saras/spatial/status.hpp"
#include "saras/spatial/types.hpp"

namespace saras {

/// Whether one side teleoperates. Same numbers as msg/ChannelState.
enum class ChannelState : std::uint8_t { kWaiting = 0, kReady = 1, kEngaged = 2, kHold = 3 };

/// Joints of the Simball handle (see saras/kinematics for the frames).
struct SimballJoints {
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
  double insertion_m = 0.0;
};

/// Energy sent to the peer's tank. The receiver credits the increase since the last newer message.
struct PortLedger {
  std::uint64_t session = 0;  ///< larger for every restart of the sending tank
  std::uint64_t seq = 0;      ///< counts messages of this session
  double sent_J = 0.0;        ///< cumulative energy sent in this session [J], >= 0
  bool requesting = false;    ///< the sender's tank asks for energy
  bool has_room = false;      ///< the sender's tank can take more
};

/// The port guard's tank as displayed and recorded; nothing is computed from it.
struct GuardState {
  double energy_J = 0.0;
  double minimum_J = 0.0;
  double request_J = 0.0;
  double available_J = 0.0;
  double maximum_J = 0.0;
  double reduction = 0.0;             ///< K_E in [0, 1]
  double scale = 0.0;                 ///< alpha in [0, 1]
  Vector6 damping = Vector6::Zero();  ///< B now [N s/m, N m s/rad]
  double work_out_J = 0.0;            ///< cumulative work done on the operator
  double received_J = 0.0;            ///< cumulative energy credited from tank_master
  double vented_J = 0.0;
  double granted_J = 0.0;
  Status status = Status::kWaiting;
};

/// One handle, console to platform.
struct TouchballUpSide {
  bool present = false;     ///< a handle is attached and gives valid readings; else the rest is default
  bool calibrated = false;  ///< its joints and clip were calibrated
  bool clutch = false;      ///< level, not edge: repeated in every datagram
  bool clip = false;        ///< the clip is closed (level)
  Pose simball_T_handle;
  SimballJoints joints;
  double grip = 0.0;  ///< opening of the clip: 0 closed to 1 open
  PortLedger ledger;  ///< the port guard's, to tank_master
  GuardState guard;
};

struct TouchballUp {
  std::uint64_t session = 0;        ///< larger for every restart of the console (wall-clock nanoseconds at start)
  std::uint64_t seq = 0;            ///< counts datagrams of this session
  std::int64_t sender_time_ns = 0;  ///< sender's monotonic clock; not comparable between hosts
  TouchballUpSide left;
  TouchballUpSide right;
};

/// One handle, platform to console.
struct TouchballDownSide {
  Wrench touch_wrench;  ///< to exert on the hand, in the touch frame, at the handle [N, N m]
  ChannelState state = ChannelState::kWaiting;
  std::uint64_t engagement = 0;  ///< counts engagements; a guard grants its starting charge once per new number
  PortLedger ledger;             ///< tank_master's, to this port guard
};

struct TouchballDown {
  std::uint64_t session = 0;
  std::uint64_t seq = 0;
  std::int64_t sender_time_ns = 0;
  std::uint64_t echo_session = 0;  ///< newest up datagram seen (0: none yet)
  std::uint64_t echo_seq = 0;
  std::int64_t echo_time_ns = 0;  ///< its sender_time_ns
  std::int64_t echo_hold_ns = 0;  ///< from its arrival to the sending of this datagram; round trip = now - time - hold
  TouchballDownSide left;
  TouchballDownSide right;
};

/// First message, answer and confirmation of the handshake that begins an authenticated session.
struct TouchballHandshake : Handshake {};

inline constexpr std::uint16_t kTouchballVersion = 1;
inline constexpr std::size_t kTouchballUpSize = 580;
inline constexpr std::size_t kTouchballDownSize = 260;
inline constexpr std::size_t kTouchballHandshakeSize = kHandshakeSize;
inline constexpr std::size_t kTouchballTagSize = kPacketTagSize;
inline constexpr std::size_t kTouchballTrailerSize = kPacketTrailerSize;

using TouchballUpBytes = std::array<std::uint8_t, kTouchballUpSize>;
using TouchballDownBytes = std::array<std::uint8_t, kTouchballDownSize>;
using TouchballHandshakeBytes = std::array<std::uint8_t, kTouchballHandshakeSize>;

/// Encodes; on a fault `bytes` are unspecified and must not be sent. No allocation. With kTag the datagram is whole
/// only after `seal`.
PacketFault encode(const TouchballUp& packet, TouchballUpBytes& bytes,
                   Authentication authentication = Authentication::kNone) noexcept;
PacketFault encode(const TouchballDown& packet, TouchballDownBytes& bytes,
                   Authentication authentication = Authentication::kNone) noexcept;
void encode(const TouchballHandshake& packet, TouchballHandshakeBytes& bytes) noexcept;

/// Decodes strictly; on a fault `packet` stays as it was. No allocation. The tag is not checked here: with kTag the
/// caller has compared it with the one of all bytes before it, and this comes after.
PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballUp& packet,
                   Authentication authentication = Authentication::kNone) noexcept;
PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballDown& packet,
                   Authentication authentication = Authentication::kNone) noexcept;
PacketFault decode(const std::uint8_t* data, std::size_t size, TouchballHandshake& packet) noexcept;

/// The same, throwing ProtocolError with the fault's text.
TouchballUpBytes encode(const TouchballUp& packet, Authentication authentication = Authentication::kNone);
TouchballDownBytes encode(const TouchballDown& packet, Authentication authentication = Authentication::kNone);
TouchballUp decode_up(const std::uint8_t* data, std::size_t size,
                      Authentication authentication = Authentication::kNone);
TouchballDown decode_down(const std::uint8_t* data, std::size_t size,
                          Authentication authentication = Authentication::kNone);
TouchballHandshake decode_handshake(const std::uint8_t* data, std::size_t size);

}  // namespace saras
