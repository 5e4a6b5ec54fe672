// Signed distances between tools (capsules) and forbidden regions (parallelepipeds).
//
// Apart: the Euclidean distance. Overlapping: minus the length of the least translation that separates. Both follow
// from the Minkowski difference Z of the axes (or axis and box) and the origin: a sphere of radius r around Z only
// adds r, so signed distance = (distance of the origin from Z, or minus its depth in Z) - r.
//
//   capsule - capsule         Z is a flat parallelogram: it has no depth. Segment - segment is Lumelsky's case analysis
//                             with the line parameter from cross products, which keeps nearly parallel axes accurate.
//   capsule - rectangular     squared distance along the axis is convex and piecewise quadratic with six breaks.
//   capsule - skewed          outside: least over (end, face) and (axis, edge); every other pair of features has its
//                             closest points on one of these.
//   axis inside the box       Z is a zonotope of four generators; its depth is the least over its at most six pairs
//                             of faces: three of the box, three spanned by the axis and an edge.
//
// No function allocates or throws. Tolerances are relative to the sizes and coordinates of the input.
#pragma once

#include <cstdint>
#include <limits>

#include "saras/collision/shapes.hpp"

namespace saras {

enum class DistanceStatus : std::uint8_t {
  kSeparated = 0,
  kTouching,     ///< |distance| within 1e-12 of the input's coordinates and sizes
  kPenetrating,  ///< distance is minus the least translation that separates
  kUnknown,      ///< input not finite or radius < 0: every number is NaN
};

/// Upper-case name, as shown to operators and in messages.
const char* to_string(DistanceStatus status) noexcept;

/// Distance of b from a. point_b = point_a + distance_m * normal, whether apart or overlapping; moving a by
/// distance_m * normal makes the two touch in point_b.
struct SignedDistance {
  double distance_m = std::numeric_limits<double>::quiet_NaN();
  Vector3 point_a = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< on the surface of a [m]
  Vector3 point_b = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< on the surface of b [m]
  Vector3 normal = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());   ///< unit, from a towards b
  DistanceStatus status = DistanceStatus::kUnknown;
};

/// Closest points of two segments a0 - a1 and b0 - b1. Of parallel segments that lie beside each other it is the
/// middle of where they do.
struct SegmentPair {
  Vector3 point_a;
  Vector3 point_b;
};
SegmentPair closest_points(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1) noexcept;

/// Crossing axes: the normal is perpendicular to both; coinciding ones: any perpendicular; two points: any direction.
SignedDistance distance(const Capsule& a, const Capsule& b) noexcept;
SignedDistance distance(const Capsule& a, const Parallelepiped& b) noexcept;

}  // namespace saras
