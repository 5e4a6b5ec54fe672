#include "saras/model/local_model.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {

double damping_share(double damping_s_m, double speed_m_s) noexcept {
  constexpr double kLeast = 0.3;  // beyond it the model of damping says nothing
  return std::max(kLeast, 1.0 + damping_s_m * speed_m_s);
}

void LocalModelConfig::validate() const {
  hyperparameters.validate();
  validate::in_range("neighbours", neighbours, 2, 512);
  validate::in_range("min_samples", min_samples, 2, neighbours);
  validate::in_range("radius_m", radius_m, 1e-5, 1.0);
  validate::not_negative("surface_force_N", surface_force_N);
  validate::positive("search_m", search_m);
  validate::in_range("model_error_share", model_error_share, 0.0, 1.0);
}

LocalModel::LocalModel(LocalModelConfig config, const HashGridConfig& grid)
    : config_((config.validate(), config)), process_(config.neighbours, config.hyperparameters) {
  grid.validate();
  validate::in_range("radius_m", config.radius_m, grid.cell_m, 10.0 * grid.cell_m);
  const auto room = static_cast<std::size_t>(grid.candidates_within(config.radius_m));
  found_.resize(room);
  candidates_.resize(room);
  members_.reserve(static_cast<std::size_t>(config.neighbours));
}

void LocalModel::clear() noexcept {
  members_.clear();
  process_.restart(Vector3::Zero(), Vector3::UnitZ());
}

GpSample LocalModel::process_sample(const TouchSample& sample) const noexcept {
  const double force_N = -sample.force.dot(process_.normal());
  const double share = damping_share(config_.hyperparameters.damping_s_m, sample.speed_m_s);
  const double noise_N = config_.hyperparameters.noise_N;
  return {sample.position, sample.speed_m_s * force_N / share, force_N / share, noise_N * noise_N / sample.weight};
}

bool LocalModel::take(const HashGrid& grid, int place) noexcept {
  const bool taken = process_.append(process_sample(grid.place(place)));
  if (taken) {
    members_.push_back(place);
  }
  return taken;
}

bool LocalModel::build(const HashGrid& grid, const Vector3& around, const Vector3* normal) noexcept {
  clear();
  reach_m_ = config_.radius_m;
  const int count = grid.within(around, config_.radius_m, found_.data(), static_cast<int>(found_.size()));
  if (count < config_.min_samples) {
    return false;
  }
  Vector3 reaction = Vector3::Zero();
  for (int i = 0; i < count; ++i) {
    reaction -= grid.place(found_[static_cast<std::size_t>(i)]).force;
  }
  Vector3 outward = normal != nullptr ? *normal : reaction;
  if (!(outward.norm() > 1e-9)) {
    return false;
  }
  outward.normalize();
  for (int i = 0; i < count; ++i) {
    const int place = found_[static_cast<std::size_t>(i)];
    const Vector3 offset = grid.place(place).position - around;
    const double along = offset.dot(outward);
    // Across the surface, as correlation does not fall with depth; depth breaks ties.
    candidates_[static_cast<std::size_t>(i)] = {offset.squaredNorm() - 0.99 * along * along, place};
  }
  const int taken = std::min(count, config_.neighbours);
  const auto nearer = [](const Candidate& a, const Candidate& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.place < b.place);
  };
  std::nth_element(candidates_.begin(), candidates_.begin() + taken - 1, candidates_.begin() + count, nearer);
  if (taken < count) {
    reach_m_ = std::sqrt(candidates_[static_cast<std::size_t>(taken) - 1].distance);
  }
  Vector3 middle = Vector3::Zero();
  for (int i = 0; i < taken; ++i) {
    middle += grid.place(candidates_[static_cast<std::size_t>(i)].place).position / taken;
  }
  center_ = around;
  process_.restart(middle, outward);
  for (int i = 0; i < taken; ++i) {
    take(grid, candidates_[static_cast<std::size_t>(i)].place);
  }
  return usable();
}

void LocalModel::learn(const HashGrid& grid, int place) noexcept {
  auto leaving = std::find(members_.begin(), members_.end(), place);
  if (leaving == members_.end() && process_.size() == process_.capacity()) {
    double farthest = -1.0;
    for (auto member = members_.begin(); member != members_.end(); ++member) {
      const double squared = (grid.place(*member).position - center_).squaredNorm();
      if (squared > farthest) {
        farthest = squared;
        leaving = member;
      }
    }
  }
  if (leaving != members_.end()) {
    process_.remove(static_cast<int>(leaving - members_.begin()));
    members_.erase(leaving);
  }
  take(grid, place);
}

SurfaceEstimate LocalModel::estimate(const Vector3& at) const noexcept {
  SurfaceEstimate estimate;
  estimate.samples = process_.size();
  if (!usable() || !at.allFinite()) {
    return estimate;
  }
  const Vector3& normal = process_.normal();
  const GpPrediction here = process_.predict(at);
  estimate.normal = normal;
  estimate.force_N = here.mean;
  estimate.force_std_N = std::sqrt(here.variance);
  estimate.status = EstimateStatus::kNoSurface;

  // Newton from the sample nearest to the line, along the line.
  double start = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < process_.size(); ++i) {
    const Vector3 offset = process_.position(i) - at;
    const double along = offset.dot(normal);
    const double squared = offset.squaredNorm() - along * along;
    if (squared < least) {
      least = squared;
      start = along;
    }
  }
  constexpr int kIterations = 16;
  constexpr double kTolerance = 1e-8;
  double along = start;
  bool found = false;
  for (int i = 0; i < kIterations && !found; ++i) {
    const LocalGp::MeanAndSlope value = process_.mean_and_slope(at + along * normal);
    if (!(value.slope < 0.0)) {
      return estimate;
    }
    const double limit = 0.5 * config_.search_m;
    const double step = std::clamp((config_.surface_force_N - value.mean) / value.slope, -limit, limit);
    along += step;
    if (std::abs(along - start) > config_.search_m) {
      return estimate;
    }
    found = std::abs(step) < kTolerance;
  }
  if (!found) {
    return estimate;
  }
  const Vector3 surface = at + along * normal;
  const GpPrediction there = process_.predict(surface);
  const double slope = normal.dot(there.gradient);
  if (!(slope < 0.0)) {
    return estimate;
  }
  estimate.surface_point = surface;
  estimate.stiffness_N_m = -slope;
  estimate.stiffness_std_N_m = std::hypot(std::sqrt(std::max(0.0, normal.dot(there.gradient_covariance * normal))),
                                          config_.model_error_share * estimate.stiffness_N_m);
  estimate.surface_std_m =
      std::hypot(std::sqrt(there.variance) / estimate.stiffness_N_m, config_.model_error_share * (along - start));
  estimate.status = EstimateStatus::kOk;
  return estimate;
}

void LocalModel::adopt(const GpHyperparameters& hyperparameters) {
  process_.adopt(hyperparameters);
  config_.hyperparameters = hyperparameters;
  clear();
}

void estimate_surfaces(const HashGrid& grid, LocalModel& workspace, const Vector3* points, const Vector3* normals,
                       std::size_t count, SurfaceEstimate* estimates) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    estimates[i] = workspace.build(grid, points[i], normals != nullptr ? normals + i : nullptr)
                       ? workspace.estimate(points[i])
                       : SurfaceEstimate{};
  }
}

}  // namespace saras
