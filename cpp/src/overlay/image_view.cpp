#include "saras/overlay/image_view.hpp"

namespace saras {

bool parse_encoding(std::string_view encoding, PixelFormat& format) noexcept {
  constexpr struct {
    std::string_view name;
    PixelFormat format;
  } kKnown[] = {{"bgr8", PixelFormat::kBgr8},
                {"rgb8", PixelFormat::kRgb8},
                {"mono8", PixelFormat::kMono8},
                {"bgra8", PixelFormat::kBgra8},
                {"rgba8", PixelFormat::kRgba8}};
  for (const auto& known : kKnown) {
    if (known.name == encoding) {
      format = known.format;
      return true;
    }
  }
  return false;
}

int channels(PixelFormat format) noexcept {
  switch (format) {
    case PixelFormat::kMono8:
      return 1;
    case PixelFormat::kBgra8:
    case PixelFormat::kRgba8:
      return 4;
    case PixelFormat::kBgr8:
    case PixelFormat::kRgb8:
      break;
  }
  return 3;
}

PixelBytes bytes_of(Color color, PixelFormat format) noexcept {
  switch (format) {
    case PixelFormat::kMono8:
      return {{color.mono, 0, 0, 255}};
    case PixelFormat::kRgb8:
    case PixelFormat::kRgba8:
      return {{color.r, color.g, color.b, 255}};
    case PixelFormat::kBgr8:
    case PixelFormat::kBgra8:
      break;
  }
  return {{color.b, color.g, color.r, 255}};
}

}  // namespace saras
