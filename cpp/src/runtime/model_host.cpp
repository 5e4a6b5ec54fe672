#include "saras/runtime/model_host.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "saras/model/model_error.hpp"
#include "saras/runtime/clock.hpp"
#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr double kLongestWait_s = 0.1;    // of the learner, so that stop() comes soon
constexpr double kLeastStep_s = 1e-4;     // two samples of one stamp
constexpr std::size_t kTurnsKept = 4096;  // beginnings of refreshes, to tell how long a patch waited
constexpr double kSecond = 1e9;

}  // namespace

void ModelHostConfig::validate() const {
  law.validate();
  vertices.validate();
  validate::in_range("free_m", free_m, 0.0, 1.0);
  validate::in_range("near_m", near_m, 0.0, 1.0);
  validate::in_range("touched_hz", touched_hz, 0.1, 1000.0);
  validate::in_range("map_hz", map_hz, 1e-3, touched_hz);
  validate::in_range("room", room, 1, 10'000'000);
}

ModelHost::ModelHost(IndexedMeshPointer prior, ModelHostConfig config)
    : config_((config.validate(), config)),
      queue_(config.room),
      law_(config.law),
      map_grid_(config.law.grid),
      began_ns_(kTurnsKept) {
  begin_with(std::move(prior));
}

ModelHost::~ModelHost() { stop(); }

// ---- threads

template <typename Turn>
void ModelHost::run(const char* name, Turn&& turn) noexcept {
  try {
    while (!stopping_.load(std::memory_order_acquire)) {
      turn();
    }
  } catch (const std::exception& error) {
    const std::lock_guard<std::mutex> lock(failure_mutex_);
    failure_ = std::string(name) + ": " + error.what();
  } catch (...) {
    const std::lock_guard<std::mutex> lock(failure_mutex_);
    failure_ = std::string(name) + ": unknown exception";
  }
}

void ModelHost::start() {
  if (learner_.joinable()) {
    throw Error("the model's threads run already: stop them first");
  }
  stopping_.store(false, std::memory_order_release);
  learner_ = std::thread([this] {
    run("learning", [this] {
      queue_.wait(kLongestWait_s);
      learn_waiting();
    });
  });
  refresher_ = std::thread([this] {
    const auto period_ns = static_cast<std::int64_t>(kSecond / config_.touched_hz);
    std::int64_t due_ns = monotonic_ns();
    run("refreshing", [this, period_ns, &due_ns] {
      refresh(false);
      // Turns that took too long are not made up for.
      due_ns = std::max(due_ns + period_ns, monotonic_ns());
      sleep_until_ns(due_ns);
    });
  });
}

void ModelHost::stop() noexcept {
  stopping_.store(true, std::memory_order_release);
  queue_.wake();
  for (std::thread* thread : {&learner_, &refresher_}) {
    if (thread->joinable()) {
      thread->join();
    }
  }
}

std::string ModelHost::failure() const {
  const std::lock_guard<std::mutex> lock(failure_mutex_);
  return failure_;
}

// ---- learning

void ModelHost::learn_waiting() {
  IndexedMeshPointer laid;
  {
    const std::lock_guard<std::mutex> lock(view_mutex_);
    laid = view_.laid;
  }
  const std::lock_guard<std::mutex> lock(law_mutex_);
  queue_.take(batch_);
  for (const StampedTouch& sample : batch_) {
    const std::int64_t began_ns = monotonic_ns();
    learn(sample, *laid);
    learning_.record(monotonic_ns() - began_ns);
  }
}

void ModelHost::learn(const StampedTouch& sample, const IndexedMesh& laid) {
  TouchBelief belief = TouchBelief::kUnknown;
  if (sample.position.allFinite()) {
    const MeshMatch match = laid.tree.closest(sample.position, nearest_triangle_);
    nearest_triangle_ = match.triangle;
    const double height_m = (sample.position - match.point).dot(laid.tree.normal(match.triangle));
    belief = height_m > config_.free_m ? TouchBelief::kFree : TouchBelief::kUnknown;
  }
  const double step_s = has_stamp_ ? sample.stamp_s - last_stamp_s_ : 0.0;
  last_stamp_s_ = sample.stamp_s;
  has_stamp_ = true;
  const std::uint64_t evicted = law_.state().grid.evicted();
  const Seconds dt = std::clamp(step_s, kLeastStep_s, config_.law.dt_max_s);
  const auto verdict = law_.step({sample.position, sample.force, sample.velocity, belief}, dt).verdict;
  ++verdicts_[static_cast<std::size_t>(verdict)];
  remember(sample.position, verdict, evicted);
}

void ModelHost::remember(const Vector3& position, SampleVerdict verdict, std::uint64_t evicted) {
  if (verdict != SampleVerdict::kLearned && verdict != SampleVerdict::kRelearned) {
    return;
  }
  // What was forgotten for want of room may lie anywhere.
  news_.everywhere = news_.everywhere || law_.state().grid.evicted() != evicted;
  news_.forgotten_here = news_.forgotten_here || verdict == SampleVerdict::kRelearned;
  const double apart_m = 0.5 * config_.law.grid.cell_m;
  if (news_.learned_at.empty() || (news_.learned_at.back() - position).norm() > apart_m) {
    news_.learned_at.push_back(position);
  }
  news_.tips.assign({news_.learned_at.front(), position});
}

// ---- the map

void ModelHost::refresh(bool all) {
  const std::lock_guard<std::mutex> turn(map_mutex_);
  const std::int64_t began_ns = monotonic_ns();
  told_.learned_at.clear();
  told_.tips.clear();
  told_.everywhere = told_.forgotten_here = false;
  {
    const std::lock_guard<std::mutex> law_lock(law_mutex_);
    std::swap(told_, news_);
    const std::lock_guard<std::mutex> view_lock(view_mutex_);
    if (!map_ || map_generation_ != view_.generation) {
      map_laid_ = view_.laid;
      map_generation_ = view_.generation;
      map_ = std::make_unique<VertexMap>(map_laid_->mesh.vertices, map_laid_->normals, config_.law.local.radius_m,
                                         config_.vertices);
    }
    if (!told_.learned_at.empty() || told_.everywhere || map_laid_ != view_.laid) {
      map_grid_ = law_.state().grid;
      workspace_ = std::make_unique<LocalModel>(law_.config().local, config_.law.grid);
    }
    if (map_laid_ != view_.laid) {
      map_laid_ = view_.laid;
      map_->move(map_laid_->mesh.vertices, map_laid_->normals);
    }
  }
  const double slack_m = config_.law.grid.cell_m + (told_.forgotten_here ? 2.0 * config_.law.recenter_m : 0.0);
  for (const Vector3& position : told_.learned_at) {
    map_->touch(position, slack_m);
  }
  if (told_.everywhere) {
    map_->touch_all();
  }
  began_ns_[turns_ % kTurnsKept] = began_ns;
  ++turns_;
  if (!workspace_) {
    return;  // nothing was ever learned
  }
  const double share = config_.map_hz / config_.touched_hz;
  const int more = all ? map_->patches() : static_cast<int>(std::ceil(map_->patches() * share));
  const VertexMap::Refreshed& refreshed = map_->refresh(map_grid_, *workspace_, told_.tips, config_.near_m, more);
  commit(refreshed, map_generation_);
  const std::int64_t ended_ns = monotonic_ns();
  refreshing_.record(ended_ns - began_ns);
  if (!refreshed.vertices.empty()) {
    const auto wait = std::min(static_cast<std::size_t>(refreshed.longest_wait), std::min(turns_, kTurnsKept));
    waits_.record(ended_ns - began_ns_[(turns_ - wait) % kTurnsKept]);
  }
  asked_.fetch_add(refreshed.vertices.size(), std::memory_order_relaxed);
  refreshes_.fetch_add(refreshed.near > 0 ? 1 : 0, std::memory_order_relaxed);
  stale_.store(map_->stale(), std::memory_order_relaxed);
}

void ModelHost::commit(const VertexMap::Refreshed& refreshed, std::uint64_t generation) {
  {
    const std::lock_guard<std::mutex> lock(view_mutex_);
    if (view_.generation != generation) {
      return;  // all of it was forgotten meanwhile
    }
    for (const std::int32_t vertex : refreshed.vertices) {
      const auto i = static_cast<std::size_t>(vertex);
      view_.estimates[i] = map_->estimates()[i];
    }
    for (std::size_t k = 0; k < refreshed.near; ++k) {
      const auto i = static_cast<std::size_t>(refreshed.vertices[k]);
      if (is_touched_[i] == 0) {
        is_touched_[i] = 1;
        touched_.push_back(refreshed.vertices[k]);
      }
    }
  }
  touched_filled_.notify_all();
}

// ---- looking

ModelView ModelHost::view() const {
  const std::lock_guard<std::mutex> lock(view_mutex_);
  return view_;
}

TouchedVertices ModelHost::take_touched() {
  TouchedVertices taken;
  const std::lock_guard<std::mutex> lock(view_mutex_);
  taken.laid = view_.laid;
  taken.vertices.swap(touched_);
  std::sort(taken.vertices.begin(), taken.vertices.end());
  taken.estimates.reserve(taken.vertices.size());
  for (const std::int32_t vertex : taken.vertices) {
    taken.estimates.push_back(view_.estimates[static_cast<std::size_t>(vertex)]);
    is_touched_[static_cast<std::size_t>(vertex)] = 0;
  }
  return taken;
}

bool ModelHost::wait_touched(double timeout_s) {
  std::unique_lock<std::mutex> lock(view_mutex_);
  return touched_filled_.wait_for(lock, std::chrono::duration<double>(timeout_s), [this] { return !touched_.empty(); });
}

HashGrid ModelHost::grid(LocalModelConfig& local, std::uint64_t& generation) const {
  const std::lock_guard<std::mutex> law_lock(law_mutex_);
  {
    const std::lock_guard<std::mutex> view_lock(view_mutex_);
    generation = view_.generation;
  }
  local = law_.config().local;
  return law_.state().grid;
}

ModelHostStatistics ModelHost::statistics() const {
  ModelHostStatistics statistics;
  {
    const std::lock_guard<std::mutex> lock(law_mutex_);
    statistics.verdicts = verdicts_;
    statistics.places = law_.state().grid.places();
    statistics.bias_N = law_.state().bias_N;
    statistics.disagreement = law_.state().disagreement;
  }
  statistics.dropped = queue_.dropped();
  statistics.waiting = queue_.waiting();
  statistics.refreshes = refreshes_.load(std::memory_order_relaxed);
  statistics.asked = asked_.load(std::memory_order_relaxed);
  statistics.stale = stale_.load(std::memory_order_relaxed);
  statistics.learning = learning_.snapshot();
  statistics.refreshing = refreshing_.snapshot();
  statistics.waits = waits_.snapshot();
  return statistics;
}

// ---- what others found out

bool ModelHost::lay(IndexedMeshPointer mesh, std::uint64_t generation) {
  const std::lock_guard<std::mutex> lock(view_mutex_);
  if (mesh->mesh.vertices.size() != view_.estimates.size()) {
    throw ModelError("mesh: " + std::to_string(mesh->mesh.vertices.size()) + " vertices: must be " +
                     std::to_string(view_.estimates.size()) + ", as it was");
  }
  if (generation != view_.generation) {
    return false;
  }
  view_.laid = std::move(mesh);
  return true;
}

bool ModelHost::adopt(const GpHyperparameters& hyperparameters, std::uint64_t generation) {
  const std::lock_guard<std::mutex> law_lock(law_mutex_);
  {
    const std::lock_guard<std::mutex> view_lock(view_mutex_);
    if (generation != view_.generation) {
      return false;
    }
  }
  law_.adopt(hyperparameters);
  news_.everywhere = true;
  return true;
}

void ModelHost::reset(IndexedMeshPointer prior) {
  const std::lock_guard<std::mutex> turn(map_mutex_);
  begin_with(std::move(prior));
}

void ModelHost::begin_with(IndexedMeshPointer prior) {
  if (!prior) {
    throw ConfigError("prior: must be a mesh");
  }
  const std::lock_guard<std::mutex> law_lock(law_mutex_);
  const std::lock_guard<std::mutex> view_lock(view_mutex_);
  queue_.clear();
  law_ = StiffnessGp(config_.law);  // hyper-parameters as configured, too: they were learned from what is forgotten
  news_ = {};
  has_stamp_ = false;
  nearest_triangle_ = -1;
  verdicts_.fill(0);
  workspace_.reset();
  view_.laid = std::move(prior);
  view_.estimates.assign(view_.laid->mesh.vertices.size(), {});
  ++view_.generation;
  touched_.clear();
  is_touched_.assign(view_.estimates.size(), 0);
}

}  // namespace saras
