// What virtual fixtures ask of the tool's motion in one tick: linear rows on its twist.
#pragma once

#include <array>

#include "saras/spatial/types.hpp"

namespace saras::csa {

inline constexpr int kMaxFixtureRows = 96;
inline constexpr int kMaxFixtures = 16;

/// lower <= axis . (displacement of the tip, rotation vector) <= upper over the next tick, base axes. Infinite: no
/// bound.
struct FixtureRow {
  Vector6 axis = Vector6::Zero();  ///< unit in its linear part, except for points away from the tip
  double lower_m = 0.0;
  double upper_m = 0.0;
  int fixture = -1;   ///< index of the fixture that asks
  bool soft = false;  ///< may be violated at a cost
};

/// Fixed capacity, so that it is a plain value and no step allocates.
struct FixtureRows {
  std::array<FixtureRow, kMaxFixtureRows> rows;
  int count = 0;
  bool overflow = false;  ///< more rows were asked for than fit: what is here does not say all

  void clear() noexcept { count = 0, overflow = false; }
  void add(const FixtureRow& row) noexcept {
    if (count < kMaxFixtureRows) {
      rows[static_cast<std::size_t>(count++)] = row;
    } else {
      overflow = true;
    }
  }
  const FixtureRow* begin() const { return rows.data(); }
  const FixtureRow* end() const { return rows.data() + count; }
};

/// Row of a point of the tool at tip_to_point [m] from the tip: its velocity along a unit direction.
inline Vector6 point_axis(const Vector3& direction, const Vector3& tip_to_point) {
  Vector6 axis;
  axis << direction, tip_to_point.cross(direction);
  return axis;
}

}  // namespace saras::csa
