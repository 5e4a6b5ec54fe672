#include "saras/net/replay_window.hpp"

namespace saras {

ReplayVerdict ReplayWindow::accept(std::uint64_t seq) noexcept {
  if (received_ == 0) {
    newest_ = seq;
    received_ = 1;
    return ReplayVerdict::kNew;
  }
  if (seq > newest_) {
    const std::uint64_t ahead = seq - newest_;
    if (ahead > kMostAhead) {
      return ReplayVerdict::kFarAhead;
    }
    received_ = (ahead < kSize ? received_ << ahead : 0) | 1;
    newest_ = seq;
    return ReplayVerdict::kNew;
  }
  const std::uint64_t behind = newest_ - seq;
  if (behind >= kSize) {
    return ReplayVerdict::kTooOld;
  }
  const std::uint64_t bit = std::uint64_t{1} << behind;
  if (received_ & bit) {
    return ReplayVerdict::kReplayed;
  }
  received_ |= bit;
  return ReplayVerdict::kNew;
}

}  // namespace saras
