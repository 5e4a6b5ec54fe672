// One GStreamer pipeline in a thread: pictures out, errors by name, and another try. Knows no ROS.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "picture.hpp"

namespace saras_ros1 {

struct GrabberConfig {
  std::string name;        ///< for messages
  std::string source;      ///< of source_text
  bool loop = false;       ///< a source that came to its end begins again at once
  double latency_s = 0.0;  ///< what the device itself takes, taken off the time of each picture
  double silence_s = 1.0;  ///< without a picture for so long the pipeline is started anew
  double retry_s = 2.0;    ///< between one try and the next
};

/// Calls back from its own thread until stopped. States: "OK", or "LOST: name: why"; said when they change.
class Grabber {
 public:
  using OnPicture = std::function<void(const Picture&)>;
  using OnState = std::function<void(const std::string&)>;

  Grabber(GrabberConfig config, OnPicture on_picture, OnState on_state);
  ~Grabber() { stop(); }
  Grabber(const Grabber&) = delete;
  Grabber& operator=(const Grabber&) = delete;

  void start();
  /// Ends the pipeline and its thread; no call comes after it. Not from a callback.
  void stop();

  const std::string& name() const { return config_.name; }
  std::string state() const;
  std::uint64_t pictures() const { return pictures_; }
  std::uint64_t failures() const { return failures_; }

 private:
  void run();
  std::string play();
  void say(const std::string& state);
  void wait_to_retry();

  GrabberConfig config_;
  OnPicture on_picture_;
  OnState on_state_;
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> pictures_{0}, failures_{0};
  mutable std::mutex mutex_;
  std::condition_variable ending_;
  std::string state_ = "STARTING";
  std::thread thread_;
};

}  // namespace saras_ros1
