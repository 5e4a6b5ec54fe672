// Touch samples on their way to whoever learns them. Bringing one waits for nothing but a copy.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <vector>

#include "saras/spatial/types.hpp"

namespace saras {

/// One sample of the slave's sensor.
struct StampedTouch {
  double stamp_s = 0.0;
  Vector3 position = Vector3::Zero();  ///< of the tip, base frame [m]
  Vector3 force = Vector3::Zero();     ///< that the tool exerts on the tissue, base frame [N]
  Vector3 velocity = Vector3::Zero();  ///< of the tip, base frame [m/s]
};

class TouchQueue {
 public:
  /// room: samples that may wait.
  explicit TouchQueue(int room) : ring_(static_cast<std::size_t>(room)) {}

  /// False: there was no room, the oldest one was dropped for it.
  bool push(const StampedTouch& sample);
  /// All that wait, sorted by their stamps, into `samples`.
  void take(std::vector<StampedTouch>& samples);
  /// Until there is one, or wake() is called; at most timeout_s.
  void wait(double timeout_s);
  void wake();
  void clear();
  int waiting() const;
  std::uint64_t dropped() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::vector<StampedTouch> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
  bool woken_ = false;
};

}  // namespace saras
