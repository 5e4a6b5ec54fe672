// How joules travel between tanks over a link that loses, doubles and reorders: as cumulative sums.
//
// The sender publishes the total it has sent in its session; the receiver credits what the newest total adds to
// the last one it saw. Lost messages lose nothing, doubled ones add nothing, and energy in flight is never
// negative. The first message of a session is the baseline: a receiver that starts late cannot create energy.
#pragma once

#include <cstdint>

namespace saras {

struct LedgerMessage {
  std::uint64_t session = 0;  ///< larger for every restart of the sender
  std::uint64_t seq = 0;      ///< counts messages of the session, from 1
  double sent_J = 0.0;        ///< cumulative energy sent in this session [J]
};

class LedgerSender {
 public:
  explicit LedgerSender(std::uint64_t session) { message_.session = session; }

  /// Adds energy that left the tank. Negative or non-finite amounts are ignored: nothing left.
  void send(double energy_J) noexcept;
  /// The message to put on the wire now; each call counts up seq.
  LedgerMessage next() noexcept;
  const LedgerMessage& last() const { return message_; }
  /// Continues from a recorded sum.
  void reset(const LedgerMessage& message) { message_ = message; }

 private:
  LedgerMessage message_;
};

struct LedgerReceiverState {
  bool has_baseline = false;
  std::uint64_t session = 0;
  std::uint64_t seq = 0;
  double seen_J = 0.0;        ///< newest cumulative total of the session [J]
  double credited_J = 0.0;    ///< all that was credited, over all sessions [J]
  std::uint64_t ignored = 0;  ///< messages of older sessions, out of order, doubled, or with unusable totals
};

class LedgerReceiver {
 public:
  /// Joules to credit to the tank: max(0, sent_J - last seen). 0 for the first message of a session, for older
  /// sessions, repeated or earlier seq, and non-finite or negative totals (all but the first are counted).
  double credit(const LedgerMessage& message) noexcept;
  void reset(const LedgerReceiverState& state = {}) { state_ = state; }
  const LedgerReceiverState& state() const { return state_; }

 private:
  LedgerReceiverState state_;
};

}  // namespace saras
