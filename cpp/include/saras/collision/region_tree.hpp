// Broad phase: a binary tree of axis-aligned boxes over regions that stand still in their own frame.
#pragma once

#include <cstdint>
#include <vector>

#include "saras/collision/distance.hpp"

namespace saras {

/// Built once; a query visits what is near and allocates nothing.
class RegionTree {
 public:
  explicit RegionTree(const std::vector<Parallelepiped>& regions);

  struct Nearest {
    SignedDistance distance;  ///< from the tool to the region
    int region = -1;          ///< index as given to the constructor; -1: nothing nearer than `within_m`
  };
  /// The region with the least signed distance, of those below within_m. Nothing for a tool that is not finite.
  Nearest nearest(const Capsule& tool, double within_m = std::numeric_limits<double>::infinity()) const noexcept;

  std::size_t size() const { return regions_.size(); }

 private:
  struct Node {
    Vector3 center;
    Vector3 half;
    std::int32_t first;  ///< leaf: of its regions; else: the second child (the first one comes right behind its parent)
    std::int32_t count;  ///< leaf: number of regions; else 0
  };
  std::int32_t build(const std::vector<Parallelepiped>& regions, std::vector<std::int32_t>& order, std::int32_t begin,
                     std::int32_t end);

  std::vector<Node> nodes_;
  std::vector<Parallelepiped> regions_;  ///< in the order of the leaves, for the cache
  std::vector<std::int32_t> indices_;    ///< place in regions_ -> index as given
};

}  // namespace saras
