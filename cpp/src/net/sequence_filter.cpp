#include "saras/net/sequence_filter.hpp"

namespace saras {

bool SequenceFilter::accept(std::uint64_t session, std::uint64_t seq) noexcept {
  if (!is_new_ && session < session_) {
    ++counts_.old_session;
    return false;
  }
  if (is_new_ || session > session_) {
    is_new_ = false;
    session_ = session;
    seq_ = seq;
    received_ = 1;
    ++counts_.sessions;
    ++counts_.accepted;
    return true;
  }
  if (seq <= seq_) {
    const std::uint64_t behind = seq_ - seq;
    const std::uint64_t bit = behind < 64 ? std::uint64_t{1} << behind : 0;
    if (received_ & bit) {
      ++counts_.duplicate;
    } else {
      ++counts_.out_of_order;
      received_ |= bit;
    }
    return false;
  }
  const std::uint64_t ahead = seq - seq_;
  counts_.gaps += ahead - 1;
  received_ = (ahead < 64 ? received_ << ahead : 0) | 1;
  seq_ = seq;
  ++counts_.accepted;
  return true;
}

}  // namespace saras
