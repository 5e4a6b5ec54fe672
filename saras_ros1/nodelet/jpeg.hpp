// BGR to JPEG. Debian has no compressed_image_transport: what it would publish is made here, for readers only.
#pragma once

#include <cstdint>
#include <vector>

#include "saras/overlay/image_view.hpp"

namespace saras_ros1 {

/// quality: 1 … 100. Empty: the encoder refused the picture (no size, or beyond 65500 px).
std::vector<std::uint8_t> jpeg(const saras::ImageView& bgr, int quality);

}  // namespace saras_ros1
