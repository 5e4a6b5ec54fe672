// Who is nearest to whom: any number of tools, any number of regions that one rigid transform moves.
#pragma once

#include <vector>

#include "saras/collision/region_tree.hpp"

namespace saras {

/// A tool as it is now. Not known (lost, too old), not finite or beyond kGreatestCoordinate: nobody knows a distance to
/// it.
struct SceneTool {
  Capsule capsule;
  bool known = true;
};

enum class Partner : std::uint8_t {
  kNone = 0,  ///< nothing that is known
  kTool,
  kRegion,
};

/// Of one tool, in the frame of the tools. What is unknown is named, and is not in the distance.
struct ToolDistance {
  SignedDistance distance;  ///< from the tool to the nearest known thing; UNKNOWN when there is none
  Partner partner = Partner::kNone;
  int index = -1;                   ///< of that tool or region
  bool tool_unknown = true;         ///< this tool itself
  bool other_tool_unknown = false;  ///< at least one other tool
  bool regions_unknown = false;     ///< there are regions, and where they are is not known
};

class Scene {
 public:
  /// All pairs of tools count. Allocates; distances() does not.
  Scene(int tools, const std::vector<Parallelepiped>& regions);
  /// For each tool the nearest thing. tools: as many as constructed, a missing one is unknown. base_T_regions: from
  /// the regions' frame to that of the tools; a pose that is not rigid makes the regions unknown.
  const std::vector<ToolDistance>& distances(const SceneTool* tools, std::size_t count, const Pose& base_T_regions,
                                             bool regions_known = true) noexcept;
  const std::vector<ToolDistance>& distances(const std::vector<SceneTool>& tools, const Pose& base_T_regions = {},
                                             bool regions_known = true) noexcept {
    return distances(tools.data(), tools.size(), base_T_regions, regions_known);
  }
  int tools() const { return static_cast<int>(nearest_.size()); }
  std::size_t regions() const { return tree_.size(); }

 private:
  RegionTree tree_;
  std::vector<ToolDistance> nearest_;
};

}  // namespace saras
