#include "capture_source.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <regex>

#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& value, const std::string& bound) {
  throw saras::ConfigError(name + " = '" + value + "': " + bound);
}

/// GStreamer writes rates as fractions.
std::string framerate(double rate_hz) { return std::to_string(std::lround(1000.0 * rate_hz)) + "/1000"; }

std::string images_head(const CaptureSource& source) {
  static const std::map<std::string, std::string> kinds = {
      {"png", "image/png"}, {"jpg", "image/jpeg"}, {"jpeg", "image/jpeg"}};
  if (!(source.rate_hz > 0.0)) {
    refuse("rate_hz", "0", "must be given for images");
  }
  if (source.device.find('%') == std::string::npos) {
    refuse("device", source.device, "must hold %05d or the like for the picture's number");
  }
  std::string ending = source.device.substr(source.device.find_last_of('.') + 1);
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto kind = kinds.find(ending);
  if (kind == kinds.end()) {
    refuse("device", source.device, "must end in .png or .jpg");
  }
  return "multifilesrc location=\"" + source.device + "\" caps=\"" + kind->second +
         ",framerate=" + framerate(source.rate_hz) + "\"";
}

/// The source element with what it reads. Nothing of device may end the quotes and go on as a pipeline.
std::string head(const CaptureSource& source) {
  const std::string &kind = source.kind, &device = source.device;
  if (device.find_first_of("\"\n\\") != std::string::npos || (kind != "test" && device.empty())) {
    refuse("device", device, "must name what " + kind + " reads");
  }
  if (kind == "decklink") {
    if (!std::all_of(device.begin(), device.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) {
      refuse("device", device, "must be the number of the card's input");
    }
    return "decklinkvideosrc device-number=" + device;
  }
  if (kind == "v4l2") {
    return "v4l2src device=\"" + device + "\"";
  }
  if (kind == "file") {
    return "filesrc location=\"" + device + "\"";
  }
  if (kind == "images") {
    return images_head(source);
  }
  static const std::regex pattern(R"([\w-]+)");
  const std::string shown = device.empty() ? "ball" : device;
  if (!std::regex_match(shown, pattern)) {
    refuse("device", device, "must be a pattern of videotestsrc");
  }
  return "videotestsrc is-live=true pattern=" + shown;
}

}  // namespace

const std::set<std::string>& source_kinds() {
  static const std::set<std::string> kinds = {"decklink", "v4l2", "file", "images", "test", "pipeline"};
  return kinds;
}

std::string source_text(const CaptureSource& source) {
  static const std::regex properties(R"([\w\s=.,/:+-]*)");
  static const std::set<std::string> decoded = {"file", "images", "v4l2"};
  if (source_kinds().count(source.kind) == 0) {
    refuse("source", source.kind, "must be one of decklink, file, images, pipeline, test, v4l2");
  }
  if (!std::regex_match(source.options, properties)) {
    refuse("options", source.options, "must be NAME=VALUE pairs");
  }
  std::string text;
  if (source.kind == "pipeline") {
    if (source.device.find_first_not_of(" \t\n") == std::string::npos) {
      refuse("device", "", "must be a pipeline");
    }
    text = source.device;
  } else {
    text = head(source) + (source.options.empty() ? "" : " " + source.options);
    text += decoded.count(source.kind) != 0 ? " ! decodebin" : "";
  }
  if ((source.width == 0) != (source.height == 0)) {
    throw saras::ConfigError("width = " + std::to_string(source.width) + ", height = " + std::to_string(source.height) +
                             ": must both be given, or both be 0");
  }
  std::string caps;
  if (source.width > 0) {
    text += " ! videoscale";
    caps += ",width=" + std::to_string(source.width) + ",height=" + std::to_string(source.height);
  }
  if (source.rate_hz > 0.0 && source.kind != "images") {
    text += " ! videorate";
    caps += ",framerate=" + framerate(source.rate_hz);
  }
  return text + (caps.empty() ? "" : " ! video/x-raw" + caps);
}

}  // namespace saras_ros1
