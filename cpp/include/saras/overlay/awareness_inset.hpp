// A small picture bottom left of the endoscope's image: the model of the anatomy with proxy, closest point, force and
// region of interest, seen from a fixed direction.
#pragma once

#include <array>
#include <limits>

#include "saras/overlay/canvas.hpp"
#include "saras/overlay/stroke_font.hpp"

namespace saras {

struct AwarenessInsetStyle {
  double width = 0.3;            ///< of the inset, as a share of the image's width, 0.1 … 0.5
  double span_m = 0.05;          ///< so wide is what it shows, > 0
  double azimuth_rad = -1.1;     ///< from where it is seen, about the base's z
  double elevation_rad = 0.8;    ///< above the plane, (0, 1.5]
  double arrow_m_per_N = 0.004;  ///< length of the force's arrow, > 0
  double least_force_N = 0.02;   ///< no arrow below it, >= 0
  void validate() const;         ///< throws ConfigError
};

inline constexpr int kMaxRegionCorners = 64;

/// A vertex of the stiffness map.
struct InsetDot {
  Vector3 at = Vector3::Zero();
  double share = std::numeric_limits<double>::quiet_NaN();  ///< 0: the softest, 1: the stiffest; NaN: not known, grey
};
/// Dark violet over green to yellow, as the map's own colours; grey for NaN.
Color stiffness_color(double share) noexcept;

/// Everything in one frame, the slave's base; what is not finite is not known, and not drawn.
struct AwarenessView {
  bool known = false;  ///< else only a grey "?" is written
  bool hold = false;   ///< the text is written in the colour of a notice
  ShortText text;      ///< contact state and force, or why nobody moves
  Vector3 center = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< of what is shown
  Vector3 tip = center;                                                          ///< of the slave, white
  Vector3 proxy = center;                                                        ///< green
  Vector3 closest = center;           ///< point of the model to the proxy, red
  Vector3 normal = Vector3::UnitZ();  ///< of the model there
  Vector3 force_N = Vector3::Zero();  ///< on the hand, a red arrow from the closest point
  std::array<Vector3, kMaxRegionCorners> region = {};
  int region_corners = 0;
  bool region_closed = false;
  const InsetDot* dots = nullptr;  ///< of the stiffness map; must live as long as it is drawn
  int dot_count = 0;
};

class AwarenessInset {
 public:
  /// For images of one size. Throws ConfigError.
  AwarenessInset(int width_px, int height_px, const AwarenessInsetStyle& style);
  /// False, and nothing drawn: the image is of another size. Does not allocate; draws in its own box only.
  bool draw(const AwarenessView& view, const ImageView& image) const noexcept;
  /// Upper left corner and size of the box [px].
  std::array<int, 4> box() const noexcept { return {left_, top_, width_, height_}; }
  /// Where a point is in the box [px].
  Pixel place(const AwarenessView& view, const Vector3& point) const noexcept;

 private:
  void draw_model(const AwarenessView& view, const ImageView& box) const noexcept;
  void draw_dots(const AwarenessView& view, const ImageView& box) const noexcept;
  void draw_region(const AwarenessView& view, const ImageView& box) const noexcept;
  void draw_force(const AwarenessView& view, const ImageView& box) const noexcept;
  void draw_point(const AwarenessView& view, const Vector3& point, double radius_px, Color color,
                  const ImageView& box) const noexcept;

  AwarenessInsetStyle style_;
  int image_width_, image_height_, left_, top_, width_, height_;
  double scale_;  ///< of thicknesses, against a box 200 px wide
  Vector3 right_, up_;
  StrokeFont font_;
};

}  // namespace saras
