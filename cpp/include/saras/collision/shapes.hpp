// What distances are taken between: a tool is a capsule, a forbidden region is a parallelepiped.
#pragma once

#include <array>

#include "saras/spatial/types.hpp"

namespace saras {

/// All points within radius_m of the segment a - b. Zero length (a sphere) and zero radius are ordinary.
struct Capsule {
  Vector3 a = Vector3::Zero();  ///< one end of the axis, e.g. the tip [m]
  Vector3 b = Vector3::Zero();  ///< the other end, e.g. the trocar [m]
  double radius_m = 0.0;        ///< >= 0
};

/// Corners of a parallelepiped in the order of the source document: v0 and its neighbours v1 (x), v4 (y), v3 (z);
/// edges 0-1 1-2 2-3 3-0 0-4 4-7 7-3 4-5 5-6 6-7 1-5 2-6.
using Corners = std::array<Vector3, 8>;

/// A corner may lie this far from where its neighbours put it [m].
inline constexpr double kClosingTolerance = 1e-6;
/// An edge is at least this long [m]: below it, it could not be told from a region that does not close.
inline constexpr double kLeastEdge = 1e-6;
/// No coordinate and no edge is beyond this [m]: products of them stay far from overflow.
inline constexpr double kGreatestCoordinate = 1e9;
/// Volume divided by the product of the three edge lengths is at least this.
inline constexpr double kLeastRelativeVolume = 1e-6;

/// A box, or a skewed box. Immutable but for rigid motion.
class Parallelepiped {
 public:
  /// From the corner v0 and the three edges that leave it [m]. Throws ConfigError: not finite or
  /// too large, edge too short, no volume.
  Parallelepiped(const Vector3& corner, const Vector3& x, const Vector3& y, const Vector3& z);
  /// From eight corners; the shape is spanned by v0, v1, v4 and v3. Throws ConfigError as above, and for a corner
  /// that is further than kClosingTolerance from where the others put it.
  static Parallelepiped from_corners(const Corners& corners);

  const Vector3& center() const { return center_; }
  /// Half of edge x, y or z [m].
  const Vector3& half_edge(int axis) const { return half_edges_[static_cast<std::size_t>(axis)]; }
  /// Unit normals of the faces spanned by the two other edges. For a rectangular one these are its axes.
  const Vector3& face_normal(int axis) const { return face_normals_[static_cast<std::size_t>(axis)]; }
  /// Distance of those faces from the centre [m].
  double half_width(int axis) const { return half_widths_[axis]; }
  const Vector3& half_widths() const { return half_widths_; }
  bool rectangular() const { return rectangular_; }

  Corners corners() const;
  /// [m^3]
  double volume() const;
  /// No corner has |x| + |y| + |z| above this [m]: the scale of rounding errors.
  double magnitude() const { return magnitude_; }
  /// The same shape elsewhere. Exactly as rectangular as before.
  Parallelepiped moved(const Pose& a_T_b) const noexcept;

 private:
  Parallelepiped() = default;
  void finish() noexcept;

  Vector3 center_ = Vector3::Zero();
  std::array<Vector3, 3> half_edges_;
  std::array<Vector3, 3> face_normals_;
  Vector3 half_widths_ = Vector3::Zero();
  double magnitude_ = 0.0;
  bool rectangular_ = false;
};

}  // namespace saras
