// Age of received information when the clocks of sender and receiver don't compare.
#pragma once

#include <cstdint>

namespace saras {

struct LinkAgeConfig {
  /// How fast the estimate of the least delay rises [s/s]. It follows clock drift (1e-4) and a longer route
  /// (20 ms more are forgotten in 4 s); a queue that grows more slowly than this does not show as age.
  double rise_rate = 5e-3;
  void validate() const;  ///< throws ConfigError
};

/// age = (receive - send) - running minimum of (receive - send). A constant delay is not age: the minimum takes
/// in both the clocks' offset and the route's least delay.
class LinkAge {
 public:
  explicit LinkAge(LinkAgeConfig config = {});
  /// A packet sent at send_ns (sender's clock) arrived at receive_ns (own monotonic clock).
  /// Returns its age on arrival [s], >= 0.
  double received(std::int64_t send_ns, std::int64_t receive_ns) noexcept;
  /// Age [s] at now_ns (own monotonic clock) of the newest information; infinite before the first packet.
  double age_s(std::int64_t now_ns) const noexcept;
  /// Forget the minimum: a new session may have another clock.
  void reset() noexcept { *this = LinkAge(config_); }

 private:
  LinkAgeConfig config_;
  bool has_received_ = false;
  std::int64_t newest_send_ns_ = 0;
  std::int64_t last_receive_ns_ = 0;
  double least_offset_ns_ = 0.0;  ///< of (receive - send), relative to first_offset_ns_
  std::int64_t first_offset_ns_ = 0;
};

}  // namespace saras
