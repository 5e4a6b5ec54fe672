// Geometry of segments that distance.cpp and aabb_tree.cpp share. Private to the room.
#pragma once

#include <algorithm>
#include <cmath>

#include "saras/spatial/types.hpp"

namespace saras::collision {

/// Error that rounding may leave, relative to the coordinates and sizes of the input.
inline constexpr double kRelative = 1e-12;
/// A gap below this, relative to the same, has no direction: rounding would turn its normal by 1e-5 and more.
inline constexpr double kNoDirection = 1e-11;
/// sin^2 of the angle between two axes below which they count as parallel: lateral error 1e-12 of their length.
inline constexpr double kParallel = 1e-24;

/// NaN becomes 0.
inline double unit_interval(double t) noexcept { return t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0; }

/// Closest points a0 + s u and b0 + t v of two segments; r = b0 - a0, cross = u x v.
struct SegmentParameters {
  double s;
  double t;
  bool parallel;
};

inline SegmentParameters parallel_parameters(const Vector3& u, const Vector3& v, const Vector3& r, double uu,
                                             double vv) noexcept {
  if (!(uu > 0.0)) {
    return {0.0, 0.0, true};
  }
  const double begin = r.dot(u) / uu;
  const double end = (r + v).dot(u) / uu;
  const double low = std::max(0.0, std::min(begin, end));
  const double high = std::min(1.0, std::max(begin, end));
  // Beside each other: the middle of where they are. Else the end of a that faces b.
  double s = low <= high ? 0.5 * (low + high) : (high < 0.0 ? 0.0 : 1.0);
  const double t = vv > 0.0 ? unit_interval((s * u - r).dot(v) / vv) : 0.0;
  s = unit_interval((r + t * v).dot(u) / uu);
  return {s, t, true};
}

inline SegmentParameters closest_parameters(const Vector3& u, const Vector3& v, const Vector3& r,
                                            const Vector3& cross) noexcept {
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double area = cross.squaredNorm();
  if (!(area > kParallel * uu * vv)) {
    if (uu >= vv) {
      return parallel_parameters(u, v, r, uu, vv);
    }
    const SegmentParameters swapped = parallel_parameters(v, u, -r, vv, uu);
    return {swapped.t, swapped.s, true};
  }
  // Of the lines: by cross products, whose error is eps / sin(angle); the usual uu vv - uv^2 loses that squared.
  double s = unit_interval(r.cross(v).dot(cross) / area);
  double t = (s * u - r).dot(v) / vv;
  if (t < 0.0 || t > 1.0) {
    t = t < 0.0 ? 0.0 : 1.0;
    s = unit_interval((r + t * v).dot(u) / uu);
  }
  return {s, t, false};
}

/// Unit vector along cross = u x v. Of nearly parallel axes the product's error eps / sin(angle) is not perpendicular
/// to them; taken off along u, what is left of it acts on sin(angle) only.
inline Vector3 common_perpendicular(const Vector3& cross, const Vector3& u) noexcept {
  const Vector3 normal = cross.normalized();
  return (normal - u * (u.dot(normal) / u.squaredNorm())).normalized();
}

/// Any unit vector perpendicular to v; +x for the zero vector.
inline Vector3 any_perpendicular(const Vector3& v) noexcept {
  int smallest = 0;
  v.cwiseAbs().minCoeff(&smallest);
  const Vector3 perpendicular = v.cross(Vector3::Unit(smallest));
  const double length = perpendicular.norm();
  return length > 0.0 ? Vector3(perpendicular / length) : Vector3(Vector3::UnitX());
}

/// Where p + t d, t in [0, 1], is nearest to the box |x_i| <= h_i. Half the derivative of the squared distance,
/// sum d_i (x_i - clamp(x_i)), rises along t and is linear between six breaks: narrow to two breaks, then solve.
inline double closest_to_box(const Vector3& p, const Vector3& d, const Vector3& h) noexcept {
  const auto slope = [&](double t) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double x = p[i] + t * d[i];
      sum += d[i] * (x - std::min(std::max(x, -h[i]), h[i]));
    }
    return sum;
  };
  const double at_begin = slope(0.0);
  if (at_begin > 0.0) {
    return 0.0;
  }
  const double at_end = slope(1.0);
  if (at_end < 0.0) {
    return 1.0;
  }
  double low = 0.0;
  double high = 1.0;
  // Where the slope is exactly zero the distance is flat: its middle is taken.
  double flat_low = at_begin == 0.0 ? 0.0 : 2.0;
  double flat_high = at_end == 0.0 ? 1.0 : (at_begin == 0.0 ? 0.0 : -1.0);
  flat_low = at_end == 0.0 ? std::min(flat_low, 1.0) : flat_low;
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0.0) {
      continue;
    }
    const double inverse = 1.0 / d[i];
    for (const double bound : {-h[i], h[i]}) {
      const double t = (bound - p[i]) * inverse;
      if (!(t > low && t < high)) {
        continue;
      }
      const double value = slope(t);
      if (value < 0.0) {
        low = t;
      } else if (value > 0.0) {
        high = t;
      } else {
        flat_low = std::min(flat_low, t);
        flat_high = std::max(flat_high, t);
      }
    }
  }
  if (flat_low <= flat_high) {
    return 0.5 * (flat_low + flat_high);
  }
  const double middle = 0.5 * (low + high);
  double numerator = 0.0;
  double denominator = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double x = p[i] + middle * d[i];
    if (std::abs(x) > h[i]) {
      numerator += d[i] * (std::copysign(h[i], x) - p[i]);
      denominator += d[i] * d[i];
    }
  }
  return denominator > 0.0 ? std::min(std::max(numerator / denominator, low), high) : middle;
}

/// From the box |x_i| <= h_i to x.
inline Vector3 beyond_box(const Vector3& x, const Vector3& h) noexcept { return x - x.cwiseMax(-h).cwiseMin(h); }

}  // namespace saras::collision
