// The newest value of several writers for several readers, under a lock that is always taken.
#pragma once

#include <mutex>
#include <utility>

namespace saras {

/// For values too large or too rarely read for a Mailbox. Nobody tries the lock and goes on without it: a reader that
/// does loses updates and shows something that nobody said. The lock is held for the copy alone.
template <typename T>
class Snapshot {
 public:
  Snapshot() = default;
  explicit Snapshot(T value) : value_(std::move(value)) {}

  void write(const T& value) {
    const std::lock_guard<std::mutex> lock(mutex_);
    value_ = value;
  }
  /// change(T&) under the lock: for writers that each know a part.
  template <typename Change>
  void change(Change&& change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::forward<Change>(change)(value_);
  }
  T read() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  T value_{};
};

}  // namespace saras
