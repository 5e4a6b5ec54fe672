// The last minute of a pipeline's inputs, outputs and states, always there, written out when something happened.
//
// A ring of chunks. The loop fills one chunk after the other; another thread writes the finished ones into a file.
// Neither waits: a chunk that is being written is not overwritten, its time is left out and counted instead.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "saras/pipeline/pipeline.hpp"

namespace saras {

/// One step. Times are for reading; the replay takes dt_s and input.
struct FlightTick {
  std::uint64_t index = 0;    ///< counts steps since the start of the loop
  std::int64_t now_ns = 0;    ///< monotonic clock
  std::int64_t stamp_ns = 0;  ///< wall clock of the newest datagram [ns since the epoch]
  Seconds dt_s = 0.0;
  PipelineInput input;
  PipelineOutput output;
};

class FlightRecorder {
 public:
  /// Holds chunks * ticks_per_chunk steps; allocated and touched here. chunks >= 3.
  FlightRecorder(std::size_t chunks, std::size_t ticks_per_chunk);

  /// Loop: where to put the step that comes now, nullptr when it has to be left out. Notes the state before it where
  /// a chunk begins. Followed by commit() when the tick is whole.
  FlightTick* begin(const Pipeline& before) noexcept;
  void commit() noexcept;

  /// Any thread: the loop closes its chunk at its next step, so that write() finds the newest.
  void request_close() noexcept { close_requested_.store(true, std::memory_order_release); }
  bool close_pending() const noexcept { return close_requested_.load(std::memory_order_acquire); }
  /// Only while no loop runs.
  void close() noexcept;

  /// One other thread: writes all finished chunks, oldest first. Returns the number of steps. Throws Error.
  std::uint64_t write(const std::string& path, const PipelineConfig& config, const std::string& reason);

  /// Steps that were left out because their chunk was being written.
  std::uint64_t left_out() const noexcept { return left_out_.load(std::memory_order_relaxed); }
  std::size_t bytes() const noexcept;

 private:
  enum Owner : int { kNobody = 0, kLoop, kWriter };
  struct Chunk {
    std::atomic<int> owner{kNobody};
    std::size_t count = 0;
    PipelineState state;  ///< before the first tick
    std::vector<FlightTick> ticks;
  };

  bool enter_next() noexcept;

  std::vector<std::unique_ptr<Chunk>> chunks_;
  std::size_t current_ = 0;
  bool holds_chunk_ = false;
  std::atomic<std::size_t> newest_{0};  ///< chunk that the loop entered last
  std::atomic<bool> close_requested_{false};
  std::atomic<std::uint64_t> left_out_{0};
};

/// A flight record read back.
struct FlightRecord {
  std::string reason;
  PipelineConfig config;
  struct Chunk {
    PipelineState state;
    std::vector<FlightTick> ticks;
  };
  std::vector<Chunk> chunks;
};

/// Throws ProtocolError for a file that is none, or of another version; Error when it cannot be read.
FlightRecord read_flight(const std::string& path);

struct FlightReplay {
  std::uint64_t ticks = 0;
  std::uint64_t exact = 0;             ///< outputs equal to the bit
  std::uint64_t states = 0;            ///< states that follow without a gap on the chunk before
  std::uint64_t states_exact = 0;      ///< and equal the one that the replay reached
  std::int64_t first_difference = -1;  ///< index of the first step whose output differs
};

/// Steps a pipeline through the record: from the state of the first chunk, anew where steps were left out.
FlightReplay replay_flight(const FlightRecord& record);

}  // namespace saras
