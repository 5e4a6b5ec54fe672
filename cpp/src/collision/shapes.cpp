#include "saras/collision/shapes.hpp"

#include <cmath>
#include <cstdio>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

/// Cosine between two edges up to which they count as perpendicular: an error of 1e-12 of the size.
constexpr double kRightAngle = 1e-12;
constexpr std::array<const char*, 3> kEdgeNames = {"x = v1 - v0", "y = v4 - v0", "z = v3 - v0"};

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof(buffer), "%g", value);
  return buffer;
}

}  // namespace

Parallelepiped::Parallelepiped(const Vector3& corner, const Vector3& x, const Vector3& y, const Vector3& z) {
  validate::finite("v0", corner);
  for (int i = 0; i < 3; ++i) {
    validate::in_range("v0", corner[i], -kGreatestCoordinate, kGreatestCoordinate);
  }
  const std::array<Vector3, 3> edges = {x, y, z};
  for (std::size_t i = 0; i < 3; ++i) {
    validate::finite(kEdgeNames.at(i), edges.at(i));
    const double length = edges.at(i).norm();
    if (!(length >= kLeastEdge && length <= kGreatestCoordinate)) {
      throw ConfigError(std::string("length of ") + kEdgeNames.at(i) + " = " + text(length) + " m: must be in [" +
                        text(kLeastEdge) + ", " + text(kGreatestCoordinate) + "] m (zero volume)");
    }
  }
  const double relative = std::abs(x.normalized().dot(y.normalized().cross(z.normalized())));
  if (!(relative >= kLeastRelativeVolume)) {
    throw ConfigError("volume / product of the edge lengths = " + text(relative) + ": must be at least " +
                      text(kLeastRelativeVolume) + " (zero volume)");
  }
  center_ = corner + 0.5 * (x + y + z);
  half_edges_ = {0.5 * x, 0.5 * y, 0.5 * z};
  const auto perpendicular = [](const Vector3& a, const Vector3& b) {
    return std::abs(a.dot(b)) <= kRightAngle * a.norm() * b.norm();
  };
  rectangular_ = perpendicular(x, y) && perpendicular(y, z) && perpendicular(z, x);
  finish();
}

Parallelepiped Parallelepiped::from_corners(const Corners& v) {
  for (std::size_t i = 0; i < v.size(); ++i) {
    validate::finite(("v" + std::to_string(i)).c_str(), v.at(i));
  }
  Parallelepiped shape(v[0], v[1] - v[0], v[4] - v[0], v[3] - v[0]);
  const Corners wanted = shape.corners();
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double off = (v.at(i) - wanted.at(i)).norm();
    if (!(off <= kClosingTolerance)) {
      throw ConfigError("v" + std::to_string(i) + " is " + text(off) +
                        " m from where v0, v1, v3 and v4 put it: must be at most " + text(kClosingTolerance) +
                        " m (does not close)");
    }
  }
  return shape;
}

void Parallelepiped::finish() noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    face_normals_[i] = rectangular_ ? half_edges_[i].normalized() : half_edges_[j].cross(half_edges_[k]).normalized();
    if (face_normals_[i].dot(half_edges_[i]) < 0.0) {
      face_normals_[i] = -face_normals_[i];
    }
    half_widths_[static_cast<int>(i)] = face_normals_[i].dot(half_edges_[i]);
  }
  magnitude_ =
      center_.lpNorm<1>() + half_edges_[0].lpNorm<1>() + half_edges_[1].lpNorm<1>() + half_edges_[2].lpNorm<1>();
}

Corners Parallelepiped::corners() const {
  const auto corner = [this](double x, double y, double z) -> Vector3 {
    return center_ + x * half_edges_[0] + y * half_edges_[1] + z * half_edges_[2];
  };
  return {corner(-1, -1, -1), corner(1, -1, -1), corner(1, -1, 1), corner(-1, -1, 1),
          corner(-1, 1, -1),  corner(1, 1, -1),  corner(1, 1, 1),  corner(-1, 1, 1)};
}

double Parallelepiped::volume() const {
  return 8.0 * std::abs(half_edges_[0].dot(half_edges_[1].cross(half_edges_[2])));
}

Parallelepiped Parallelepiped::moved(const Pose& a_T_b) const noexcept {
  Parallelepiped shape;
  shape.rectangular_ = rectangular_;
  shape.center_ = a_T_b * center_;
  for (std::size_t i = 0; i < 3; ++i) {
    shape.half_edges_[i] = a_T_b.rotation * half_edges_[i];
  }
  shape.finish();
  return shape;
}

}  // namespace saras
