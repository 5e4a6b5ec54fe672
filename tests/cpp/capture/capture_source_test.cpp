// What a source's parameters become in GStreamer's words, and what is refused.
#include "capture_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

CaptureSource source(const std::string& kind, const std::string& device, const std::string& options = "") {
  CaptureSource made;
  made.kind = kind;
  made.device = device;
  made.options = options;
  return made;
}

TEST(CaptureSource, SourcesAsGStreamerWritesThem) {
  EXPECT_EQ(source_text(source("decklink", "1", "mode=1080p25 connection=sdi")),
            "decklinkvideosrc device-number=1 mode=1080p25 connection=sdi");
  CaptureSource camera = source("v4l2", "/dev/video2");
  camera.width = 1280;
  camera.height = 720;
  camera.rate_hz = 25.0;
  EXPECT_EQ(source_text(camera),
            "v4l2src device=\"/dev/video2\" ! decodebin ! videoscale ! videorate"
            " ! video/x-raw,width=1280,height=720,framerate=25000/1000");
  CaptureSource pictures = source("images", "/tmp/eye_%03d.PNG");
  pictures.rate_hz = 12.5;
  EXPECT_EQ(source_text(pictures),
            "multifilesrc location=\"/tmp/eye_%03d.PNG\" caps=\"image/png,framerate=12500/1000\" ! decodebin");
  EXPECT_EQ(source_text(source("test", "")), "videotestsrc is-live=true pattern=ball");
  EXPECT_EQ(source_text(source("pipeline", "videotestsrc ! identity")), "videotestsrc ! identity");
}

TEST(CaptureSource, WrongOnesAreRefusedByName) {
  CaptureSource half = source("test", "ball");
  half.width = 640;
  const std::vector<std::pair<CaptureSource, std::string>> wrong = {
      {source("webcam", "0"), "source"},
      {source("decklink", "front"), "device"},
      {source("file", ""), "device"},
      {source("file", "a\" ! fakesink name=\"b"), "device"},
      {source("file", "a\\"), "device"},
      {source("images", "a.png"), "rate_hz"},
      {source("test", "ball ! fakesink"), "device"},
      {source("pipeline", " "), "device"},
      {source("v4l2", "/dev/video0", "io-mode=2 ! fakesink"), "options"},
      {half, "height"},
  };
  for (const auto& [given, name] : wrong) {
    try {
      source_text(given);
      FAIL() << given.kind << " " << given.device;
    } catch (const saras::ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

// Whatever a device is called: it stays inside its quotes, or is refused.
TEST(CaptureSource, NoDeviceAddsAnElement) {
  std::mt19937 random(1);
  const std::string letters = "ab/%\"!\\ \n='.-_0";
  std::uniform_int_distribution<std::size_t> letter(0, letters.size() - 1), length(0, 12);
  for (int draw = 0; draw < 5000; ++draw) {
    std::string device;
    for (std::size_t i = length(random); i > 0; --i) {
      device += letters[letter(random)];
    }
    for (const char* kind : {"v4l2", "file", "test", "decklink"}) {
      try {
        const std::string text = source_text(source(kind, device));
        std::string outside;
        bool quoted = false;
        for (const char c : text) {
          quoted = c == '"' ? !quoted : quoted;
          outside += quoted ? '.' : c;
        }
        EXPECT_FALSE(quoted) << text;
        const std::size_t bars = static_cast<std::size_t>(std::count(outside.begin(), outside.end(), '!'));
        EXPECT_LE(bars, 1U) << text;  // of decodebin
        EXPECT_EQ(bars, text.find(" ! decodebin") == text.size() - 12 ? 1U : 0U) << text;
      } catch (const saras::ConfigError&) {
      }
    }
  }
}

}  // namespace
}  // namespace saras_ros1
