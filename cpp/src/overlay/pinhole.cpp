#include "saras/overlay/pinhole.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr double kRotationTolerance = 1e-4;  // calibration files are written with few digits
constexpr int kMostPixels = 16384;
constexpr int kBends = 6;              // halvings of a bent line: 64 pieces
constexpr double kFieldMargin = 1.05;  // of the field's radius beyond the image's corners
constexpr double kWidestField = 20.0;  // x/z; 87 degrees off the axis
constexpr double kFieldStep = 1e-3;    // in which the fold is looked for

std::string text(double value) { return std::to_string(value); }

void check_camera_matrix(const char* name, const Matrix3& k) {
  if (!k.allFinite() || !(k(0, 0) > 0.0) || !(k(1, 1) > 0.0)) {
    throw ConfigError(std::string(name) + ": fx = " + text(k(0, 0)) + ", fy = " + text(k(1, 1)) +
                      ": must be finite and > 0 (an uncalibrated camera has zeros)");
  }
  if (std::abs(k(0, 1)) > 1e-9 || std::abs(k(1, 0)) > 1e-9 || !k.row(2).isApprox(Eigen::RowVector3d(0, 0, 1), 1e-9)) {
    throw ConfigError(std::string(name) + ": must be [fx 0 cx; 0 fy cy; 0 0 1]");
  }
}

/// Shares of the segment where |a + s (b - a)| <= radius; false: nowhere.
bool clip_to_circle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius, double& from, double& to) {
  const Eigen::Vector2d d = b - a;
  const double dd = d.squaredNorm(), ad = a.dot(d), c = a.squaredNorm() - radius * radius;
  if (!(dd > 0.0)) {
    from = 0.0, to = 1.0;
    return c <= 0.0;
  }
  const double discriminant = ad * ad - dd * c;
  if (!(discriminant >= 0.0)) {
    return false;
  }
  const double root = std::sqrt(discriminant);
  from = std::max(0.0, (-ad - root) / dd);
  to = std::min(1.0, (-ad + root) / dd);
  return from <= to;
}

}  // namespace

void CameraConfig::validate() const {
  if (width_px < 1 || width_px > kMostPixels || height_px < 1 || height_px > kMostPixels) {
    throw ConfigError("width_px x height_px = " + std::to_string(width_px) + "x" + std::to_string(height_px) +
                      ": must be within 1 and " + std::to_string(kMostPixels));
  }
  check_camera_matrix("P", P.leftCols<3>());
  if (!P.col(3).allFinite() || std::abs(P(2, 3)) > 1e-9) {
    throw ConfigError("P: last column must be finite, its third number 0");
  }
  validate::positive("near_m", near_m);
  if (rectified) {
    return;  // K, R and the distortion are not used
  }
  check_camera_matrix("K", K);
  if (!R.allFinite() || !(R * R.transpose()).isIdentity(kRotationTolerance) || !(R.determinant() > 0.0)) {
    throw ConfigError("R: must be a rotation within " + text(kRotationTolerance));
  }
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    validate::finite(("distortion[" + std::to_string(i) + "]").c_str(), distortion[i]);
  }
}

PinholeEye::PinholeEye(const CameraConfig& config) : config_((config.validate(), config)) {
  const Matrix34& p = config_.P;
  shift_ = Vector3(p(0, 3) / p(0, 0), p(1, 3) / p(1, 1), 0.0);  // K'^-1 p4
  const Matrix3 k = config_.rectified ? Matrix3(p.leftCols<3>()) : config_.K;
  fx_ = k(0, 0), fy_ = k(1, 1), cx_ = k(0, 2), cy_ = k(1, 2);
  if (!config_.rectified) {
    eye_R_left_ = config_.R.transpose();
    bends_ = std::any_of(config_.distortion.begin(), config_.distortion.end(), [](double d) { return d != 0.0; });
  }
  find_field();
}

double PinholeEye::radial(double r2) const noexcept {
  const auto& d = config_.distortion;
  const double numerator = 1.0 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  return numerator / (1.0 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
}

PinholeEye::Normalised PinholeEye::distorted(const Normalised& s) const noexcept {
  const double x = s.x(), y = s.y(), r2 = s.squaredNorm(), factor = radial(r2);
  const double p1 = config_.distortion[2], p2 = config_.distortion[3];
  return {x * factor + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * factor + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

Pixel PinholeEye::pixel(const Normalised& straight) const noexcept {
  const Normalised n = bends_ ? distorted(straight) : straight;
  return {fx_ * n.x() + cx_, fy_ * n.y() + cy_};
}

// A polynomial lens model grows up to some radius and then folds back: what is far outside would reappear inside the
// image. The field ends there, or a little beyond the image's corners, whichever is nearer.
void PinholeEye::find_field() {
  if (!bends_) {
    field_radius_ = std::numeric_limits<double>::infinity();
    return;
  }
  const double w = config_.width_px, h = config_.height_px;
  double wanted = 0.0;
  for (const double u : {-0.5, w - 0.5}) {
    for (const double v : {-0.5, h - 0.5}) {
      wanted = std::max(wanted, std::hypot((u - cx_) / fx_, (v - cy_) / fy_));
    }
  }
  const double tangential = 4.0 * std::hypot(config_.distortion[2], config_.distortion[3]);
  double before = 0.0, last_wanted = kWidestField;
  for (int i = 1; i * kFieldStep <= last_wanted; ++i) {
    const double r = i * kFieldStep, bent = r * radial(r * r);
    if (!(bent > before)) {
      break;  // the fold
    }
    before = bent;
    field_radius_ = r;
    if (last_wanted == kWidestField && bent - tangential * r * r > wanted) {
      last_wanted = std::min(kFieldMargin * r, kWidestField);
    }
  }
}

bool PinholeEye::project(const Vector3& point, Pixel& result) const noexcept {
  const Vector3 p = to_eye(point);
  if (!(p.z() >= config_.near_m) || !p.allFinite()) {
    return false;
  }
  const Normalised straight(p.x() / p.z(), p.y() / p.z());
  if (!(straight.norm() <= field_radius_)) {
    return false;
  }
  result = pixel(straight);
  return true;
}

ProjectedLine PinholeEye::project_line(const Vector3& a, const Vector3& b, double margin_px) const noexcept {
  ProjectedLine line;
  Vector3 p = to_eye(a), q = to_eye(b);
  const double near = config_.near_m;
  if (!p.allFinite() || !q.allFinite() || (p.z() < near && q.z() < near)) {
    return line;
  }
  const auto at_near_plane = [near](const Vector3& before, const Vector3& beyond) -> Vector3 {
    const double share = (near - before.z()) / (beyond.z() - before.z());
    Vector3 clipped = before + share * (beyond - before);
    clipped.z() = near;
    return clipped;
  };
  if (p.z() < near) {
    p = at_near_plane(p, q);
  } else if (q.z() < near) {
    q = at_near_plane(q, p);
  }
  if (bends_) {
    bend(p, q, margin_px, line);
  } else {
    clip_and_add({pixel({p.x() / p.z(), p.y() / p.z()}), pixel({q.x() / q.z(), q.y() / q.z()}), p.z(), q.z()},
                 margin_px, line);
  }
  return line;
}

// A straight line in space is straight in x/z, y/z; the lens bends it. Halved until each piece is straight enough.
void PinholeEye::bend(const Vector3& p, const Vector3& q, double margin_px, ProjectedLine& line) const noexcept {
  const Normalised a(p.x() / p.z(), p.y() / p.z()), b(q.x() / q.z(), q.y() / q.z());
  double from = 0.0, to = 1.0;
  if (!clip_to_circle(a, b, field_radius_, from, to)) {
    return;
  }
  const double inverse_a = 1.0 / p.z(), inverse_b = 1.0 / q.z();
  const auto at = [&](double s) -> Normalised { return a + s * (b - a); };
  const auto depth_at = [&](double s) { return 1.0 / (inverse_a + s * (inverse_b - inverse_a)); };
  struct Stretch {
    double from, to;
    int level;
  };
  std::array<Stretch, kBends + 2> stack;
  std::size_t waiting = 0;
  stack[waiting++] = {from, to, 0};
  while (waiting > 0) {
    const Stretch s = stack[--waiting];
    const double middle = 0.5 * (s.from + s.to);
    const Pixel begin = pixel(at(s.from)), end = pixel(at(s.to));
    // At the middle and at both quarters: an S-shaped stretch passes through the middle of its chord.
    double off = 0.0;
    for (const double share : {0.25, 0.5, 0.75}) {
      const Pixel on_chord = begin + share * (end - begin);
      off = std::max(off, (pixel(at(s.from + share * (s.to - s.from))) - on_chord).norm());
    }
    if (off > kStraightTolerance_px && s.level < kBends) {
      stack[waiting++] = {middle, s.to, s.level + 1};
      stack[waiting++] = {s.from, middle, s.level + 1};
    } else {
      clip_and_add({begin, end, depth_at(s.from), depth_at(s.to)}, margin_px, line);
    }
  }
}

void PinholeEye::clip_and_add(LinePiece piece, double margin_px, ProjectedLine& line) const noexcept {
  if (line.count == kMaxLinePieces) {
    return;
  }
  const Pixel low = Pixel::Constant(-0.5 - margin_px);
  const Pixel high(config_.width_px - 0.5 + margin_px, config_.height_px - 0.5 + margin_px);
  double from = 0.0, to = 1.0;
  if (!clip_to_rectangle(piece.a, piece.b, low, high, from, to)) {
    return;
  }
  const Pixel a = piece.a, along = piece.b - piece.a;
  const double inverse_a = 1.0 / piece.depth_a_m, slope = 1.0 / piece.depth_b_m - inverse_a;
  piece.a = a + from * along, piece.b = a + to * along;
  piece.depth_a_m = 1.0 / (inverse_a + from * slope);
  piece.depth_b_m = 1.0 / (inverse_a + to * slope);
  line.pieces[static_cast<std::size_t>(line.count++)] = piece;
}

bool clip_to_rectangle(const Pixel& a, const Pixel& b, const Pixel& low, const Pixel& high, double& from,
                       double& to) noexcept {
  if (!a.allFinite() || !b.allFinite()) {
    return false;
  }
  const Pixel along = b - a;
  from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    if (along[axis] == 0.0) {
      if (a[axis] < low[axis] || a[axis] > high[axis]) {
        return false;
      }
      continue;
    }
    const double enter = ((along[axis] > 0.0 ? low : high)[axis] - a[axis]) / along[axis];
    const double leave = ((along[axis] > 0.0 ? high : low)[axis] - a[axis]) / along[axis];
    from = std::max(from, enter);
    to = std::min(to, leave);
  }
  return from <= to;
}

}  // namespace saras
