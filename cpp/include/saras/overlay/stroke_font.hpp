// Words on images: a font of straight strokes, drawn once a size, with a dark rim that keeps it legible on tissue.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "saras/overlay/image_view.hpp"

namespace saras {

/// A short line of text without memory of its own. What does not fit is cut off.
class ShortText {
 public:
  ShortText() = default;
  explicit ShortText(std::string_view text) { *this += text; }
  ShortText& operator+=(std::string_view text) noexcept;
  /// Millimetres of a length in metres, one decimal below 100 mm; "?" for one that is not finite.
  ShortText& append_mm(double length_m) noexcept;
  std::string_view view() const noexcept { return {data_.data(), size_}; }
  bool empty() const noexcept { return size_ == 0; }

 private:
  std::array<char, 64> data_{};
  std::size_t size_ = 0;
};

/// Digits, letters (small ones as capitals but for m), and . - + ? ! / : — anything else is a gap.
class StrokeFont {
 public:
  /// Height of a capital, 6 … 200 px; throws ConfigError. Allocates; draw does not.
  explicit StrokeFont(int height_px);
  /// x, y: upper left corner of the first letter, anywhere; what leaves the image is cut off.
  void draw(const ImageView& image, int x, int y, std::string_view text, Color color) const noexcept;
  int width(std::string_view text) const noexcept { return static_cast<int>(text.size()) * advance_; }
  int height() const noexcept { return height_; }
  int line_height() const noexcept { return height_ + height_ / 2 + 2 * margin_; }

 private:
  struct Mask {
    std::vector<std::uint8_t> letter, rim;  // coverage 0 … 255, cell by cell row
  };
  template <int kChannels>
  void draw_glyph(const ImageView& image, int x, int y, const Mask& mask, const PixelBytes& color) const noexcept;

  int height_, advance_, margin_, cell_width_, cell_height_;
  std::array<Mask, 128> masks_;
};

}  // namespace saras
