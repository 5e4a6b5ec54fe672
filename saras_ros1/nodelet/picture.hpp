// A picture while GStreamer holds it, and the two eyes in one picture.
#pragma once

#include <array>

#include "saras/overlay/image_view.hpp"

namespace saras_ros1 {

/// BGR, borrowed: only valid during the call that gives it.
struct Picture {
  saras::ImageView pixels;
  std::int64_t taken_ns = 0;  ///< nanoseconds since the epoch, as far as the pipeline knows
};

enum class Layout { kTwoDevices, kSideBySide, kTopBottom };

/// Left and right, or upper and lower half, of the same bytes. Throws saras::ConfigError for a side that is odd.
std::array<Picture, 2> halves(const Picture& picture, Layout layout);

}  // namespace saras_ros1
