#include "saras/model/hash_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

std::size_t hash_of(const Eigen::Matrix<std::int32_t, 3, 1>& index) noexcept {
  std::uint64_t mixed = 0;
  for (int axis = 0; axis < 3; ++axis) {
    mixed = (mixed ^ static_cast<std::uint32_t>(index[axis])) * 0x9E3779B97F4A7C15ULL;
    mixed ^= mixed >> 29;
  }
  return static_cast<std::size_t>(mixed);
}

std::size_t power_of_two_above(int count) {
  std::size_t size = 1;
  while (size < 2 * static_cast<std::size_t>(count)) {
    size *= 2;
  }
  return size;
}

}  // namespace

void HashGridConfig::validate() const {
  validate::in_range("cell_m", cell_m, 1e-5, 1.0);
  validate::in_range("samples_per_cell", samples_per_cell, 1, 16);
  validate::in_range("max_cells", max_cells, 1, 4'000'000);
  validate::in_range("max_weight", max_weight, 1.0, 1e9);
}

int HashGridConfig::candidates_within(double radius_m) const noexcept {
  const double side = std::floor(2.0 * radius_m / cell_m) + 2.0;
  return static_cast<int>(std::min(side * side * side, 1e6)) * samples_per_cell;
}

HashGrid::HashGrid(HashGridConfig config)
    : config_((config.validate(), config)),
      buckets_(power_of_two_above(config.max_cells)),
      cells_(static_cast<std::size_t>(config.max_cells)),
      samples_(static_cast<std::size_t>(config.max_cells) * static_cast<std::size_t>(config.samples_per_cell)) {
  clear();
}

void HashGrid::clear() noexcept {
  std::fill(buckets_.begin(), buckets_.end(), -1);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    cells_[i] = Cell{};
    cells_[i].next = i + 1 < cells_.size() ? static_cast<std::int32_t>(i + 1) : -1;
  }
  std::fill(samples_.begin(), samples_.end(), TouchSample{});
  free_ = 0;
  newest_ = oldest_ = -1;
  places_ = cells_used_ = 0;
  evicted_ = taken_ = 0;
}

HashGrid::Index HashGrid::index_of(const Vector3& position) const noexcept {
  return (position / config_.cell_m).array().floor().cast<std::int32_t>();
}

std::int32_t& HashGrid::bucket(const Index& index) noexcept { return buckets_[hash_of(index) & (buckets_.size() - 1)]; }

std::int32_t HashGrid::find(const Index& index) const noexcept {
  std::int32_t cell = buckets_[hash_of(index) & (buckets_.size() - 1)];
  while (cell >= 0 && cells_[static_cast<std::size_t>(cell)].index != index) {
    cell = cells_[static_cast<std::size_t>(cell)].next;
  }
  return cell;
}

void HashGrid::unlink(std::int32_t number) noexcept {
  Cell& cell = cells_[static_cast<std::size_t>(number)];
  (cell.newer >= 0 ? cells_[static_cast<std::size_t>(cell.newer)].older : newest_) = cell.older;
  (cell.older >= 0 ? cells_[static_cast<std::size_t>(cell.older)].newer : oldest_) = cell.newer;
  cell.newer = cell.older = -1;
}

void HashGrid::touch(std::int32_t number) noexcept {
  if (newest_ == number) {
    return;
  }
  Cell& cell = cells_[static_cast<std::size_t>(number)];
  if (cell.newer >= 0 || cell.older >= 0 || oldest_ == number) {
    unlink(number);
  }
  cell.older = newest_;
  (newest_ >= 0 ? cells_[static_cast<std::size_t>(newest_)].newer : oldest_) = number;
  newest_ = number;
}

void HashGrid::release(std::int32_t number) noexcept {
  Cell& cell = cells_[static_cast<std::size_t>(number)];
  std::int32_t* link = &bucket(cell.index);
  while (*link != number) {
    link = &cells_[static_cast<std::size_t>(*link)].next;
  }
  *link = cell.next;
  unlink(number);
  const auto first = static_cast<std::size_t>(number) * static_cast<std::size_t>(config_.samples_per_cell);
  for (std::size_t i = first; i < first + static_cast<std::size_t>(config_.samples_per_cell); ++i) {
    places_ -= samples_[i].weight > 0.0 ? 1 : 0;
    samples_[i] = TouchSample{};
  }
  cell = Cell{};
  cell.next = free_;
  free_ = number;
  --cells_used_;
}

std::int32_t HashGrid::take_cell(const Index& index) noexcept {
  if (free_ < 0) {
    release(oldest_);
    ++evicted_;
  }
  const std::int32_t number = free_;
  Cell& cell = cells_[static_cast<std::size_t>(number)];
  free_ = cell.next;
  cell.index = index;
  cell.used = true;
  std::int32_t& head = bucket(index);
  cell.next = head;
  head = number;
  ++cells_used_;
  return number;
}

int HashGrid::insert(const Vector3& position, const Vector3& force, double speed_m_s) noexcept {
  if (!position.allFinite() || !force.allFinite() || !std::isfinite(speed_m_s) ||
      !(position.cwiseAbs().maxCoeff() < reach_m())) {
    return -1;
  }
  const Index index = index_of(position);
  std::int32_t cell = find(index);
  if (cell < 0) {
    cell = take_cell(index);
  }
  touch(cell);
  ++taken_;
  const int first = cell * config_.samples_per_cell;
  int nearest = -1;
  int vacant = -1;
  double least = 0.25 * config_.cell_m * config_.cell_m;  // nearer than half a cell: the same place
  for (int i = first; i < first + config_.samples_per_cell; ++i) {
    const TouchSample& sample = samples_[static_cast<std::size_t>(i)];
    if (sample.weight == 0.0) {
      vacant = vacant < 0 ? i : vacant;
      continue;
    }
    const double squared = (sample.position - position).squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = i;
    }
  }
  if (nearest < 0 && vacant < 0) {
    least = std::numeric_limits<double>::infinity();
    for (int i = first; i < first + config_.samples_per_cell; ++i) {
      const double squared = (samples_[static_cast<std::size_t>(i)].position - position).squaredNorm();
      if (squared < least) {
        least = squared;
        nearest = i;
      }
    }
  }
  const int number = nearest < 0 ? vacant : nearest;
  TouchSample& sample = samples_[static_cast<std::size_t>(number)];
  places_ += sample.weight == 0.0 ? 1 : 0;
  sample.weight = std::min(sample.weight, config_.max_weight - 1.0) + 1.0;
  sample.position += (position - sample.position) / sample.weight;
  sample.force += (force - sample.force) / sample.weight;
  sample.speed_m_s += (speed_m_s - sample.speed_m_s) / sample.weight;
  return number;
}

int HashGrid::within(const Vector3& point, double radius_m, int* places, int room) const noexcept {
  if (!point.allFinite() || !(point.cwiseAbs().maxCoeff() + radius_m < reach_m())) {
    return 0;
  }
  const Index low = index_of(point - Vector3::Constant(radius_m));
  const Index high = index_of(point + Vector3::Constant(radius_m));
  const double squared = radius_m * radius_m;
  int found = 0;
  Index index;
  for (index.x() = low.x(); index.x() <= high.x(); ++index.x()) {
    for (index.y() = low.y(); index.y() <= high.y(); ++index.y()) {
      for (index.z() = low.z(); index.z() <= high.z(); ++index.z()) {
        // The nearest point of the cell first: a cube has twice the cells of its ball.
        const Vector3 corner = index.cast<double>() * config_.cell_m;
        const Vector3 nearest = point.cwiseMax(corner).cwiseMin(corner + Vector3::Constant(config_.cell_m));
        if ((nearest - point).squaredNorm() > squared) {
          continue;
        }
        const std::int32_t cell = find(index);
        const int first = cell * config_.samples_per_cell;
        for (int i = first; cell >= 0 && i < first + config_.samples_per_cell; ++i) {
          const TouchSample& sample = samples_[static_cast<std::size_t>(i)];
          if (sample.weight > 0.0 && (sample.position - point).squaredNorm() <= squared && found < room) {
            places[found++] = i;
          }
        }
      }
    }
  }
  return found;
}

void HashGrid::forget(const Vector3& point, double radius_m) noexcept {
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(cells_.size()); ++i) {
    const Cell& cell = cells_[static_cast<std::size_t>(i)];
    const Vector3 center = (cell.index.cast<double>() + Vector3::Constant(0.5)) * config_.cell_m;
    if (cell.used && (center - point).norm() <= radius_m) {
      release(i);
    }
  }
}

std::vector<int> HashGrid::used() const {
  std::vector<int> numbers;
  numbers.reserve(static_cast<std::size_t>(places_));
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (samples_[i].weight > 0.0) {
      numbers.push_back(static_cast<int>(i));
    }
  }
  return numbers;
}

}  // namespace saras
