#include "saras/pipeline/tank_exchange.hpp"

#include <algorithm>

#include "saras/spatial/validate.hpp"

namespace saras {

TankNode::TankNode(EnergyTankConfig config, int peers, std::uint64_t session)
    : peers_((validate::in_range("peers", peers, 1, kMaxTankPeers), peers)), tank_(config, kSides) {
  tank_.reset();
  for (TankPeerState& peer : peer_) {
    peer.sent.session = session;
  }
}

void TankNode::grant_charge() noexcept {
  tank_.grant(std::max(0.0, tank_.config().initial_J - tank_.state().energy_J));
}

void TankNode::receive(int peer, const LedgerMessage& message, bool requesting, bool has_room) noexcept {
  TankPeerState& state = peer_[static_cast<std::size_t>(peer)];
  LedgerReceiver receiver;
  receiver.reset(state.received);
  state.credit_J += receiver.credit(message);
  state.received = receiver.state();
  state.requesting = requesting;
  state.has_room = has_room;
}

void TankNode::forget_wishes(int peer) noexcept {
  peer_[static_cast<std::size_t>(peer)].requesting = false;
  peer_[static_cast<std::size_t>(peer)].has_room = false;
}

EnergyTankOutput TankNode::step(EnergyTankInput& input, Seconds dt) noexcept {
  int asking = 0;
  int roomy = 0;
  input.received_J = 0.0;
  for (int i = 0; i < peers_; ++i) {
    TankPeerState& peer = peer_[static_cast<std::size_t>(i)];
    input.received_J += peer.credit_J;
    peer.credit_J = 0.0;
    asking += peer.requesting ? 1 : 0;
    roomy += peer.has_room ? 1 : 0;
  }
  input.requesting_peers = asking;
  input.peer_has_room = roomy > 0;
  EnergyTankOutput out = tank_.step(input, dt);
  const double answer_J = out.sent_J - out.sent_overflow_J;
  for (int i = 0; i < peers_; ++i) {
    TankPeerState& peer = peer_[static_cast<std::size_t>(i)];
    double share_J = peer.requesting ? answer_J / asking : 0.0;
    share_J += peer.has_room ? out.sent_overflow_J / roomy : 0.0;
    LedgerSender sender(peer.sent.session);
    sender.reset(peer.sent);
    sender.send(share_J);
    peer.sent = sender.last();
  }
  return out;
}

LedgerMessage TankNode::next_message(int peer) noexcept {
  LedgerMessage& message = peer_[static_cast<std::size_t>(peer)].sent;
  ++message.seq;
  return message;
}

TankOutput TankNode::output(const EnergyTankOutput& out) const noexcept {
  const EnergyTankState& state = tank_.state();
  TankOutput result;
  result.energy_J = out.energy_J;
  result.work_out_J = state.work_out_J;
  result.received_J = state.received_J;
  result.sent_J = state.sent_J;
  result.vented_J = state.vented_J;
  result.granted_J = state.granted_J;
  result.reduction = out.reduction;
  result.scale = out.scale;
  result.damping = out.damping;
  result.requesting = out.requesting;
  result.has_room = out.has_room;
  result.status = out.status;
  result.to_peer = peer_[static_cast<std::size_t>(peers_ - 1)].sent;
  return result;
}

TankNodeState TankNode::state() const noexcept { return {tank_.state(), peer_}; }

void TankNode::reset(const TankNodeState& state) {
  tank_.reset(state.tank);
  peer_ = state.peers;
}

}  // namespace saras
