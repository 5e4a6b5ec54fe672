#include "saras/collision/region_tree.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "saras/spatial/errors.hpp"
#include "segments.hpp"

namespace saras {
namespace {

using namespace collision;

constexpr std::int32_t kLeafSize = 2;
/// Regions are halved at each level, so 2^31 of them would need 31.
constexpr std::size_t kMaxDepth = 64;

struct Bounds {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = Vector3::Constant(-std::numeric_limits<double>::infinity());
};

Bounds bounds_of(const Parallelepiped& region) {
  const Vector3 half = region.half_edge(0).cwiseAbs() + region.half_edge(1).cwiseAbs() + region.half_edge(2).cwiseAbs();
  return {region.center() - half, region.center() + half};
}

/// The tool's axis, prepared for many boxes.
struct Axis {
  Vector3 begin;
  Vector3 along;
  Vector3 middle;
  Vector3 half;
  double radius_m;
};

/// No region inside the box has a signed distance below this. Rough first: most boxes are far.
double least_possible(const Axis& axis, const Vector3& center, const Vector3& half, double enough) noexcept {
  const Vector3 offset = axis.middle - center;
  const double rough = (offset.cwiseAbs() - axis.half.cwiseAbs() - half).cwiseMax(0.0).norm();
  if (rough > 0.0 && rough - axis.radius_m >= enough) {
    return rough - axis.radius_m;
  }
  const Vector3 begin = axis.begin - center;
  const double t = closest_to_box(begin, axis.along, half);
  const double gap = beyond_box(begin + t * axis.along, half).norm();
  if (gap > 0.0) {
    return gap - axis.radius_m;
  }
  // What lies inside a box is not deeper in the tool than the box is.
  return -(half + axis.half.cwiseAbs() - offset.cwiseAbs()).minCoeff() - axis.radius_m;
}

}  // namespace

RegionTree::RegionTree(const std::vector<Parallelepiped>& regions) {
  if (regions.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max() / 4)) {
    throw ConfigError("regions: count = " + std::to_string(regions.size()) + ": must be at most 536870911");
  }
  indices_.resize(regions.size());
  std::iota(indices_.begin(), indices_.end(), 0);
  if (!regions.empty()) {
    nodes_.reserve(2 * regions.size());
    build(regions, indices_, 0, static_cast<std::int32_t>(regions.size()));
  }
  regions_.reserve(regions.size());
  for (const std::int32_t index : indices_) {
    regions_.push_back(regions[static_cast<std::size_t>(index)]);
  }
}

std::int32_t RegionTree::build(const std::vector<Parallelepiped>& regions, std::vector<std::int32_t>& order,
                               std::int32_t begin, std::int32_t end) {
  Bounds all;
  Bounds centers;
  for (std::int32_t i = begin; i < end; ++i) {
    const Parallelepiped& region = regions[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
    const Bounds one = bounds_of(region);
    all.low = all.low.cwiseMin(one.low);
    all.high = all.high.cwiseMax(one.high);
    centers.low = centers.low.cwiseMin(region.center());
    centers.high = centers.high.cwiseMax(region.center());
  }
  const auto place = static_cast<std::int32_t>(nodes_.size());
  nodes_.push_back({0.5 * (all.low + all.high), 0.5 * (all.high - all.low), begin, end - begin});
  if (end - begin > kLeafSize) {
    int axis = 0;
    (centers.high - centers.low).maxCoeff(&axis);
    const std::int32_t middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](std::int32_t a, std::int32_t b) {
                       return regions[static_cast<std::size_t>(a)].center()[axis] <
                              regions[static_cast<std::size_t>(b)].center()[axis];
                     });
    build(regions, order, begin, middle);
    const std::int32_t second = build(regions, order, middle, end);
    nodes_[static_cast<std::size_t>(place)].first = second;
    nodes_[static_cast<std::size_t>(place)].count = 0;
  }
  return place;
}

RegionTree::Nearest RegionTree::nearest(const Capsule& tool, double within_m) const noexcept {
  Nearest best;
  const Vector3 along = tool.b - tool.a;
  if (nodes_.empty() || !along.allFinite() || !(tool.radius_m >= 0.0)) {
    return best;
  }
  const Axis axis{tool.a, along, 0.5 * (tool.a + tool.b), 0.5 * along, tool.radius_m};
  struct Entry {
    std::int32_t node;
    double bound;
  };
  std::array<Entry, kMaxDepth> stack;
  std::size_t height = 0;
  double least = within_m;
  const auto bound_of = [&](std::int32_t node) {
    const Node& box = nodes_[static_cast<std::size_t>(node)];
    return least_possible(axis, box.center, box.half, least);
  };
  stack[height++] = {0, bound_of(0)};
  while (height > 0) {
    const Entry entry = stack[--height];
    if (!(entry.bound < least)) {
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.count > 0) {
      for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
        const SignedDistance candidate = distance(tool, regions_[static_cast<std::size_t>(i)]);
        if (candidate.distance_m < least) {
          least = candidate.distance_m;
          best.distance = candidate;
          best.region = indices_[static_cast<std::size_t>(i)];
        }
      }
      continue;
    }
    Entry near{entry.node + 1, bound_of(entry.node + 1)};
    Entry far{node.first, bound_of(node.first)};
    if (far.bound < near.bound) {
      std::swap(near, far);
    }
    stack[height++] = far;
    stack[height++] = near;
  }
  return best;
}

}  // namespace saras
