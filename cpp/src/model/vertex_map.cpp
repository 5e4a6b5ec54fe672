#include "saras/model/vertex_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "saras/spatial/validate.hpp"

namespace saras {

void VertexMapConfig::validate() const {
  validate::in_range("patch_m", patch_m, 1e-5, 0.1);
  validate::in_range("normal_cosine", normal_cosine, 0.0, 1.0);
  validate::not_negative("move_tolerance_m", move_tolerance_m);
}

VertexMap::VertexMap(const std::vector<Vector3>& vertices, const std::vector<Vector3>& normals, double model_radius_m,
                     const VertexMapConfig& config)
    : config_((config.validate(), config)),
      model_radius_m_((validate::positive("model_radius_m", model_radius_m), model_radius_m)),
      vertices_(vertices),
      normals_(normals),
      asked_at_(vertices) {
  validate::in_range("normals", static_cast<int>(normals.size()), static_cast<int>(vertices.size()),
                     static_cast<int>(vertices.size()));
  using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
  std::map<Cell, std::vector<std::int32_t>> cells;  // several patches share a cell where the surface folds
  patch_of_.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3 cell = (vertices[i] / config_.patch_m).array().floor();
    auto& there = cells[{std::llround(cell.x()), std::llround(cell.y()), std::llround(cell.z())}];
    const auto alike = [&](std::int32_t patch) {
      const Patch& candidate = patches_[static_cast<std::size_t>(patch)];
      return candidate.normal.dot(normals[i]) >= config_.normal_cosine;
    };
    auto found = std::find_if(there.begin(), there.end(), alike);
    if (found == there.end()) {
      there.push_back(static_cast<std::int32_t>(patches_.size()));
      found = there.end() - 1;
      patches_.emplace_back().normal = normals[i];  // of the first vertex, until all are there
    }
    patch_of_[i] = *found;
    patches_[static_cast<std::size_t>(*found)].vertices.push_back(static_cast<std::int32_t>(i));
  }
  for (Patch& patch : patches_) {
    settle(patch);
    patch.reach_m = model_radius_m;
  }
  estimates_.resize(vertices.size());
  waiting_.reserve(2 * patches_.size());
}

void VertexMap::settle(Patch& patch) {
  patch.center.setZero();
  patch.normal.setZero();
  for (const std::int32_t vertex : patch.vertices) {
    patch.center += vertices_[static_cast<std::size_t>(vertex)] / static_cast<double>(patch.vertices.size());
    patch.normal += normals_[static_cast<std::size_t>(vertex)];
  }
  patch.normal.normalize();
  patch.radius_m = 0.0;
  for (const std::int32_t vertex : patch.vertices) {
    patch.radius_m = std::max(patch.radius_m, (vertices_[static_cast<std::size_t>(vertex)] - patch.center).norm());
  }
}

void VertexMap::mark(std::int32_t patch) {
  Patch& marked = patches_[static_cast<std::size_t>(patch)];
  if (!marked.stale) {
    marked.stale = true;
    marked.since = refreshes_;
    waiting_.push_back(patch);
  }
}

void VertexMap::touch(const Vector3& position, double slack_m) {
  const double radius = model_radius_m_ + slack_m;
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const Vector3 offset = position - patches_[i].center;
    const double squared = offset.squaredNorm();
    if (squared > radius * radius) {
      continue;
    }
    const double along = offset.dot(patches_[i].normal);
    const double reach = patches_[i].reach_m + slack_m;
    if (squared - along * along <= reach * reach) {  // depth counts for next to nothing: LocalModel::build
      mark(static_cast<std::int32_t>(i));
    }
  }
}

void VertexMap::touch_all() {
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    mark(static_cast<std::int32_t>(i));
  }
}

void VertexMap::move(const std::vector<Vector3>& vertices, const std::vector<Vector3>& normals) {
  const int count = static_cast<int>(vertices_.size());
  validate::in_range("vertices", static_cast<int>(vertices.size()), count, count);
  validate::in_range("normals", static_cast<int>(normals.size()), count, count);
  vertices_ = vertices;
  normals_ = normals;
  for (Patch& patch : patches_) {
    settle(patch);
  }
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    if (!((vertices_[i] - asked_at_[i]).norm() <= config_.move_tolerance_m)) {
      mark(patch_of_[i]);
    }
  }
}

const VertexMap::Refreshed& VertexMap::refresh(const HashGrid& grid, LocalModel& workspace,
                                               const std::vector<Vector3>& tips, double near_m, int more) {
  refreshed_.vertices.clear();
  refreshed_.longest_wait = 0;
  ++refreshes_;
  const auto is_near = [&](const Patch& patch) {
    const double reach = near_m + patch.radius_m;
    return std::any_of(tips.begin(), tips.end(),
                       [&](const Vector3& tip) { return (patch.center - tip).squaredNorm() < reach * reach; });
  };
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const Patch& patch = patches_[static_cast<std::size_t>(waiting_[i])];
    if (patch.stale && is_near(patch)) {
      ask(grid, workspace, waiting_[i]);
    }
  }
  refreshed_.near = refreshed_.vertices.size();
  int left = more;
  for (std::size_t i = 0; i < waiting_.size() && left > 0; ++i) {
    if (patches_[static_cast<std::size_t>(waiting_[i])].stale) {
      ask(grid, workspace, waiting_[i]);
      --left;
    }
  }
  // Those that were asked leave the queue; the order of the others stays.
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(),
                                [&](std::int32_t patch) { return !patches_[static_cast<std::size_t>(patch)].stale; }),
                 waiting_.end());
  return refreshed_;
}

void VertexMap::ask(const HashGrid& grid, LocalModel& workspace, std::int32_t number) {
  Patch& patch = patches_[static_cast<std::size_t>(number)];
  const bool usable = workspace.build(grid, patch.center, &patch.normal);
  for (const std::int32_t vertex : patch.vertices) {
    const auto i = static_cast<std::size_t>(vertex);
    VertexEstimate& estimate = estimates_[i];
    estimate = {};
    if (usable) {
      const SurfaceEstimate found = workspace.estimate(vertices_[i]);
      if (found.status == EstimateStatus::kOk) {
        estimate = {found.stiffness_N_m, found.stiffness_std_N_m};
      }
    }
    asked_at_[i] = vertices_[i];
    refreshed_.vertices.push_back(vertex);
  }
  patch.reach_m = workspace.reach_m();
  patch.stale = false;
  refreshed_.longest_wait = std::max(refreshed_.longest_wait, refreshes_ - patch.since);
}

}  // namespace saras
