#include "saras/overlay/awareness_inset.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr int kDarkened = 70;  // of 256
constexpr int kGridLines = 7;
constexpr double kReferenceWidth_px = 200.0;
constexpr Color kGrid{70, 110, 150, 90};
constexpr Color kWhite{255, 255, 255, 255};
constexpr Color kGreen{40, 217, 80, 235};
constexpr Color kRed{255, 38, 26, 200};
constexpr Color kYellow{255, 214, 0, 185};
constexpr Color kGrey{160, 160, 160, 120};
constexpr Color kHold{255, 140, 0, 220};

ImageView part_of(const ImageView& image, int left, int top, int width, int height) noexcept {
  ImageView part = image;
  part.data += static_cast<std::size_t>(top) * image.stride + static_cast<std::size_t>(left * channels(image.format));
  part.width = width;
  part.height = height;
  return part;
}

AwarenessInsetStyle validated(const AwarenessInsetStyle& style) {
  style.validate();
  return style;
}

int checked(const char* name, int size) {
  validate::in_range(name, size, 64, 100000);
  return size;
}

}  // namespace

Color stiffness_color(double share) noexcept {
  if (!std::isfinite(share)) {
    return {110, 110, 110, 90};
  }
  constexpr std::array<std::array<double, 3>, 3> kRamp = {{{68, 1, 84}, {33, 145, 140}, {253, 231, 37}}};
  const double at = 2.0 * std::clamp(share, 0.0, 1.0);
  const std::size_t below = at < 1.0 ? 0 : 1;
  const double part = at - static_cast<double>(below);
  std::array<std::uint8_t, 3> rgb = {};
  for (std::size_t c = 0; c < 3; ++c) {
    rgb[c] = static_cast<std::uint8_t>(std::lround(kRamp[below][c] + part * (kRamp[below + 1][c] - kRamp[below][c])));
  }
  return {rgb[0], rgb[1], rgb[2], static_cast<std::uint8_t>(std::lround(60.0 + 90.0 * at))};
}

void AwarenessInsetStyle::validate() const {
  validate::in_range("width", width, 0.1, 0.5);
  validate::positive("span_m", span_m);
  validate::in_range("azimuth_rad", azimuth_rad, -2.0 * M_PI, 2.0 * M_PI);
  validate::in_range("elevation_rad", elevation_rad, 0.05, 1.5);
  validate::positive("arrow_m_per_N", arrow_m_per_N);
  validate::not_negative("least_force_N", least_force_N);
}

AwarenessInset::AwarenessInset(int width_px, int height_px, const AwarenessInsetStyle& style)
    : style_(validated(style)),
      image_width_(checked("width_px", width_px)),
      image_height_(checked("height_px", height_px)),
      left_(0),
      top_(0),
      width_(static_cast<int>(std::lround(style_.width * width_px))),
      height_(std::min(static_cast<int>(std::lround(0.75 * width_)), height_px)),
      scale_(width_ / kReferenceWidth_px),
      font_(std::clamp(static_cast<int>(std::lround(0.048 * width_)), 6, 60)) {
  top_ = image_height_ - height_;
  const double ca = std::cos(style_.azimuth_rad), sa = std::sin(style_.azimuth_rad);
  const double ce = std::cos(style_.elevation_rad), se = std::sin(style_.elevation_rad);
  const Vector3 towards_viewer(ca * ce, sa * ce, se);
  right_ = Vector3(-sa, ca, 0.0);
  up_ = towards_viewer.cross(right_);
}

Pixel AwarenessInset::place(const AwarenessView& view, const Vector3& point) const noexcept {
  const Vector3 from = point - view.center;
  const double px_per_m = width_ / style_.span_m;
  // A little below the middle: the text stands above.
  return {0.5 * width_ + px_per_m * right_.dot(from), 0.58 * height_ - px_per_m * up_.dot(from)};
}

void AwarenessInset::draw_model(const AwarenessView& view, const ImageView& box) const noexcept {
  if (!view.closest.allFinite() || !view.normal.allFinite() || view.normal.norm() < 0.5) {
    return;
  }
  const Vector3 n = view.normal.normalized();
  const Vector3 foot = view.center - n * n.dot(view.center - view.closest);
  const Vector3 x = n.unitOrthogonal(), y = n.cross(x);
  const double half = 0.36 * style_.span_m;
  for (int i = 0; i < kGridLines; ++i) {
    const double at = half * (2.0 * i / (kGridLines - 1) - 1.0);
    draw_line(box, place(view, foot + at * x - half * y), place(view, foot + at * x + half * y), 0.5 * scale_, kGrid);
    draw_line(box, place(view, foot + at * y - half * x), place(view, foot + at * y + half * x), 0.5 * scale_, kGrid);
  }
}

void AwarenessInset::draw_dots(const AwarenessView& view, const ImageView& box) const noexcept {
  for (int i = 0; view.dots != nullptr && i < view.dot_count; ++i) {
    draw_point(view, view.dots[i].at, 1.1, stiffness_color(view.dots[i].share), box);
  }
}

void AwarenessInset::draw_region(const AwarenessView& view, const ImageView& box) const noexcept {
  const int count = std::clamp(view.region_corners, 0, kMaxRegionCorners);
  for (int i = 0; i < count; ++i) {
    const Vector3& here = view.region[static_cast<std::size_t>(i)];
    draw_point(view, here, 1.8, kYellow, box);
    const bool last = i + 1 == count;
    if (last && !view.region_closed) {
      break;
    }
    const Vector3& next = view.region[static_cast<std::size_t>(last ? 0 : i + 1)];
    if (here.allFinite() && next.allFinite()) {
      draw_line(box, place(view, here), place(view, next), 0.8 * scale_, kYellow);
    }
  }
}

void AwarenessInset::draw_force(const AwarenessView& view, const ImageView& box) const noexcept {
  if (!view.closest.allFinite() || !view.force_N.allFinite() || view.force_N.norm() < style_.least_force_N) {
    return;
  }
  const Pixel from = place(view, view.closest);
  const Pixel to = place(view, view.closest + style_.arrow_m_per_N * view.force_N);
  draw_line(box, from, to, 1.3 * scale_, kRed);
  const Pixel along = to - from;
  if (along.norm() > 1e-6) {
    const Pixel u = along.normalized(), across(-u.y(), u.x());
    const double size = 5.0 * scale_;
    draw_line(box, to, to - size * u + 0.6 * size * across, 1.3 * scale_, kRed);
    draw_line(box, to, to - size * u - 0.6 * size * across, 1.3 * scale_, kRed);
  }
}

void AwarenessInset::draw_point(const AwarenessView& view, const Vector3& point, double radius_px, Color color,
                                const ImageView& box) const noexcept {
  if (point.allFinite()) {
    draw_disc(box, place(view, point), radius_px * scale_, color);
  }
}

bool AwarenessInset::draw(const AwarenessView& view, const ImageView& image) const noexcept {
  if (image.data == nullptr || image.width != image_width_ || image.height != image_height_) {
    return false;
  }
  darken(image, left_, top_, width_, height_, kDarkened);
  const ImageView box = part_of(image, left_, top_, width_, height_);
  const int margin = font_.height() / 2;
  if (!view.known || !view.center.allFinite()) {
    font_.draw(box, margin, margin, view.text.empty() ? "?" : view.text.view(), kGrey);
    return true;
  }
  if (view.dot_count > 0) {
    draw_dots(view, box);
  } else {
    draw_model(view, box);
  }
  draw_region(view, box);
  draw_point(view, view.tip, 3.2, kWhite, box);
  draw_force(view, box);
  draw_point(view, view.closest, 2.8, kRed, box);
  draw_point(view, view.proxy, 3.6, kGreen, box);
  font_.draw(box, margin, margin, view.text.view(), view.hold ? kHold : kWhite);
  return true;
}

}  // namespace saras
