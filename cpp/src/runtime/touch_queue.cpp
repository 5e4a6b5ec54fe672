#include "saras/runtime/touch_queue.hpp"

#include <algorithm>
#include <chrono>

namespace saras {

bool TouchQueue::push(const StampedTouch& sample) {
  bool fitted = true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (size_ == ring_.size()) {
      first_ = (first_ + 1) % ring_.size();
      --size_;
      ++dropped_;
      fitted = false;
    }
    ring_[(first_ + size_) % ring_.size()] = sample;
    ++size_;
  }
  filled_.notify_one();
  return fitted;
}

void TouchQueue::take(std::vector<StampedTouch>& samples) {
  samples.clear();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (; size_ > 0; --size_) {
      samples.push_back(ring_[first_]);
      first_ = (first_ + 1) % ring_.size();
    }
  }
  const auto earlier = [](const StampedTouch& a, const StampedTouch& b) { return a.stamp_s < b.stamp_s; };
  std::stable_sort(samples.begin(), samples.end(), earlier);
}

void TouchQueue::wait(double timeout_s) {
  std::unique_lock<std::mutex> lock(mutex_);
  filled_.wait_for(lock, std::chrono::duration<double>(timeout_s), [this] { return size_ > 0 || woken_; });
  woken_ = false;
}

void TouchQueue::wake() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    woken_ = true;
  }
  filled_.notify_all();
}

void TouchQueue::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  size_ = 0;
}

int TouchQueue::waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(size_);
}

std::uint64_t TouchQueue::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

}  // namespace saras
