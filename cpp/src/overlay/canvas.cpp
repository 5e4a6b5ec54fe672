#include "saras/overlay/canvas.hpp"

#include <algorithm>
#include <cmath>

namespace saras {
namespace {

constexpr double kFarthest_px = 1e6;

/// Columns of one row that are within `radius` of a segment: an interval, as the set is convex.
struct Interval {
  double low = 1e9;
  double high = -1e9;
  void add(double from, double to) noexcept {
    low = std::min(low, from);
    high = std::max(high, to);
  }
};

/// A segment a - b, prepared for row after row.
class Capsule2 {
 public:
  Capsule2(const Pixel& a, const Pixel& b) noexcept : a_(a), b_(b), along_(b - a), length_(along_.norm()) {
    if (length_ > 0.0) {
      along_ /= length_;
    }
  }

  Interval row(double y, double radius) const noexcept {
    Interval found;
    if (radius <= 0.0) {
      return found;
    }
    end(a_, y, radius, found);
    end(b_, y, radius, found);
    if (length_ > 0.0) {
      // |n . (p - a)| <= radius and 0 <= d . (p - a) <= length, with d along and n across the segment.
      double low = -1e9, high = 1e9;
      const double dy = y - a_.y();
      if (limit(-along_.y(), along_.x() * dy, -radius, radius, low, high) &&
          limit(along_.x(), along_.y() * dy, 0.0, length_, low, high) && low <= high) {
        found.add(a_.x() + low, a_.x() + high);
      }
    }
    return found;
  }

  double distance(double x, double y) const noexcept {
    const double dx = x - a_.x(), dy = y - a_.y();
    const double s = std::clamp(dx * along_.x() + dy * along_.y(), 0.0, length_);
    const double ex = dx - s * along_.x(), ey = dy - s * along_.y();
    return std::sqrt(ex * ex + ey * ey);
  }

 private:
  static void end(const Pixel& center, double y, double radius, Interval& found) noexcept {
    const double dy = y - center.y(), square = radius * radius - dy * dy;
    if (square >= 0.0) {
      const double half = std::sqrt(square);
      found.add(center.x() - half, center.x() + half);
    }
  }
  /// lowest <= factor x + offset <= highest
  static bool limit(double factor, double offset, double lowest, double highest, double& low, double& high) noexcept {
    if (std::abs(factor) < 1e-12) {
      return lowest <= offset && offset <= highest;
    }
    const double from = (lowest - offset) / factor, to = (highest - offset) / factor;
    low = std::max(low, std::min(from, to));
    high = std::min(high, std::max(from, to));
    return true;
  }

  Pixel a_, b_, along_;
  double length_;
};

template <int kChannels>
void fill(std::uint8_t* pixel, int count, const PixelBytes& color) noexcept {
  for (int i = 0; i < count; ++i, pixel += kChannels) {
    for (int c = 0; c < kChannels; ++c) {
      pixel[c] = color.byte[c];
    }
  }
}

template <int kChannels>
void draw(const ImageView& image, const Pixel& a, const Pixel& b, double radius, const PixelBytes& color) noexcept {
  const Capsule2 line(a, b);
  const double outer = radius + 0.5, inner = radius - 0.5;
  const int top = std::max(0, static_cast<int>(std::ceil(std::min(a.y(), b.y()) - outer)));
  const int bottom = std::min(image.height - 1, static_cast<int>(std::floor(std::max(a.y(), b.y()) + outer)));
  for (int y = top; y <= bottom; ++y) {
    const Interval touched = line.row(y, outer);
    const int first = std::max(0, static_cast<int>(std::ceil(std::max(touched.low, -1.0))));
    const int last = static_cast<int>(std::floor(std::min(touched.high, static_cast<double>(image.width - 1))));
    if (first > last) {
      continue;
    }
    const Interval full = line.row(y, inner);
    int solid = last + 1, solid_end = last + 1;  // [solid, solid_end)
    if (full.low <= full.high) {
      solid = std::clamp(static_cast<int>(std::ceil(std::max(full.low, -1.0))), first, last + 1);
      solid_end = std::clamp(static_cast<int>(std::floor(std::min(full.high, 1e6))) + 1, solid, last + 1);
    }
    std::uint8_t* const row = image.data + static_cast<std::size_t>(y) * image.stride;
    const auto edge = [&](int from, int to) {
      for (int x = from; x < to; ++x) {
        const double coverage = std::clamp(outer - line.distance(x, y), 0.0, 1.0);
        blend(row + static_cast<std::ptrdiff_t>(x) * kChannels, kChannels, color, static_cast<int>(255.0 * coverage));
      }
    };
    edge(first, solid);
    fill<kChannels>(row + static_cast<std::ptrdiff_t>(solid) * kChannels, solid_end - solid, color);
    edge(solid_end, last + 1);
  }
}

}  // namespace

void draw_line(const ImageView& image, const Pixel& a, const Pixel& b, double radius_px, Color color) noexcept {
  const auto near = [](double x) { return std::abs(x) <= kFarthest_px; };  // no NaN is
  const bool usable =
      near(a.x()) && near(a.y()) && near(b.x()) && near(b.y()) && radius_px > 0.0 && radius_px <= kFarthest_px;
  if (!usable || image.data == nullptr) {
    return;
  }
  const PixelBytes bytes = bytes_of(color, image.format);
  switch (channels(image.format)) {
    case 1:
      return draw<1>(image, a, b, radius_px, bytes);
    case 4:
      return draw<4>(image, a, b, radius_px, bytes);
    default:
      return draw<3>(image, a, b, radius_px, bytes);
  }
}

void darken(const ImageView& image, int x, int y, int width, int height, int share) noexcept {
  const int n = channels(image.format), left = std::clamp(x, 0, image.width);
  const int right = std::clamp(x + width, left, image.width), top = std::max(0, y);
  const int bottom = std::min(image.height, y + height);
  for (int v = top; v < bottom; ++v) {
    std::uint8_t* const row = image.data + static_cast<std::size_t>(v) * image.stride;
    for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(left) * n; i < static_cast<std::ptrdiff_t>(right) * n; ++i) {
      if (n < 4 || i % 4 != 3) {
        row[i] = static_cast<std::uint8_t>(row[i] * share / 256);
      }
    }
  }
}

}  // namespace saras
