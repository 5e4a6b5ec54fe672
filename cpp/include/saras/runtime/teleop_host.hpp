// The real-time host: socket, pipeline and flight recorder in one loop; all else comes and goes by mailboxes.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "saras/pipeline/pipeline.hpp"
#include "saras/runtime/console_socket.hpp"
#include "saras/runtime/flight_recorder.hpp"
#include "saras/runtime/periodic_loop.hpp"

namespace saras {

struct HostConfig {
  LoopConfig loop;
  ConsoleSocketConfig console;
  PipelineConfig pipeline;
  Seconds silent_period_s = 0.01;  ///< while no console is heard: a step, and a datagram down, this often
  Seconds record_s = 60.0;         ///< length of the flight recorder at one step a period; 0: none
  void validate() const;           ///< throws ConfigError
};

/// What one step did, for those who observe.
struct HostSnapshot {
  FlightTick tick;
  bool has_up = false;
  TouchballUp up;  ///< the newest datagram
  int tools = 0;
  ProximityMonitorOutput distances;           ///< of the pipeline's own monitor
  std::array<SceneTool, kMaxTools> capsules;  ///< and where it took them
  bool held = false;                          ///< the loop was too late: a side stands until its next engagement
};

struct HostStatistics {
  LoopStatistics loop;
  std::uint64_t steps = 0;         ///< of the pipeline
  std::uint64_t silent_steps = 0;  ///< of those, without a datagram
  HistogramSnapshot reply;         ///< from a datagram's arrival in the kernel to the sending of the force
  HistogramSnapshot handed;        ///< from the same to the set-points in their mailbox
  std::uint64_t left_out = 0;      ///< steps that the flight recorder left out
};

/// start() to stop(). The writers of one kind of input take turns by the host's own locks, which the loop never takes.
class TeleopHost {
 public:
  explicit TeleopHost(HostConfig config);
  ~TeleopHost();
  TeleopHost(const TeleopHost&) = delete;
  TeleopHost& operator=(const TeleopHost&) = delete;

  void start();
  void stop() noexcept;
  bool running() const noexcept { return loop_->running(); }
  const PeriodicLoop& loop() const noexcept { return *loop_; }
  ConsoleSocket& console() noexcept { return console_; }
  const HostConfig& config() const noexcept { return config_; }

  // ---- inputs, from any thread; ages run from now on

  void set_arm_pose(int side, const Pose& base_T_tip, std::int64_t stamp_ns);
  void set_arm_wrench(int side, const Wrench& exerted);
  void set_arm_rcm(int side, const Vector3& rcm);
  void set_supervisor(int side, ChannelState state, std::uint64_t engagement, bool clutch);
  void set_nearness(int side, const NearnessInput& nearness);
  void set_scene(const SceneInput& scene);
  /// Holds until the next one.
  void set_fixtures(int side, const csa::FixtureWord& word);

  // ---- outputs

  /// Waits for a step that this call has not seen; false after the timeout. One thread at a time.
  bool wait(Seconds timeout_s);
  /// Copy of the newest step that wait() saw.
  HostSnapshot snapshot() const;
  HostStatistics statistics() const noexcept;
  /// Writes the flight record; returns the number of steps. Blocks the caller, not the loop. Throws Error.
  std::uint64_t write_record(const std::string& path, const std::string& reason);

 private:
  struct ArmSample {
    Pose base_T_tip;
    std::int64_t stamp_ns = 0, received_ns = 0;
    bool has_pose = false, has_rcm = false, has_wrench = false;
    Vector3 rcm = Vector3::Zero();
    Wrench wrench;
    std::int64_t wrench_received_ns = 0;
    std::uint64_t poses = 0;  ///< counts the poses, so that a new wrench is not taken for a new pose
  };
  struct WordSample {
    SupervisorWord word;
    std::int64_t received_ns = 0;
  };
  struct NearnessSample {
    NearnessInput nearness;
    std::int64_t received_ns = 0;
  };
  struct SceneSample {
    SceneInput scene;
    std::int64_t received_ns = 0;
  };
  template <typename T>
  struct Inbox {
    std::mutex mutex;  ///< of the writers
    T newest;
    Mailbox<T> box;
    template <typename Change>
    void change(Change change) {
      const std::lock_guard<std::mutex> lock(mutex);
      change(newest);
      box.write(newest);
    }
  };
  struct Side {
    Inbox<ArmSample> arm;
    Inbox<WordSample> word;
    Inbox<NearnessSample> nearness;
    Inbox<csa::FixtureWord> fixtures;
    std::uint64_t seen_poses = 0;  ///< of the loop
    std::int64_t seen_stamp_ns = 0;
    std::int64_t handle_ns = 0;
  };

  void step(const Wake& wake) noexcept;
  void gather(std::int64_t now_ns, bool news) noexcept;
  void gather_side(std::size_t side, std::int64_t now_ns, bool news) noexcept;
  void answer(const PipelineOutput& output, std::int64_t now_ns) noexcept;
  void tell(const FlightTick& tick) noexcept;

  HostConfig config_;
  Pipeline pipeline_;
  ConsoleSocket console_;
  std::unique_ptr<FlightRecorder> recorder_;
  std::array<Side, kSides> sides_;
  Inbox<SceneSample> scene_;
  PipelineInput input_;
  FlightTick tick_;
  std::int64_t last_step_ns_ = 0;
  bool hold_ = false, overrun_ = false, was_silent_ = false;
  Mailbox<HostSnapshot> told_;
  int told_event_ = -1;
  mutable std::mutex reader_;
  std::mutex record_mutex_;
  std::atomic<std::uint64_t> steps_{0}, silent_steps_{0};
  Histogram reply_, handed_;
  std::unique_ptr<PeriodicLoop> loop_;
};

}  // namespace saras
