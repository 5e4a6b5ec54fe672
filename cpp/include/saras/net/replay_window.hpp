// Refuses datagrams that were received before, for a stream whose datagrams are authenticated.
#pragma once

#include <cstdint>

namespace saras {

enum class ReplayVerdict : std::uint8_t {
  kNew = 0,
  kReplayed,  ///< received before
  kTooOld,    ///< behind the window: whether it was received before is no longer known
  kFarAhead,  ///< further ahead than a sender gets
};

/// Window of the newest 64 sequence numbers of one session (RFC 6479; with a window of one word its ring of words
/// is a shift). Call `accept` for authenticated datagrams only: what is forged must not move the window.
class ReplayWindow {
 public:
  static constexpr std::uint64_t kSize = 64;
  /// Three hours of datagrams at 100 Hz: a sender that was unheard for longer begins a new session.
  static constexpr std::uint64_t kMostAhead = std::uint64_t{1} << 20;

  /// Notes `seq` as received when it is new; otherwise the window stays as it was. The first number of a session
  /// may be any.
  ReplayVerdict accept(std::uint64_t seq) noexcept;
  /// For a new session (new keys).
  void reset() noexcept { received_ = 0; }
  /// Newest number received; 0 before the first.
  std::uint64_t newest() const noexcept { return received_ == 0 ? 0 : newest_; }

 private:
  std::uint64_t newest_ = 0;
  std::uint64_t received_ = 0;  ///< bit i: newest_ - i was received; 0 before the first
};

}  // namespace saras
