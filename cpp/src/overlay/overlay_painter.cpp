#include "saras/overlay/overlay_painter.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr int kDarkened = 110;  // of 256, behind the list of tools
constexpr double kReferenceRows = 480.0;
constexpr double kRim_px = 0.9;  // dark line on both sides of a coloured one
constexpr Color kRimColor{0, 0, 0, 0};

/// Also for who cannot tell colours apart, and for grey images.
const char* mark_of(ProximityState level) noexcept {
  switch (level) {
    case ProximityState::kClear:
      return "";
    case ProximityState::kWarning:
      return "! ";
    case ProximityState::kCollision:
      return "!! ";
    case ProximityState::kUnknown:
      break;
  }
  return "? ";
}

/// "12.3 mm", "! 8.0 mm", "!! -1.2 mm", "? 12.3 mm", "?", "FAR" (nothing there that it could meet).
ShortText distance_text(const ToolMark& tool) noexcept {
  if (tool.level == ProximityState::kUnknown && std::isnan(tool.distance_m)) {
    return ShortText("?");
  }
  ShortText text(mark_of(tool.level));
  return std::isinf(tool.distance_m) ? text += "FAR" : text.append_mm(tool.distance_m) += " mm";
}

}  // namespace

void OverlayStyle::validate() const {
  validate::positive("line_m", line_m);
  validate::positive("least_line_px", least_line_px);
  validate::in_range("greatest_line_px", greatest_line_px, least_line_px, 200.0);
  validate::not_negative("ruler_step_m", ruler_step_m);
  validate::in_range("ruler_ticks", ruler_ticks, 0, 20);
  validate::in_range("text_height", text_height, 0.01, 0.2);
}

const char* to_string(OverlayNotice notice) noexcept {
  switch (notice) {
    case OverlayNotice::kNone:
      return "";
    case OverlayNotice::kFrozen:
      return "FROZEN";
    case OverlayNotice::kOutOfStep:
      return "OUT OF STEP";
    case OverlayNotice::kNoIntrinsics:
      return "NO OVERLAY: NO CALIBRATION";
    case OverlayNotice::kSizeDiffers:
      return "NO OVERLAY: IMAGE SIZE";
    case OverlayNotice::kNoCameraPose:
      return "CAMERA POSE ?";
  }
  return "NO OVERLAY";
}

Color color_of(ProximityState level) noexcept {
  switch (level) {
    case ProximityState::kClear:
      return {40, 217, 80, 235};
    case ProximityState::kWarning:
      return {255, 214, 0, 185};
    case ProximityState::kCollision:
      return {255, 38, 26, 255};
    case ProximityState::kUnknown:
      break;
  }
  return {160, 160, 160, 120};
}

OverlayPainter::OverlayPainter(const CameraConfig& camera, const OverlayStyle& style)
    : eye_(camera),
      style_((style.validate(), style)),
      font_(std::clamp(static_cast<int>(std::lround(style.text_height * camera.height_px)), 8, 100)),
      scale_(camera.height_px / kReferenceRows) {}

double OverlayPainter::radius_px(double depth_m) const noexcept {
  const double thickness = eye_.focal_px() * style_.line_m / depth_m;
  return 0.5 * std::clamp(thickness, scale_ * style_.least_line_px, scale_ * style_.greatest_line_px);
}

bool OverlayPainter::draw_segment(const Vector3& a, const Vector3& b, Color color, const ImageView& image,
                                  LinePiece* first) const noexcept {
  const ProjectedLine line = eye_.project_line(a, b, scale_ * style_.greatest_line_px);
  const auto draw_pieces = [&](double rim_px, Color with) {
    for (int i = 0; i < line.count; ++i) {
      const LinePiece& piece = line.pieces[static_cast<std::size_t>(i)];
      // In steps of half a pixel of thickness: along the image the inverse depth is linear.
      const double from = radius_px(piece.depth_a_m), to = radius_px(piece.depth_b_m);
      const int steps = std::clamp(static_cast<int>(std::ceil(2.0 * std::abs(to - from))), 1, 16);
      for (int s = 0; s < steps; ++s) {
        const double begin = static_cast<double>(s) / steps, end = static_cast<double>(s + 1) / steps;
        const double middle = 0.5 * (begin + end);
        const double depth = 1.0 / ((1.0 - middle) / piece.depth_a_m + middle / piece.depth_b_m);
        draw_line(image, piece.a + begin * (piece.b - piece.a), piece.a + end * (piece.b - piece.a),
                  radius_px(depth) + rim_px, with);
      }
    }
  };
  draw_pieces(kRim_px * scale_, kRimColor);  // grey on steel would not be seen
  draw_pieces(0.0, color);
  if (first != nullptr && line.count > 0) {
    *first = line.pieces[0];
  }
  return line.count > 0;
}

void OverlayPainter::draw_ruler(const ToolMark& tool, Color color, const ImageView& image) const noexcept {
  const Vector3 along = tool.trocar - tool.tip;
  const double length = along.norm();
  if (!(length > 0.0)) {
    return;
  }
  const Vector3 u = along / length;
  for (int i = 1; i <= style_.ruler_ticks && i * style_.ruler_step_m < length; ++i) {
    const Vector3 at = tool.tip + i * style_.ruler_step_m * u;
    Pixel center, beside;
    if (!eye_.project(at, center) || !eye_.project(at + 0.001 * u, beside)) {
      continue;
    }
    const Pixel direction = beside - center;
    if (!(direction.norm() > 1e-6)) {
      continue;  // seen end on
    }
    const double radius = radius_px(eye_.depth(at)), half = 2.5 * radius + 1.0;
    const Pixel across = half * Pixel(-direction.y(), direction.x()).normalized();
    draw_line(image, center - across, center + across, 0.6 * radius, color);
  }
}

void OverlayPainter::draw_shaft(const ToolMark& tool, Color color, const ImageView& image) const noexcept {
  LinePiece first;
  if (!draw_segment(tool.tip, tool.trocar, color, image, &first)) {
    return;
  }
  if (style_.ruler_step_m > 0.0) {
    draw_ruler(tool, color, image);
  }
  for (const Vector3* end : {&tool.tip, &tool.trocar}) {
    Pixel at;
    if (eye_.project(*end, at)) {
      draw_disc(image, at, 2.0 * radius_px(eye_.depth(*end)), color);
    }
  }
  draw_label(distance_text(tool), first, color, image);
}

// At the tip, on the side to which its shaft leads, but not on the shaft: labels of two tips that meet stay apart.
void OverlayPainter::draw_label(const ShortText& text, const LinePiece& shaft, Color color,
                                const ImageView& image) const noexcept {
  const double width = font_.width(text.view()), height = font_.height(), gap = scale_ * 9.0;
  const double x = shaft.b.x() < shaft.a.x() ? shaft.a.x() - gap - width : shaft.a.x() + gap;
  const double y = shaft.b.y() < shaft.a.y() ? shaft.a.y() + gap : shaft.a.y() - gap - height;
  const int left = static_cast<int>(std::clamp(x, 2.0, std::max(2.0, image.width - 2.0 - width)));
  const int top = static_cast<int>(std::clamp(y, 2.0, std::max(2.0, image.height - 2.0 - height)));
  font_.draw(image, left, top, text.view(), color);
}

void OverlayPainter::draw_witness(const ToolMark& tool, Color color, const ImageView& image) const noexcept {
  draw_segment(tool.on_tool, tool.on_partner, color, image);
  for (const Vector3* point : {&tool.on_tool, &tool.on_partner}) {
    Pixel at;
    if (eye_.project(*point, at)) {
      draw_disc(image, at, 1.4 * radius_px(eye_.depth(*point)) + 1.0, color);
    }
  }
}

void OverlayPainter::draw_tool(const ToolMark& tool, const ImageView& image) const noexcept {
  const Color color = color_of(tool.level);
  if (tool.placed) {
    draw_shaft(tool, color, image);
  }
  if (tool.witness) {
    draw_witness(tool, color, image);
  }
}

bool OverlayPainter::draw(const ToolOverlayOutput& tools, const ImageView& image) const noexcept {
  const CameraConfig& camera = eye_.config();
  if (image.data == nullptr || image.width != camera.width_px || image.height != camera.height_px) {
    return false;
  }
  const int margin = font_.height() / 2, line = font_.line_height(), count = style_.panel ? tools.count : 0;
  std::array<ShortText, kMaxTools> lines;
  std::size_t widest = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const ToolMark& tool = tools.tools[i];
    ((lines[i] += tool.name.view()) += "  ") += distance_text(tool).view();
    widest = std::max(widest, lines[i].view().size());
  }
  if (count > 0) {
    darken(image, 0, 0, static_cast<int>(widest) * font_.width("0") + 2 * margin, count * line + margin, kDarkened);
  }
  // The most dangerous last: nothing covers it but the list, which is drawn on its ground and over the tools.
  for (const ProximityState level :
       {ProximityState::kUnknown, ProximityState::kClear, ProximityState::kWarning, ProximityState::kCollision}) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(tools.count); ++i) {
      if (tools.tools[i].level == level) {
        draw_tool(tools.tools[i], image);
      }
    }
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    font_.draw(image, margin, margin + static_cast<int>(i) * line, lines[i].view(), color_of(tools.tools[i].level));
  }
  return true;
}

void NoticePainter::draw(OverlayNotice notice, const ImageView& image) const noexcept {
  if (notice == OverlayNotice::kNone || image.data == nullptr) {
    return;
  }
  const std::string_view text = to_string(notice);
  // A sixth of the image's width a letter at most, so that the longest notice fits.
  const StrokeFont* font = &small_;
  for (const StrokeFont* larger : {&medium_, &large_}) {
    if (larger->width(text) < image.width * 3 / 4 && larger->height() * 12 < image.height) {
      font = larger;
    }
  }
  const int x = (image.width - font->width(text)) / 2, y = image.height - 3 * font->height();
  darken(image, x - font->height(), y - font->height() / 2, font->width(text) + 2 * font->height(), 2 * font->height(),
         60);
  font->draw(image, x, y, text, kNoticeColor);
}

}  // namespace saras
