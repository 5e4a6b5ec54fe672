#include "picture.hpp"

#include <string>

#include "saras/spatial/errors.hpp"

namespace saras_ros1 {

std::array<Picture, 2> halves(const Picture& picture, Layout layout) {
  const bool beside = layout == Layout::kSideBySide;
  const saras::ImageView& whole = picture.pixels;
  if ((beside ? whole.width : whole.height) % 2 != 0) {
    throw saras::ConfigError(std::string(beside ? "side_by_side" : "top_bottom") + " picture is " +
                             std::to_string(whole.width) + "x" + std::to_string(whole.height) +
                             ": that side must be even");
  }
  std::array<Picture, 2> eyes{picture, picture};
  for (Picture& eye : eyes) {
    (beside ? eye.pixels.width : eye.pixels.height) /= 2;
  }
  const auto columns = static_cast<std::size_t>(eyes[0].pixels.width);
  const auto rows = static_cast<std::size_t>(eyes[0].pixels.height);
  eyes[1].pixels.data += beside ? columns * static_cast<std::size_t>(channels(whole.format)) : rows * whole.stride;
  return eyes;
}

}  // namespace saras_ros1
