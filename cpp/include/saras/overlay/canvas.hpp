// The few things that the overlay draws, on pixels of any format: thick lines with round ends, discs, darkened boxes.
//
// Written here and not taken from OpenCV: each process of the graph loads the core, none but one of them draws.
#pragma once

#include "saras/overlay/image_view.hpp"
#include "saras/overlay/pinhole.hpp"

namespace saras {

/// Opaque line with round ends, edges smoothed over one pixel. Parts outside of the image are left out; nothing is
/// drawn for numbers that are not finite, beyond 1e6 px, or radius_px <= 0.
void draw_line(const ImageView& image, const Pixel& a, const Pixel& b, double radius_px, Color color) noexcept;
inline void draw_disc(const ImageView& image, const Pixel& center, double radius_px, Color color) noexcept {
  draw_line(image, center, center, radius_px, color);
}
/// Every pixel of the box at share/256 of its brightness.
void darken(const ImageView& image, int x, int y, int width, int height, int share) noexcept;
/// pixel = background + coverage/255 (color - background), rounded, for one pixel within the image.
inline void blend(std::uint8_t* pixel, int channels, const PixelBytes& color, int coverage) noexcept {
  for (int c = 0; c < channels; ++c) {
    const int background = c == 3 ? 255 : pixel[c];
    pixel[c] = static_cast<std::uint8_t>((background * (255 - coverage) + color.byte[c] * coverage + 127) / 255);
  }
}

}  // namespace saras
