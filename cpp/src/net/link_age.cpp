#include "saras/net/link_age.hpp"

#include <algorithm>
#include <limits>

#include "saras/spatial/validate.hpp"

namespace saras {

void LinkAgeConfig::validate() const { validate::in_range("rise_rate", rise_rate, 0.0, 0.1); }

LinkAge::LinkAge(LinkAgeConfig config) : config_(config) { config_.validate(); }

double LinkAge::received(std::int64_t send_ns, std::int64_t receive_ns) noexcept {
  // Offsets are kept relative to the first one: two unrelated clocks may differ by more than a double resolves.
  // Unsigned, because a forged time may be anything.
  const auto offset_ns =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(receive_ns) - static_cast<std::uint64_t>(send_ns));
  if (!has_received_) {
    has_received_ = true;
    first_offset_ns_ = offset_ns;
    newest_send_ns_ = send_ns;
    last_receive_ns_ = receive_ns;
    return 0.0;
  }
  const auto relative_ns = static_cast<double>(
      static_cast<std::int64_t>(static_cast<std::uint64_t>(offset_ns) - static_cast<std::uint64_t>(first_offset_ns_)));
  const double elapsed_ns = std::max(0.0, static_cast<double>(receive_ns - last_receive_ns_));
  least_offset_ns_ = std::min(least_offset_ns_ + config_.rise_rate * elapsed_ns, relative_ns);
  newest_send_ns_ = std::max(newest_send_ns_, send_ns);
  last_receive_ns_ = std::max(last_receive_ns_, receive_ns);
  return (relative_ns - least_offset_ns_) * 1e-9;
}

double LinkAge::age_s(std::int64_t now_ns) const noexcept {
  if (!has_received_) {
    return std::numeric_limits<double>::infinity();
  }
  const auto relative_ns = static_cast<double>(static_cast<std::int64_t>(static_cast<std::uint64_t>(now_ns) -
                                                                         static_cast<std::uint64_t>(newest_send_ns_) -
                                                                         static_cast<std::uint64_t>(first_offset_ns_)));
  return std::max(0.0, relative_ns - least_offset_ns_) * 1e-9;
}

}  // namespace saras
