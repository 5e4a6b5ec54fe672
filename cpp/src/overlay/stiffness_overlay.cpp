#include "saras/overlay/stiffness_overlay.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "saras/overlay/awareness_inset.hpp"  // stiffness_color
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr int kLevels = 256;
constexpr int kBarSteps = 3;   // numbers beside the bar
constexpr int kDarkened = 90;  // of 256
constexpr double kFarthest_px = 1e6;
constexpr double kLeastArea_px = 1e-9;
constexpr Color kWhite{255, 255, 255, 255};
constexpr Color kNotice{255, 140, 0, 220};
constexpr const char* kUnknownText = "STIFFNESS MAP ?";

StiffnessOverlayStyle validated(const StiffnessOverlayStyle& style) {
  style.validate();
  return style;
}

int font_height(const CameraConfig& camera) { return std::clamp(camera.height_px / 34, 6, 60); }

/// Colours of all levels in the bytes of a format; the last one is that of what is not known.
std::array<PixelBytes, kLevels + 1> palette(PixelFormat format) noexcept {
  std::array<PixelBytes, kLevels + 1> colors;
  for (int i = 0; i < kLevels; ++i) {
    colors[static_cast<std::size_t>(i)] = bytes_of(stiffness_color(i / (kLevels - 1.0)), format);
  }
  colors[kLevels] = bytes_of(stiffness_color(std::numeric_limits<double>::quiet_NaN()), format);
  return colors;
}

ShortText number(double value) noexcept {
  std::array<char, 24> digits = {};
  const int size = std::snprintf(digits.data(), digits.size(), "%.0f", value);
  return ShortText(std::string_view(digits.data(), static_cast<std::size_t>(std::clamp(size, 0, 23))));
}

ShortText widest_number(const StiffnessOverlayStyle& style) noexcept {
  ShortText high = number(style.high_N_m), unsure = number(style.uncertain_std_N_m);
  return high.view().size() < unsure.view().size() ? unsure : high;
}

}  // namespace

void StiffnessOverlayStyle::validate() const {
  validate::not_negative("low_N_m", low_N_m);
  validate::positive("high_N_m", high_N_m);
  validate::positive("high_N_m - low_N_m", high_N_m - low_N_m);
  validate::positive("opacity", opacity);
  validate::in_range("opacity", opacity, 0.0, 1.0);
  validate::positive("uncertain_std_N_m", uncertain_std_N_m);
  validate::in_range("faint_opacity", faint_opacity, 0.0, opacity);
}

StiffnessOverlay::StiffnessOverlay(const CameraConfig& camera, const StiffnessOverlayStyle& style)
    : eye_(camera),
      style_(validated(style)),
      font_(font_height(camera)),
      corners_(static_cast<std::size_t>(kMaxMapVertices)),
      cells_(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px)) {
  bar_width_ = 2 * font_.height();
  bar_height_ = static_cast<int>(std::lround(0.4 * camera.height_px));
  bar_left_ = camera.width_px - bar_width_ - font_.width(widest_number(style_).view()) - 2 * (font_.height() / 2);
  bar_top_ = static_cast<int>(std::lround(0.3 * camera.height_px));
}

bool StiffnessOverlay::fits(const ImageView& image) const noexcept {
  const CameraConfig& camera = eye_.config();
  return image.data != nullptr && image.width == camera.width_px && image.height == camera.height_px;
}

bool StiffnessOverlay::draw(const StiffnessMapView& map, const ImageView& image) noexcept {
  if (!fits(image) || map.vertex_count < 0 || map.vertex_count > kMaxMapVertices) {
    return false;
  }
  project(map);
  const CameraConfig& camera = eye_.config();
  touched_ = {camera.width_px, camera.height_px, -1, -1};
  const auto is_vertex = [&map](int i) { return i >= 0 && i < map.vertex_count; };
  for (int i = 0; i < map.triangle_count; ++i) {
    const MapTriangle& t = map.triangles[i];
    if (is_vertex(t[0]) && is_vertex(t[1]) && is_vertex(t[2])) {
      fill(corners_[static_cast<std::size_t>(t[0])], corners_[static_cast<std::size_t>(t[1])],
           corners_[static_cast<std::size_t>(t[2])]);
    }
  }
  blend_and_clear(image);
  if (style_.bar) {
    draw_bar(image);
  }
  return true;
}

void StiffnessOverlay::project(const StiffnessMapView& map) noexcept {
  for (int i = 0; i < map.vertex_count; ++i) {
    const MapVertex& vertex = map.vertices[i];
    Corner& corner = corners_[static_cast<std::size_t>(i)];
    corner = {};
    const Vector3 seen = map.left_T_map * vertex.at;
    Pixel pixel;
    if (!eye_.project(seen, pixel) || !(pixel.cwiseAbs().maxCoeff() <= kFarthest_px)) {
      continue;
    }
    corner.x = pixel.x(), corner.y = pixel.y();
    corner.inverse_depth = 1.0 / eye_.depth(seen);
    corner.known = std::isfinite(vertex.stiffness_N_m) && std::isfinite(vertex.std_N_m) && vertex.std_N_m >= 0.0;
    if (corner.known) {
      corner.share = (vertex.stiffness_N_m - style_.low_N_m) / (style_.high_N_m - style_.low_N_m);
      corner.certainty = std::max(0.0, 1.0 - vertex.std_N_m / style_.uncertain_std_N_m);
    }
  }
}

// Barycentric coordinates in the image are linear, and so is the inverse depth; what lies on the surface is linear
// after division by the depth.
void StiffnessOverlay::fill(const Corner& a, const Corner& b, const Corner& c) noexcept {
  if (!(a.inverse_depth > 0.0 && b.inverse_depth > 0.0 && c.inverse_depth > 0.0)) {
    return;
  }
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (!(std::abs(area) > kLeastArea_px)) {
    return;
  }
  const CameraConfig& camera = eye_.config();
  const int left = std::max(0, static_cast<int>(std::ceil(std::min({a.x, b.x, c.x}))));
  const int right = std::min(camera.width_px - 1, static_cast<int>(std::floor(std::max({a.x, b.x, c.x}))));
  const int top = std::max(0, static_cast<int>(std::ceil(std::min({a.y, b.y, c.y}))));
  const int bottom = std::min(camera.height_px - 1, static_cast<int>(std::floor(std::max({a.y, b.y, c.y}))));
  if (left > right || top > bottom) {
    return;
  }
  touched_ = {std::min(touched_.left, left), std::min(touched_.top, top), std::max(touched_.right, right),
              std::max(touched_.bottom, bottom)};
  const bool known = a.known && b.known && c.known;
  for (int y = top; y <= bottom; ++y) {
    Cell* const row = &cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width_px)];
    for (int x = left; x <= right; ++x) {
      const double wb = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
      const double wc = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
      const double wa = 1.0 - wb - wc;
      if (wa < 0.0 || wb < 0.0 || wc < 0.0) {
        continue;
      }
      const double pa = wa * a.inverse_depth, pb = wb * b.inverse_depth, pc = wc * c.inverse_depth;
      const double inverse_depth = pa + pb + pc;
      if (static_cast<float>(inverse_depth) > row[x].inverse_depth) {
        row[x] = cell((pa * a.share + pb * b.share + pc * c.share) / inverse_depth,
                      (pa * a.certainty + pb * b.certainty + pc * c.certainty) / inverse_depth, known, inverse_depth);
      }
    }
  }
}

StiffnessOverlay::Cell StiffnessOverlay::cell(double share, double certainty, bool known,
                                              double inverse_depth) const noexcept {
  const double opacity = style_.faint_opacity + (known ? certainty : 0.0) * (style_.opacity - style_.faint_opacity);
  const auto level = std::lround((kLevels - 1) * std::clamp(share, 0.0, 1.0));
  return {static_cast<float>(inverse_depth), static_cast<std::uint16_t>(known ? level : kLevels),
          static_cast<std::uint8_t>(std::lround(255.0 * opacity))};
}

void StiffnessOverlay::blend_and_clear(const ImageView& image) noexcept {
  const auto colors = palette(image.format);
  const int n = channels(image.format);
  for (int y = touched_.top; y <= touched_.bottom; ++y) {
    Cell* const row = &cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width)];
    std::uint8_t* const pixels = image.data + static_cast<std::size_t>(y) * image.stride;
    for (int x = touched_.left; x <= touched_.right; ++x) {
      if (row[x].inverse_depth > 0.0F) {
        blend(pixels + static_cast<std::ptrdiff_t>(x) * n, n, colors[row[x].level], row[x].coverage);
        row[x] = {};
      }
    }
  }
}

// Upwards the stiffer, to the right the less sure; below it what is not known. It lies on the picture itself, as the
// map does: only what is written stands on darkened ground.
void StiffnessOverlay::draw_bar(const ImageView& image) const noexcept {
  const int pad = font_.height() / 2, line = font_.line_height();
  const int swatch_top = bar_top_ + bar_height_ + line / 3, swatch_bottom = bar_top_ + bar_height_ + line;
  const int left = bar_left_ - pad, numbers_left = bar_left_ + bar_width_;
  darken(image, left, bar_top_ - line - pad, image.width - left, line + pad, kDarkened);
  darken(image, numbers_left, bar_top_, image.width - numbers_left, swatch_bottom - bar_top_, kDarkened);
  darken(image, left, swatch_bottom, image.width - left, line + pad, kDarkened);
  const auto colors = palette(image.format);
  const int n = channels(image.format);
  for (int y = std::max(0, bar_top_); y < std::min(image.height, swatch_bottom); ++y) {
    const bool known = y < bar_top_ + bar_height_;
    if (!known && y < swatch_top) {
      continue;
    }
    const double share = 1.0 - (y - bar_top_) / std::max(1.0, bar_height_ - 1.0);
    for (int x = std::max(0, bar_left_); x < std::min(image.width, bar_left_ + bar_width_); ++x) {
      const double certainty = 1.0 - (x - bar_left_) / std::max(1.0, bar_width_ - 1.0);
      const Cell c = cell(share, certainty, known, 1.0);
      blend(image.data + static_cast<std::size_t>(y) * image.stride + static_cast<std::ptrdiff_t>(x) * n, n,
            colors[c.level], c.coverage);
    }
  }
  const int text_left = bar_left_ + bar_width_ + pad;
  font_.draw(image, bar_left_, bar_top_ - line, "N/m", kWhite);
  for (int i = 0; i < kBarSteps; ++i) {
    const double share = i / (kBarSteps - 1.0);
    const int y = bar_top_ + static_cast<int>(std::lround((1.0 - share) * (bar_height_ - font_.height())));
    font_.draw(image, text_left, y, number(style_.low_N_m + share * (style_.high_N_m - style_.low_N_m)).view(), kWhite);
  }
  font_.draw(image, text_left, swatch_top, "?", kWhite);
  ShortText unsure("+-");
  unsure += number(style_.uncertain_std_N_m).view();
  font_.draw(image, bar_left_, swatch_bottom + pad / 2, unsure.view(), kWhite);
}

bool StiffnessOverlay::draw_unknown(const ImageView& image) const noexcept {
  if (!fits(image)) {
    return false;
  }
  const int width = font_.width(kUnknownText), pad = font_.height() / 2;
  const int left = image.width - width - 2 * pad;
  darken(image, left - pad, bar_top_ - pad, width + 3 * pad, font_.height() + 2 * pad, kDarkened);
  font_.draw(image, left, bar_top_, kUnknownText, kNotice);
  return true;
}

}  // namespace saras
