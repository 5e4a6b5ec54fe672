// Draws what ToolOverlay says into the image of one eye, or a notice why nothing can be drawn.
#pragma once

#include "saras/overlay/canvas.hpp"
#include "saras/overlay/tool_overlay.hpp"

namespace saras {

struct OverlayStyle {
  double line_m = 0.0012;         ///< a shaft's line is as thick as this would look there: a cue of depth, > 0
  double least_line_px = 1.5;     ///< bounds of that thickness, for an image 480 rows high, > 0
  double greatest_line_px = 9.0;  ///< >= least_line_px
  double ruler_step_m = 0.010;    ///< ticks along the shaft from the tip on; 0: none
  int ruler_ticks = 5;            ///< how many, 0 … 20
  double text_height = 0.033;     ///< of a capital, as a share of the image's height, 0.01 … 0.2
  bool panel = true;              ///< the list of all tools in the upper left corner
  void validate() const;          ///< throws ConfigError
};

/// Why there is no overlay, or what is wrong with the picture itself.
enum class OverlayNotice : std::uint8_t {
  kNone = 0,
  kFrozen,        ///< the camera gives the same picture, or none
  kOutOfStep,     ///< the other eye's picture is of another time, or missing
  kNoIntrinsics,  ///< no usable camera_info yet
  kSizeDiffers,   ///< the image is not of the size that was calibrated
  kNoCameraPose,  ///< where the endoscope is is not known (drawn with the list of tools)
};
/// What is written on the image.
const char* to_string(OverlayNotice notice) noexcept;

/// Green, yellow, red, grey: never green but for CLEAR.
Color color_of(ProximityState level) noexcept;
inline constexpr Color kNoticeColor{255, 140, 0, 220};

/// Of one eye: its camera, and letters of the right size for its image.
class OverlayPainter {
 public:
  /// Throws ConfigError.
  OverlayPainter(const CameraConfig& camera, const OverlayStyle& style);
  /// False, and nothing drawn: the image is not of the camera's size. Does not allocate.
  bool draw(const ToolOverlayOutput& tools, const ImageView& image) const noexcept;
  const PinholeEye& eye() const { return eye_; }
  const OverlayStyle& style() const { return style_; }

 private:
  void draw_tool(const ToolMark& tool, const ImageView& image) const noexcept;
  void draw_shaft(const ToolMark& tool, Color color, const ImageView& image) const noexcept;
  void draw_ruler(const ToolMark& tool, Color color, const ImageView& image) const noexcept;
  void draw_witness(const ToolMark& tool, Color color, const ImageView& image) const noexcept;
  void draw_label(const ShortText& text, const LinePiece& shaft, Color color, const ImageView& image) const noexcept;
  double radius_px(double depth_m) const noexcept;
  /// Draws a segment of the left optical frame; false: nothing of it is seen. first: its visible piece nearest to a.
  bool draw_segment(const Vector3& a, const Vector3& b, Color color, const ImageView& image,
                    LinePiece* first = nullptr) const noexcept;

  PinholeEye eye_;
  OverlayStyle style_;
  StrokeFont font_;
  double scale_;  // of pixels, against an image 480 rows high
};

/// Writes a notice in the middle of the upper edge of an image of any size, which need not be calibrated.
class NoticePainter {
 public:
  void draw(OverlayNotice notice, const ImageView& image) const noexcept;

 private:
  StrokeFont small_{12}, medium_{24}, large_{48};
};

}  // namespace saras
