// The newest value of one writer for one reader, without locks: neither ever waits for the other.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace saras {

/// A triple buffer. The writer fills its own slot and swaps it with the middle one; the reader swaps the middle one
/// with its own when that is newer. A value is always whole, values never go backwards, and those that nobody read in
/// time are overwritten. Several writers (or readers) must take turns under a lock of their own.
template <typename T>
class Mailbox {
 public:
  Mailbox() = default;
  explicit Mailbox(const T& value) { slots_.fill({value}); }
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  /// Writer: where the next value is built; holds an older one. Visible after publish().
  T& draft() noexcept { return slots_[write_].value; }
  void publish() noexcept {
    const std::uint32_t before = middle_.exchange(write_ | kNew, std::memory_order_acq_rel);
    write_ = before & kIndex;
  }
  void write(const T& value) noexcept {
    draft() = value;
    publish();
  }

  /// Reader: takes the newest value if there is one; true when it is new.
  bool update() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kNew) == 0) {
      return false;
    }
    read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// Reader: the value taken last.
  const T& value() const noexcept { return slots_[read_].value; }

 private:
  static constexpr std::uint32_t kIndex = 3;
  static constexpr std::uint32_t kNew = 4;
  // A cache line of its own for each end: they are written at a kilohertz by different cores.
  struct alignas(64) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_;
  alignas(64) std::uint32_t write_ = 0;
  alignas(64) std::uint32_t read_ = 1;
  alignas(64) std::atomic<std::uint32_t> middle_{2};
};

}  // namespace saras
