// The stiffness map over the organ in one eye's image: colour says how stiff, opacity how sure, grey that nothing is
// known; its colour bar with numbers at the right edge.
//
// The nearest surface of each pixel is blended once (a depth buffer): what lies behind it is not seen through it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "saras/overlay/canvas.hpp"
#include "saras/overlay/stroke_font.hpp"

namespace saras {

struct StiffnessOverlayStyle {
  double low_N_m = 200.0;            ///< dark end of the colours, >= 0
  double high_N_m = 1200.0;          ///< yellow end, > low_N_m
  double opacity = 0.6;              ///< where it is sure, (0, 1]
  double uncertain_std_N_m = 400.0;  ///< such a deviation, or more, is as faint as what is not known, > 0
  double faint_opacity = 0.15;       ///< of what is unsure, and of the grey of what is not known, [0, opacity]
  bool bar = true;                   ///< the colour bar
  void validate() const;             ///< throws ConfigError
};

inline constexpr int kMaxMapVertices = 200000;

/// NaN, or an infinite deviation: not known there.
struct MapVertex {
  Vector3 at = Vector3::Zero();
  double stiffness_N_m = std::numeric_limits<double>::quiet_NaN();
  double std_N_m = std::numeric_limits<double>::infinity();
};
using MapTriangle = std::array<int, 3>;

/// Somebody else's map; it must live as long as it is drawn.
struct StiffnessMapView {
  const MapVertex* vertices = nullptr;
  int vertex_count = 0;  ///< at most kMaxMapVertices
  const MapTriangle* triangles = nullptr;
  int triangle_count = 0;
  Pose left_T_map;  ///< to the rectified left optical frame
};

class StiffnessOverlay {
 public:
  /// Of one eye. Throws ConfigError. Allocates; draw does not.
  StiffnessOverlay(const CameraConfig& camera, const StiffnessOverlayStyle& style);
  /// False, and nothing drawn: the image is not of the camera's size, or more vertices than there may be. A triangle is
  /// left out when one of its corners is not seen, or is no vertex; it is grey when one of them is not known.
  bool draw(const StiffnessMapView& map, const ImageView& image) noexcept;
  /// Says, where the colour bar is else, that there is no map, or only an old one. False: as above.
  bool draw_unknown(const ImageView& image) const noexcept;
  /// Upper left corner and size of the colour bar [px], without its numbers.
  std::array<int, 4> bar() const noexcept { return {bar_left_, bar_top_, bar_width_, bar_height_}; }
  const StiffnessOverlayStyle& style() const { return style_; }

 private:
  struct Corner {
    double x = 0.0, y = 0.0, inverse_depth = 0.0;  // pixel, 1/m; zero: not seen
    double share = 0.0, certainty = 0.0;
    bool known = false;
  };
  struct Cell {
    float inverse_depth = 0.0F;  // zero: nothing
    std::uint16_t level = 0;     // of kLevels colours; kLevels: not known
    std::uint8_t coverage = 0;
  };
  struct Box {
    int left, top, right, bottom;  // the last ones are within
  };

  bool fits(const ImageView& image) const noexcept;
  void project(const StiffnessMapView& map) noexcept;
  void fill(const Corner& a, const Corner& b, const Corner& c) noexcept;
  Cell cell(double share, double certainty, bool known, double inverse_depth) const noexcept;
  void blend_and_clear(const ImageView& image) noexcept;
  void draw_bar(const ImageView& image) const noexcept;

  PinholeEye eye_;
  StiffnessOverlayStyle style_;
  StrokeFont font_;
  std::vector<Corner> corners_;
  std::vector<Cell> cells_;
  Box touched_{0, 0, -1, -1};
  int bar_left_ = 0, bar_top_ = 0, bar_width_ = 0, bar_height_ = 0;
};

}  // namespace saras
