// Newest-wins filter of a datagram stream, and what it saw.
#pragma once

#include <cstdint>

namespace saras {

/// Counters of one stream since construction [datagrams].
struct SequenceCounts {
  std::uint64_t accepted = 0;
  std::uint64_t duplicate = 0;     ///< a number that was already received (within the last 64)
  std::uint64_t out_of_order = 0;  ///< older than the newest, not known as received
  std::uint64_t old_session = 0;   ///< from an earlier run of the sender
  std::uint64_t gaps = 0;          ///< numbers skipped by an accepted one; a late one stays counted here
  std::uint64_t sessions = 0;      ///< sessions seen
};

/// Accepts strictly newer (session, seq) only: nothing is ever delivered backwards or twice. A restarted sender
/// has a larger session and is accepted at once; its predecessor's datagrams are refused from then on.
class SequenceFilter {
 public:
  bool accept(std::uint64_t session, std::uint64_t seq) noexcept;
  /// The next datagram begins a session whatever its number, because a handshake has proved that it is a new one:
  /// a sender whose wall clock was set back is heard again. The counts go on.
  void restart() noexcept { is_new_ = true; }
  const SequenceCounts& counts() const noexcept { return counts_; }
  bool has_seen() const noexcept { return counts_.sessions > 0; }
  std::uint64_t session() const noexcept { return session_; }
  std::uint64_t seq() const noexcept { return seq_; }

 private:
  std::uint64_t session_ = 0;
  std::uint64_t seq_ = 0;
  std::uint64_t received_ = 0;  ///< bit i: seq_ - i was received
  bool is_new_ = true;          ///< no datagram since construction or restart
  SequenceCounts counts_;
};

}  // namespace saras
