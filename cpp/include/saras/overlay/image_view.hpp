// Somebody else's pixels, and colours that are right in each of their formats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace saras {

/// 8 bits a channel; the names of sensor_msgs/image_encodings.
enum class PixelFormat : std::uint8_t { kBgr8 = 0, kRgb8, kMono8, kBgra8, kRgba8 };

/// False, and format as it was: not one that can be drawn on.
bool parse_encoding(std::string_view encoding, PixelFormat& format) noexcept;
int channels(PixelFormat format) noexcept;

/// height rows of width pixels, stride bytes from row to row.
struct ImageView {
  std::uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  std::size_t stride = 0;
  PixelFormat format = PixelFormat::kBgr8;
};

/// mono: what stands for the colour in a mono8 image. Chosen apart: as grey levels, green and grey would be alike.
struct Color {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  std::uint8_t mono = 0;
};

/// The bytes of a colour in a format, alpha 255.
struct PixelBytes {
  std::uint8_t byte[4] = {0, 0, 0, 255};
};
PixelBytes bytes_of(Color color, PixelFormat format) noexcept;

}  // namespace saras
