// A tank with its peers: who asks, who has room, what each was sent.
#pragma once

#include <array>

#include "saras/pipeline/io.hpp"
#include "saras/teleop/energy_ledger.hpp"
#include "saras/teleop/energy_tank.hpp"

namespace saras {

/// Ledgers with one other tank.
struct TankPeerState {
  LedgerMessage sent;
  LedgerReceiverState received;
  double credit_J = 0.0;  ///< credited, not yet in the tank
  bool requesting = false;
  bool has_room = false;
};

/// Port guards left and right, and the other tank.
inline constexpr int kMaxTankPeers = kSides + 1;

struct TankNodeState {
  EnergyTankState tank;
  std::array<TankPeerState, kMaxTankPeers> peers;
};

/// EnergyTank as tank_master or tank_slave runs it: begins at minimum_J; the starting charge comes by grant_charge().
class TankNode {
 public:
  /// peers: 1 … kMaxTankPeers. session: of its ledgers, larger for every restart. Throws ConfigError.
  TankNode(EnergyTankConfig config, int peers, std::uint64_t session);

  /// Tops the tank up to initial_J; counted as granted. Once an engagement.
  void grant_charge() noexcept;
  /// Credits what a peer's ledger adds and notes its wishes.
  void receive(int peer, const LedgerMessage& message, bool requesting, bool has_room) noexcept;
  /// A silent peer asks for nothing and has no room.
  void forget_wishes(int peer) noexcept;
  /// The law with the peers' credits and wishes; its answers go on the ledgers. input: all but those.
  EnergyTankOutput step(EnergyTankInput& input, Seconds dt) noexcept;
  /// The ledger to one peer, with a new number.
  LedgerMessage next_message(int peer) noexcept;
  TankOutput output(const EnergyTankOutput& out) const noexcept;

  TankNodeState state() const noexcept;
  void reset(const TankNodeState& state);
  const EnergyTank& tank() const { return tank_; }

 private:
  int peers_;
  EnergyTank tank_;
  std::array<TankPeerState, kMaxTankPeers> peer_;
};

}  // namespace saras
