// Where pictures come from, as GStreamer writes it.
#pragma once

#include <set>
#include <string>

namespace saras_ros1 {

struct CaptureSource {
  /// decklink | v4l2 | file | images | test | pipeline
  std::string kind;
  /// decklink: the card's input, 0, 1, …; v4l2: /dev/video0; file: a video's path; images: a path with %05d for the
  /// number; test: a pattern of videotestsrc (ball, smpte …); pipeline: GStreamer's own words, up to video/x-raw.
  std::string device;
  std::string options;   ///< properties of the source element, as "mode=1080p25 connection=sdi"
  int width = 0;         ///< what the pictures are brought to [px]; 0: as they come
  int height = 0;        ///< as width
  double rate_hz = 0.0;  ///< as width; the rate of images must be given
};

const std::set<std::string>& source_kinds();

/// The pipeline up to raw pictures, for Grabber. Throws saras::ConfigError naming what is wrong.
std::string source_text(const CaptureSource& source);

}  // namespace saras_ros1
