// An impaired datagram link: delay, jitter, loss, bursts, duplicates, reordering. Deterministic for a seed.
#pragma once

#include <cstdint>
#include <vector>

#include "saras/sim/random.hpp"
#include "saras/spatial/types.hpp"

namespace saras {

struct ChannelConfig {
  Seconds delay_s = 0.0;       ///< of every datagram, one way [s]
  Seconds jitter_s = 0.0;      ///< uniform addition in [0, jitter_s]; keeps the order, as a queue does [s]
  double loss = 0.0;           ///< probability that a datagram is lost [-]
  double duplicate = 0.0;      ///< probability that a datagram comes twice [-]
  double reorder = 0.0;        ///< probability that a datagram is overtaken [-]
  Seconds reorder_s = 0.02;    ///< by how much an overtaken datagram or a duplicate comes late [s]
  double burst_rate_hz = 0.0;  ///< how often a loss burst begins [1/s]
  Seconds burst_s = 0.1;       ///< how long a loss burst lasts [s]
  std::uint64_t seed = 1;
  std::uint32_t capacity = 65536;  ///< datagrams in flight; more are dropped and counted
  void validate() const;           ///< throws ConfigError
};

struct ChannelCounters {
  std::uint64_t sent = 0;  ///< datagrams given to the channel
  std::uint64_t lost = 0;  ///< lost at random, in a burst or in a blackout
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;
  std::uint64_t overflowed = 0;  ///< dropped because capacity was reached
  std::uint64_t delivered = 0;   ///< copies that came out
};

/// Carries numbers (ids); who has payloads keeps them by id. Times are arguments, on any monotonic clock [s].
/// All memory is taken at construction.
class Channel {
 public:
  explicit Channel(ChannelConfig config);

  /// Puts one datagram on the link at the time now.
  void send(std::uint64_t id, Seconds now) noexcept;
  /// Takes the next datagram that is due at the time now. False: none.
  bool receive(Seconds now, std::uint64_t& id) noexcept;
  /// When the next datagram comes out [s]; infinity when none is in flight.
  Seconds next_arrival() const noexcept;
  /// Loses all that is sent before the given time (a link that is cut).
  void blackout_until(Seconds time) noexcept { blackout_until_ = time; }
  /// Delivers nothing before the given time, then all at once (a stalled queue).
  void hold_until(Seconds time) noexcept { hold_until_ = time; }

  std::size_t in_flight() const { return flight_.size(); }
  const ChannelCounters& counters() const { return counters_; }
  const ChannelConfig& config() const { return config_; }

 private:
  struct Datagram {
    Seconds arrival;
    std::uint64_t order;  ///< of sending: equal arrivals come out in this order
    std::uint64_t id;
  };
  static bool comes_later(const Datagram& a, const Datagram& b) noexcept;
  void schedule(std::uint64_t id, Seconds arrival) noexcept;

  ChannelConfig config_;
  ChannelCounters counters_;
  Random random_;
  std::vector<Datagram> flight_;  // a heap, earliest arrival on top
  std::uint64_t order_ = 0;
  Seconds last_send_;
  Seconds last_arrival_;
  Seconds burst_until_;
  Seconds blackout_until_;
  Seconds hold_until_;
};

}  // namespace saras
