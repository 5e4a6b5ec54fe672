#include "saras/overlay/stroke_font.hpp"

#include <algorithm>
#include <cmath>

#include "saras/overlay/canvas.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

/// Strokes on a grid of 5 x 7 points, as column and row digits; ';' lifts the pen.
struct Glyph {
  char letter;
  const char* strokes;
};
constexpr Glyph kGlyphs[] = {
    {'0', "103041453616050110"},
    {'1', "112026;1636"},
    {'2', "01103041420646"},
    {'3', "0110304142334445361605;2333"},
    {'4', "300444;3036"},
    {'5', "400003334445361605"},
    {'6', "30200205163645443303"},
    {'7', "004016"},
    {'8', "13020110304142331304051636454433"},
    {'9', "16264441301001021343"},
    {'A', "062046;1434"},
    {'B', "06003041423303;3344453606"},
    {'C', "4130100105163645"},
    {'D', "00062644422000"},
    {'E', "40000646;0333"},
    {'F', "400006;0333"},
    {'G', "41301001051636454323"},
    {'H', "0006;4046;0343"},
    {'I', "1030;2026;1636"},
    {'J', "4045361605"},
    {'K', "0006;400346"},
    {'L', "000646"},
    {'M', "0600234046"},
    {'N', "06004640"},
    {'O', "103041453616050110"},
    {'P', "06003041423303"},
    {'Q', "103041453616050110;3446"},
    {'R', "06003041423303;2346"},
    {'S', "413010010213334445361605"},
    {'T', "0040;2026"},
    {'U', "000516364540"},
    {'V', "002640"},
    {'W', "0016233640"},
    {'X', "0046;4006"},
    {'Y', "002340;2326"},
    {'Z', "00400646"},
    {'m', "0206;03122326;23324346"},
    {'.', "2626"},
    {'-', "1333"},
    {'+', "1333;2224"},
    {'?', "01103041422324;2626"},
    {'!', "2024;2626"},
    {'/', "0640"},
    {':', "2222;2525"},
};
constexpr double kRows = 6.0;

/// Of a letter in the table; beyond ASCII something that is no letter.
constexpr std::size_t place(char c) noexcept {
  const auto code = static_cast<unsigned char>(c);
  return code < 128 ? code : 0;
}

}  // namespace

ShortText& ShortText::operator+=(std::string_view text) noexcept {
  const std::size_t count = std::min(text.size(), data_.size() - size_);
  std::copy_n(text.begin(), count, data_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += count;
  return *this;
}

ShortText& ShortText::append_mm(double length_m) noexcept {
  const double tenths = std::round(std::abs(length_m) * 1e4);
  if (!(tenths < 1e9)) {
    return *this += "?";
  }
  char digits[12];
  auto rest = static_cast<std::int64_t>(tenths);
  const bool decimal = rest < 1000;
  if (!decimal) {
    rest = (rest + 5) / 10;
  }
  std::size_t count = 0;
  do {
    digits[count++] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  } while (rest > 0 || (decimal && count < 2));
  if (length_m < 0.0 && tenths > 0.0) {
    *this += "-";
  }
  while (count > 0) {
    *this += std::string_view(&digits[--count], 1);
    if (decimal && count == 1) {
      *this += ".";
    }
  }
  return *this;
}

StrokeFont::StrokeFont(int height_px) : height_(height_px) {
  validate::in_range("height_px", height_px, 6, 200);
  const double unit = height_px / kRows, radius = std::max(0.7, 0.085 * height_px),
               rim = radius + 1.0 + 0.05 * height_px;
  margin_ = static_cast<int>(std::ceil(rim)) + 1;
  advance_ = static_cast<int>(std::ceil(5.6 * unit));
  cell_width_ = static_cast<int>(std::ceil(4.0 * unit)) + 2 * margin_ + 1;
  cell_height_ = height_px + 2 * margin_ + 1;
  const std::size_t size = static_cast<std::size_t>(cell_width_) * static_cast<std::size_t>(cell_height_);
  for (const Glyph& glyph : kGlyphs) {
    Mask& mask = masks_[place(glyph.letter)];
    const auto trace = [&](std::vector<std::uint8_t>& cell, double radius_px) {
      cell.assign(size, 0);
      const ImageView view{cell.data(), cell_width_, cell_height_, static_cast<std::size_t>(cell_width_),
                           PixelFormat::kMono8};
      for (const char* s = glyph.strokes; s[0] != '\0' && s[1] != '\0';) {
        const auto point = [&](const char* at) {
          return Pixel(margin_ + unit * (at[0] - '0'), margin_ + unit * (at[1] - '0'));
        };
        if (s[0] == ';') {
          ++s;
        } else if (s[2] == '\0' || s[2] == ';') {
          s += 2;
        } else {
          draw_line(view, point(s), point(s + 2), radius_px, {0, 0, 0, 255});
          s += 2;
        }
      }
    };
    trace(mask.letter, radius);
    trace(mask.rim, rim);
  }
  for (char c = 'a'; c <= 'z'; ++c) {
    if (c != 'm') {
      masks_[place(c)] = masks_[place(c) - place('a') + place('A')];
    }
  }
}

template <int kChannels>
void StrokeFont::draw_glyph(const ImageView& image, int x, int y, const Mask& mask,
                            const PixelBytes& color) const noexcept {
  const PixelBytes black = bytes_of({0, 0, 0, 0}, image.format);
  const int left = std::max(0, -x), right = std::min(cell_width_, image.width - x);
  const int top = std::max(0, -y), bottom = std::min(cell_height_, image.height - y);
  for (int v = top; v < bottom; ++v) {
    std::uint8_t* const row = image.data + static_cast<std::size_t>(y + v) * image.stride;
    const std::size_t cell = static_cast<std::size_t>(v) * static_cast<std::size_t>(cell_width_);
    for (int u = left; u < right; ++u) {
      const std::size_t at = cell + static_cast<std::size_t>(u);
      const int rim = mask.rim[at], letter = mask.letter[at];
      if (rim == 0) {
        continue;
      }
      std::uint8_t* const pixel = row + static_cast<std::ptrdiff_t>(x + u) * kChannels;
      if (letter == 255) {  // most pixels are wholly one or the other
        std::copy_n(color.byte, kChannels, pixel);
        continue;
      }
      if (rim == 255) {
        std::copy_n(black.byte, kChannels, pixel);
      } else {
        blend(pixel, kChannels, black, rim);
      }
      if (letter > 0) {
        blend(pixel, kChannels, color, letter);
      }
    }
  }
}

void StrokeFont::draw(const ImageView& image, int x, int y, std::string_view text, Color color) const noexcept {
  const PixelBytes bytes = bytes_of(color, image.format);
  const int n = channels(image.format);
  for (const char c : text) {
    const Mask& mask = masks_[place(c)];
    if (!mask.letter.empty()) {
      const int left = x - margin_, top = y - margin_;
      if (n == 3) {
        draw_glyph<3>(image, left, top, mask, bytes);
      } else if (n == 4) {
        draw_glyph<4>(image, left, top, mask, bytes);
      } else {
        draw_glyph<1>(image, left, top, mask, bytes);
      }
    }
    x += advance_;
  }
}

}  // namespace saras
