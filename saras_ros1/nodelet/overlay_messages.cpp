#include "overlay_messages.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

constexpr const char* kSourceOrder = "mesa_left,mesa_right,PSM1,PSM2";

saras::Vector3 vector(const geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }

const ToolCollision* find(const CollisionState* state, const std::string& name) {
  if (state == nullptr) {
    return nullptr;
  }
  const auto at = std::find_if(state->tools.begin(), state->tools.end(),
                               [&](const ToolCollision& tool) { return tool.name == name; });
  return at == state->tools.end() ? nullptr : &*at;
}

saras::ProximityState proximity(std::uint8_t state) {
  switch (state) {
    case ToolCollision::CLEAR:
      return saras::ProximityState::kClear;
    case ToolCollision::WARNING:
      return saras::ProximityState::kWarning;
    case ToolCollision::COLLISION:
      return saras::ProximityState::kCollision;
    default:
      return saras::ProximityState::kUnknown;
  }
}

/// As it is written on the image.
saras::ShortText label(const std::string& name) {
  std::string text = name;
  for (char& c : text) {
    c = c == '_' ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return saras::ShortText(text);
}

}  // namespace

saras::CameraConfig camera_config(const sensor_msgs::CameraInfo& info, bool rectified, double near_m) {
  saras::CameraConfig config;
  config.width_px = static_cast<int>(info.width);
  config.height_px = static_cast<int>(info.height);
  const bool whole = (info.roi.width == 0 || info.roi.width == info.width) &&
                     (info.roi.height == 0 || info.roi.height == info.height) && info.roi.x_offset == 0 &&
                     info.roi.y_offset == 0;
  if (info.binning_x > 1 || info.binning_y > 1 || !whole) {
    throw saras::ConfigError("camera_info: binning or a region of interest: only whole images are drawn on");
  }
  using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  config.K = Eigen::Map<const RowMajor3>(info.K.data());
  config.R = Eigen::Map<const RowMajor3>(info.R.data());
  config.P = Eigen::Map<const RowMajor34>(info.P.data());
  config.rectified = rectified;
  config.near_m = near_m;
  if (!rectified) {
    const bool known = info.distortion_model == "plumb_bob" || info.distortion_model == "rational_polynomial";
    if (!known && !info.D.empty()) {
      throw saras::ConfigError("camera_info: distortion_model = '" + info.distortion_model +
                               "': must be plumb_bob or rational_polynomial");
    }
    for (std::size_t i = 0; i < info.D.size(); ++i) {
      if (i < config.distortion.size()) {
        config.distortion[i] = info.D[i];
      } else if (info.D[i] != 0.0) {
        throw saras::ConfigError("camera_info: D has " + std::to_string(info.D.size()) +
                                 " numbers: thin prisms and tilted sensors (beyond 8) are not known here");
      }
    }
  }
  config.validate();
  return config;
}

bool view_of(sensor_msgs::Image& image, saras::ImageView& view) {
  if (!saras::parse_encoding(image.encoding, view.format)) {
    return false;
  }
  const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(channels(view.format));
  const std::size_t step = image.step;
  if (image.height == 0 || image.width == 0 || step < row || image.data.size() / step < image.height) {
    return false;
  }
  view.data = image.data.data();
  view.width = static_cast<int>(image.width);
  view.height = static_cast<int>(image.height);
  view.stride = step;
  return true;
}

std::map<std::string, double> distances_by_tool(const std_msgs::Float64MultiArray& message) {
  const bool labelled = !message.layout.dim.empty() && !message.layout.dim[0].label.empty();
  const std::string names = labelled ? message.layout.dim[0].label : kSourceOrder;
  std::map<std::string, double> distances;
  std::size_t from = 0;
  for (const double value : message.data) {
    if (from > names.size()) {
      break;
    }
    const std::size_t to = std::min(names.find(',', from), names.size());
    distances[names.substr(from, to - from)] = value;
    from = to + 1;
  }
  return distances;
}

void fill_tools(const std::vector<std::string>& names, const CollisionState* state, const CollisionState* places,
                const std::map<std::string, double>& distances, saras::ToolOverlayInput& input) {
  input.count = static_cast<int>(std::min<std::size_t>(names.size(), saras::kMaxTools));
  for (std::size_t i = 0; i < static_cast<std::size_t>(input.count); ++i) {
    saras::OverlayTool& tool = input.tools[i];
    tool = saras::OverlayTool();
    tool.name = label(names[i]);
    if (const auto distance = distances.find(names[i]); distance != distances.end()) {
      tool.distance_m = distance->second;
    }
    if (const ToolCollision* now = find(state, names[i])) {
      tool.state = proximity(now->state);
    }
    if (const ToolCollision* then = find(places, names[i])) {
      tool.tip = vector(then->tip);
      tool.trocar = vector(then->trocar);
      tool.known_distance_m = then->known_distance;
      tool.on_tool = vector(then->on_tool);
      tool.on_partner = vector(then->on_partner);
    }
  }
}

}  // namespace saras_ros1
