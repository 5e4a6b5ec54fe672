// A real stereo endoscope, or recordings of one, through GStreamer. In a nodelet manager its pictures reach the other
// nodelets without a copy.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <nodelet/nodelet.h>

#include <array>
#include <memory>
#include <mutex>

#include "capture_source.hpp"
#include "captured_eye.hpp"
#include "grabber.hpp"
#include "parameters.hpp"

namespace saras_ros1 {

/// Publishes from the grabbers' threads, as pictures come.
class EndoscopeCapture : public nodelet::Nodelet {
 public:
  ~EndoscopeCapture() override;

 private:
  /// A picture of one of two devices that waits for the other's: the copy outlives GStreamer's buffer.
  struct Waiting {
    std::vector<std::uint8_t> bytes;
    Picture picture;
  };
  using EyeRange = std::array<std::size_t, 2>;  // first, and one behind the last

  void onInit() override;
  void start();
  void make_eyes(Parameters& own);
  void make_grabbers(Parameters& own);
  void on_state(EyeRange eyes, const std::string& state);
  void on_both(const Picture& picture);
  void on_one(std::size_t eye, const Picture& picture);
  void release_alone(std::size_t eye);
  void report(const ros::SteadyTimerEvent&);

  Layout layout_ = Layout::kTwoDevices;
  bool swap_ = false;
  std::mutex mutex_;  // grabbers' threads and the report: all below
  std::array<std::unique_ptr<CapturedEye>, 2> eyes_;
  std::optional<saras::StereoPairing> pairing_;
  std::array<Waiting, 2> waiting_;
  std::array<std::int64_t, 2> taken_ns_{};  // of the newest picture of each device
  ros::SteadyTime paired_at_, reported_at_;
  std::uint64_t unpaired_ = 0, reported_shown_ = 0;
  ros::Publisher diagnostics_;
  ros::SteadyTimer reporter_;
  std::vector<std::unique_ptr<Grabber>> grabbers_;  // last: their threads end first
};

}  // namespace saras_ros1
