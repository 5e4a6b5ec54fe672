// The live map in threads of its own: one learns every sample, one asks what is known at the mesh's vertices. Whoever
// brings samples, lays the mesh anew or looks at the map waits for no more than a copy.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "saras/model/stiffness_gp.hpp"
#include "saras/model/surface_mesh.hpp"
#include "saras/model/vertex_map.hpp"
#include "saras/runtime/histogram.hpp"
#include "saras/runtime/touch_queue.hpp"

namespace saras {

struct ModelHostConfig {
  StiffnessGpConfig law;
  VertexMapConfig vertices;
  double free_m = 5e-3;      ///< so far outside the mesh nothing is touched: the sensor's offset is taken [m]
  double near_m = 5e-3;      ///< vertices this near to the tip are asked at touched_hz [m]
  double touched_hz = 30.0;  ///< [1/s]
  double map_hz = 1.0;       ///< a vertex that is out of date waits for no more than its inverse [1/s]
  int room = 4000;           ///< samples that may wait to be learned; older ones are dropped and counted
  void validate() const;     ///< throws ConfigError
};

/// What is known now. generation: how often everything was forgotten.
struct ModelView {
  IndexedMeshPointer laid;
  std::vector<VertexEstimate> estimates;
  std::uint64_t generation = 0;
};

/// Vertices near the tip that were asked since somebody took them last.
struct TouchedVertices {
  IndexedMeshPointer laid;
  std::vector<std::int32_t> vertices;
  std::vector<VertexEstimate> estimates;
};

struct ModelHostStatistics {
  static constexpr std::size_t kVerdicts = 8;
  std::array<std::uint64_t, kVerdicts> verdicts{};  ///< samples since the last reset, by SampleVerdict
  std::uint64_t dropped = 0;                        ///< samples that found no room
  int waiting = 0;                                  ///< samples
  int places = 0;
  Vector3 bias_N = Vector3::Zero();
  double disagreement = 0.0;    ///< mean deviation of the samples from the map [sigma]
  std::uint64_t refreshes = 0;  ///< of the vertices near the tip
  std::uint64_t asked = 0;      ///< vertices
  int stale = 0;                ///< patches out of date
  HistogramSnapshot learning;   ///< of one sample
  HistogramSnapshot refreshing;
  HistogramSnapshot waits;  ///< of each refresh, the longest time that one of its vertices had been out of date
};

/// Without start() nothing runs by itself; learn_waiting() and refresh() then do the threads' work in the caller's.
class ModelHost {
 public:
  explicit ModelHost(IndexedMeshPointer prior, ModelHostConfig config = {});  ///< throws ConfigError
  ~ModelHost();
  ModelHost(const ModelHost&) = delete;
  ModelHost& operator=(const ModelHost&) = delete;

  void start();                 ///< throws Error when it runs already
  void stop() noexcept;         ///< after what the threads are at; safe to repeat
  std::string failure() const;  ///< why a thread ended by itself; empty when none did

  /// False: there was no room, the oldest waiting sample was dropped.
  bool push(const StampedTouch& sample) { return queue_.push(sample); }
  void learn_waiting();
  /// Asks what is out of date: all near the newest samples, and the whole map's share of one refresh, or all of it.
  void refresh(bool all = true);

  ModelView view() const;
  TouchedVertices take_touched();
  /// Until there is something to take, at most timeout_s. False: there is nothing.
  bool wait_touched(double timeout_s);
  /// A copy of what was learned, and of what it was learned with; learning waits as long as that takes.
  HashGrid grid(LocalModelConfig& local, std::uint64_t& generation) const;
  ModelHostStatistics statistics() const;

  /// The mesh lies otherwise from now on. False, and nothing changed: everything was forgotten since that generation.
  /// Throws ModelError for another number of vertices.
  bool lay(IndexedMeshPointer mesh, std::uint64_t generation);
  /// Takes over hyper-parameters learned elsewhere; false as lay(). Throws ConfigError.
  bool adopt(const GpHyperparameters& hyperparameters, std::uint64_t generation);
  /// Forgets what was learned, and begins with this mesh.
  void reset(IndexedMeshPointer prior);
  const ModelHostConfig& config() const { return config_; }

 private:
  /// What the learner tells the refresher.
  struct News {
    std::vector<Vector3> learned_at;
    std::vector<Vector3> tips;
    bool everywhere = false;
    bool forgotten_here = false;
  };
  void learn(const StampedTouch& sample, const IndexedMesh& laid);
  void remember(const Vector3& position, SampleVerdict verdict, std::uint64_t evicted);
  void begin_with(IndexedMeshPointer prior);
  void commit(const VertexMap::Refreshed& refreshed, std::uint64_t generation);
  template <typename Turn>
  void run(const char* name, Turn&& turn) noexcept;

  ModelHostConfig config_;
  TouchQueue queue_;

  mutable std::mutex law_mutex_;  ///< before view_mutex_, where both are needed
  StiffnessGp law_;
  std::vector<StampedTouch> batch_;
  News news_;
  double last_stamp_s_ = 0.0;
  bool has_stamp_ = false;
  std::int32_t nearest_triangle_ = -1;
  std::array<std::uint64_t, ModelHostStatistics::kVerdicts> verdicts_{};

  std::mutex map_mutex_;  ///< one refresh at a time; before the other two
  std::unique_ptr<VertexMap> map_;
  IndexedMeshPointer map_laid_;
  std::uint64_t map_generation_ = 0;
  HashGrid map_grid_;
  std::unique_ptr<LocalModel> workspace_;
  News told_;
  std::vector<std::int64_t> began_ns_;  ///< of the last refreshes, a ring
  std::size_t turns_ = 0;

  mutable std::mutex view_mutex_;
  std::condition_variable touched_filled_;
  ModelView view_;
  std::vector<std::int32_t> touched_;
  std::vector<std::uint8_t> is_touched_;

  std::atomic<std::uint64_t> refreshes_{0}, asked_{0};
  std::atomic<int> stale_{0};
  Histogram learning_, refreshing_, waits_;
  std::atomic<bool> stopping_{false};
  mutable std::mutex failure_mutex_;
  std::string failure_;
  std::thread learner_, refresher_;
};

}  // namespace saras
