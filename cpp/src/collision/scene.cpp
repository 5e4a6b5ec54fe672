#include "saras/collision/scene.hpp"

#include <cmath>
#include <string>

#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

/// Finite, and so far from overflow that each distance is finite.
bool is_usable(const Vector3& point) noexcept { return point.lpNorm<1>() <= kGreatestCoordinate; }

bool is_known(const SceneTool& tool) noexcept {
  const Capsule& capsule = tool.capsule;
  return tool.known && is_usable(capsule.a) && is_usable(capsule.b) && capsule.radius_m >= 0.0 &&
         capsule.radius_m <= kGreatestCoordinate;
}

SignedDistance reversed(const SignedDistance& d) noexcept {
  return {d.distance_m, d.point_b, d.point_a, -d.normal, d.status};
}

void offer(ToolDistance& nearest, const SignedDistance& candidate, Partner partner, int index) noexcept {
  if (nearest.partner == Partner::kNone || candidate.distance_m < nearest.distance.distance_m) {
    nearest.distance = candidate;
    nearest.partner = partner;
    nearest.index = index;
  }
}

}  // namespace

Scene::Scene(int tools, const std::vector<Parallelepiped>& regions) : tree_(regions) {
  if (tools < 0) {
    throw ConfigError("tools = " + std::to_string(tools) + ": must be >= 0");
  }
  nearest_.resize(static_cast<std::size_t>(tools));
}

const std::vector<ToolDistance>& Scene::distances(const SceneTool* tools, std::size_t count, const Pose& base_T_regions,
                                                  bool regions_known) noexcept {
  const bool regions_unknown =
      tree_.size() > 0 && !(regions_known && is_valid(base_T_regions) && is_usable(base_T_regions.translation));
  std::size_t unknown_tools = 0;
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    nearest_[i] = ToolDistance();
    nearest_[i].tool_unknown = i >= count || !is_known(tools[i]);
    nearest_[i].regions_unknown = regions_unknown;
    unknown_tools += nearest_[i].tool_unknown ? 1 : 0;
  }
  const Pose regions_T_base = base_T_regions.inverse();
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    ToolDistance& mine = nearest_[i];
    mine.other_tool_unknown = unknown_tools > (mine.tool_unknown ? 1u : 0u);
    if (mine.tool_unknown) {
      continue;
    }
    for (std::size_t j = i + 1; j < nearest_.size(); ++j) {
      if (nearest_[j].tool_unknown) {
        continue;
      }
      const SignedDistance between = distance(tools[i].capsule, tools[j].capsule);
      offer(mine, between, Partner::kTool, static_cast<int>(j));
      offer(nearest_[j], reversed(between), Partner::kTool, static_cast<int>(i));
    }
    if (regions_unknown || tree_.size() == 0) {
      continue;
    }
    const Capsule& tool = tools[i].capsule;
    const double within =
        mine.partner == Partner::kNone ? std::numeric_limits<double>::infinity() : mine.distance.distance_m;
    const RegionTree::Nearest region =
        tree_.nearest({regions_T_base * tool.a, regions_T_base * tool.b, tool.radius_m}, within);
    if (region.region >= 0) {
      const SignedDistance& d = region.distance;
      offer(mine,
            {d.distance_m, base_T_regions * d.point_a, base_T_regions * d.point_b, base_T_regions.rotation * d.normal,
             d.status},
            Partner::kRegion, region.region);
    }
  }
  return nearest_;
}

}  // namespace saras
