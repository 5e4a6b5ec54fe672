#include "saras/collision/distance.hpp"

#include "segments.hpp"

namespace saras {
namespace {

using namespace collision;

/// Sum of the magnitudes of all coordinates: not finite when one of them is not.
double magnitude(const Capsule& capsule) noexcept {
  return capsule.a.lpNorm<1>() + capsule.b.lpNorm<1>() + capsule.radius_m;
}

bool is_usable(double magnitude, double radius_m) noexcept { return std::isfinite(magnitude) && radius_m >= 0.0; }

/// From the nearest points of axis and other shape, `gap` apart along `normal` (gap < 0: overlapping).
SignedDistance finish(const Vector3& axis_point, const Vector3& normal, double gap, double radius_a, double radius_b,
                      double tolerance) noexcept {
  SignedDistance result;
  result.distance_m = gap - radius_a - radius_b;
  if (!std::isfinite(result.distance_m)) {  // finite input of absurd size overflowed
    return {};
  }
  result.normal = normal;
  result.point_a = axis_point + radius_a * normal;
  result.point_b = axis_point + (gap - radius_b) * normal;
  result.status = result.distance_m > tolerance    ? DistanceStatus::kSeparated
                  : result.distance_m < -tolerance ? DistanceStatus::kPenetrating
                                                   : DistanceStatus::kTouching;
  return result;
}

/// Least translation that frees the axis from the box: along `normal` backwards, by `depth`.
struct Depth {
  double depth;
  Vector3 normal;
};

Depth depth_of_axis(const Vector3& a, const Vector3& b, const Parallelepiped& box) noexcept {
  const Vector3 half_axis = 0.5 * (b - a);
  const Vector3 offset = 0.5 * (a + b) - box.center();
  Depth best{std::numeric_limits<double>::infinity(), Vector3::Zero()};
  const auto consider = [&](const Vector3& normal, double reach) {
    const double side = normal.dot(offset);
    const double depth = reach - std::abs(side);
    if (depth < best.depth) {
      best = {depth, side > 0.0 ? Vector3(-normal) : normal};
    }
  };
  for (int i = 0; i < 3; ++i) {
    consider(box.face_normal(i), box.half_width(i) + std::abs(box.face_normal(i).dot(half_axis)));
  }
  for (int i = 0; i < 3; ++i) {
    const Vector3 cross = box.half_edge(i).cross(half_axis);
    const double area = cross.squaredNorm();
    if (area > kParallel * box.half_edge(i).squaredNorm() * half_axis.squaredNorm()) {
      const Vector3 normal = common_perpendicular(cross, box.half_edge(i));
      consider(normal,
               std::abs(normal.dot(box.half_edge((i + 1) % 3))) + std::abs(normal.dot(box.half_edge((i + 2) % 3))));
    }
  }
  return best;
}

/// Nearest point of the axis, and the vector from there to the box.
struct Gap {
  Vector3 axis_point;
  Vector3 to_box;
};

Gap gap_to_rectangular(const Vector3& a, const Vector3& b, const Parallelepiped& box) noexcept {
  Eigen::Matrix3d axes;
  axes << box.face_normal(0), box.face_normal(1), box.face_normal(2);
  const Vector3 p = axes.transpose() * (a - box.center());
  const Vector3 d = axes.transpose() * (b - a);
  const double t = closest_to_box(p, d, box.half_widths());
  return {a + t * (b - a), axes * -beyond_box(p + t * d, box.half_widths())};
}

/// Whether a point of the axis lies in the box: clips against the three pairs of planes.
bool enters(const Vector3& a, const Vector3& b, const Parallelepiped& box) noexcept {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 3; ++i) {
    const double begin = box.face_normal(i).dot(a - box.center());
    const double slope = box.face_normal(i).dot(b - a);
    const double width = box.half_width(i);
    if (slope == 0.0) {
      if (std::abs(begin) > width) {
        return false;
      }
      continue;
    }
    const double first = (-width - begin) / slope;
    const double second = (width - begin) / slope;
    low = std::max(low, std::min(first, second));
    high = std::min(high, std::max(first, second));
  }
  return low <= high;
}

/// Ends of the axis against faces. The foot must lie on the face.
void ends_to_faces(const Vector3& end, const Parallelepiped& box, double& least, Gap& gap) noexcept {
  Vector3 across;
  for (int i = 0; i < 3; ++i) {
    across[i] = box.face_normal(i).dot(end - box.center());
  }
  for (int i = 0; i < 3; ++i) {
    const double beyond = std::abs(across[i]) - box.half_width(i);
    if (!(beyond > 0.0 && beyond * beyond < least)) {
      continue;
    }
    const Vector3 to_box = -std::copysign(beyond, across[i]) * box.face_normal(i);
    bool on_face = true;
    for (int j = 0; j < 3; ++j) {
      on_face = on_face && (j == i || std::abs(across[j] + box.face_normal(j).dot(to_box)) <= box.half_width(j));
    }
    if (on_face) {
      least = beyond * beyond;
      gap = {end, to_box};
    }
  }
}

/// For an axis that does not enter the box.
Gap gap_to_skewed(const Vector3& a, const Vector3& b, const Parallelepiped& box) noexcept {
  double least = std::numeric_limits<double>::infinity();
  Gap gap{a, box.center() - a};
  ends_to_faces(a, box, least, gap);
  ends_to_faces(b, box, least, gap);
  // beyond[i][s]: some of the axis is outside of that face. An edge between two faces that see nothing of the axis
  // cannot hold the closest point.
  std::array<std::array<bool, 2>, 3> beyond{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int k = static_cast<int>(i);
    const double at_a = box.face_normal(k).dot(a - box.center());
    const double at_b = box.face_normal(k).dot(b - box.center());
    beyond[i] = {std::min(at_a, at_b) < -box.half_width(k), std::max(at_a, at_b) > box.half_width(k)};
  }
  const Vector3 u = b - a;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const Vector3& half = box.half_edge(static_cast<int>(i));
    const Vector3 v = 2.0 * half;
    const Vector3 cross = u.cross(v);
    for (const std::size_t on_j : {0u, 1u}) {
      for (const std::size_t on_k : {0u, 1u}) {
        if (!beyond[j][on_j] && !beyond[k][on_k]) {
          continue;
        }
        const Vector3 begin = box.center() - half + (on_j ? 1.0 : -1.0) * box.half_edge(static_cast<int>(j)) +
                              (on_k ? 1.0 : -1.0) * box.half_edge(static_cast<int>(k));
        const Vector3 r = begin - a;
        const SegmentParameters at = closest_parameters(u, v, r, cross);
        const Vector3 to_box = r + at.t * v - at.s * u;
        if (to_box.squaredNorm() < least) {
          least = to_box.squaredNorm();
          gap = {a + at.s * u, to_box};
        }
      }
    }
  }
  return gap;
}

}  // namespace

const char* to_string(DistanceStatus status) noexcept {
  switch (status) {
    case DistanceStatus::kSeparated:
      return "SEPARATED";
    case DistanceStatus::kTouching:
      return "TOUCHING";
    case DistanceStatus::kPenetrating:
      return "PENETRATING";
    case DistanceStatus::kUnknown:
      break;
  }
  return "UNKNOWN";
}

SegmentPair closest_points(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1) noexcept {
  const Vector3 u = a1 - a0;
  const Vector3 v = b1 - b0;
  const SegmentParameters at = closest_parameters(u, v, b0 - a0, u.cross(v));
  return {a0 + at.s * u, b0 + at.t * v};
}

SignedDistance distance(const Capsule& a, const Capsule& b) noexcept {
  const double scale = magnitude(a) + magnitude(b);
  if (!is_usable(scale, std::min(a.radius_m, b.radius_m))) {
    return {};
  }
  const double tolerance = kRelative * scale;
  const Vector3 u = a.b - a.a;
  const Vector3 v = b.b - b.a;
  const Vector3 r = b.a - a.a;
  const Vector3 cross = u.cross(v);
  const SegmentParameters at = closest_parameters(u, v, r, cross);
  const Vector3 between = r + at.t * v - at.s * u;
  const double gap = between.norm();
  Vector3 normal;
  if (gap > kNoDirection * scale) {
    normal = between / gap;
  } else if (!at.parallel) {
    normal = common_perpendicular(cross, u);
  } else {
    normal = any_perpendicular(u.squaredNorm() >= v.squaredNorm() ? u : v);
  }
  return finish(a.a + at.s * u, normal, gap, a.radius_m, b.radius_m, tolerance);
}

SignedDistance distance(const Capsule& a, const Parallelepiped& b) noexcept {
  const double scale = magnitude(a) + b.magnitude();
  if (!is_usable(scale, a.radius_m)) {
    return {};
  }
  const double tolerance = kRelative * scale;
  if (b.rectangular() || !enters(a.a, a.b, b)) {
    const Gap gap = b.rectangular() ? gap_to_rectangular(a.a, a.b, b) : gap_to_skewed(a.a, a.b, b);
    const double length = gap.to_box.norm();
    if (length > kNoDirection * scale) {
      return finish(gap.axis_point, gap.to_box / length, length, a.radius_m, 0.0, tolerance);
    }
  }
  const Depth depth = depth_of_axis(a.a, a.b, b);
  // Freed by that translation the axis touches the box: there are the witnesses. A hair more, so that rounding does
  // not leave it inside, where features have no nearest points.
  const Vector3 back = -(depth.depth + 10.0 * tolerance) * depth.normal;
  const Vector3 freed_a = a.a + back;
  const Vector3 freed_b = a.b + back;
  const Gap touch = b.rectangular() ? gap_to_rectangular(freed_a, freed_b, b) : gap_to_skewed(freed_a, freed_b, b);
  return finish(touch.axis_point - back, depth.normal, -depth.depth, a.radius_m, 0.0, tolerance);
}

}  // namespace saras
