// The grabber with GStreamer's test source, a video file that is encoded here, pictures, and what goes wrong.
#include "grabber.hpp"

#include <gst/gst.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "capture_source.hpp"

namespace saras_ros1 {
namespace {

constexpr auto kPatience = std::chrono::seconds(60);

/// Runs a grabber for a while and keeps what it gave.
class Taken {
 public:
  struct Seen {
    int width, height;
    std::int64_t taken_ns;
    std::array<double, 3> mean;  // blue, green, red
  };

  explicit Taken(GrabberConfig config)
      : grabber_((config.name = "camera", config), [this](const Picture& picture) { keep(picture); },
                 [this](const std::string& state) { hear(state); }) {
    grabber_.start();
  }
  ~Taken() { grabber_.stop(); }

  template <typename Condition>
  bool wait(Condition condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    return news_.wait_for(lock, kPatience, condition);
  }
  Grabber& grabber() { return grabber_; }

  std::vector<Seen> seen;
  std::vector<std::string> states;

 private:
  void keep(const Picture& picture) {
    const saras::ImageView& view = picture.pixels;
    std::array<double, 3> mean{};
    for (int y = 0; y < view.height; ++y) {
      const std::uint8_t* row = view.data + static_cast<std::size_t>(y) * view.stride;
      for (int x = 0; x < 3 * view.width; ++x) {
        mean[static_cast<std::size_t>(x % 3)] += row[x] / (static_cast<double>(view.width) * view.height);
      }
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    seen.push_back({view.width, view.height, picture.taken_ns, mean});
    news_.notify_all();
  }
  void hear(const std::string& state) {
    const std::lock_guard<std::mutex> lock(mutex_);
    states.push_back(state);
    news_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable news_;
  Grabber grabber_;  // last: it calls back until it is gone
};

GrabberConfig reading(CaptureSource source) {
  GrabberConfig config;
  config.source = source_text(source);
  config.silence_s = 30.0;  // of a busy machine
  config.retry_s = 600.0;
  return config;
}

GrabberConfig reading(const std::string& kind, const std::string& device) {
  CaptureSource source;
  source.kind = kind;
  source.device = device;
  return reading(source);
}

class GrabberFiles : public testing::Test {
 protected:
  void SetUp() override {
    gst_init(nullptr, nullptr);
    folder_ = std::filesystem::temp_directory_path() / ("saras_grabber_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Runs a pipeline to its end.
  static void make(const std::string& text) {
    GError* error = nullptr;
    GstElement* pipeline = gst_parse_launch(text.c_str(), &error);
    ASSERT_EQ(error, nullptr) << text;
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    GstBus* bus = gst_element_get_bus(pipeline);
    GstMessage* message = gst_bus_timed_pop_filtered(bus, 60 * GST_SECOND,
                                                     static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
    EXPECT_TRUE(message != nullptr && GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) << text;
    gst_message_unref(message);
    gst_object_unref(bus);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
  }
  static void make_video(const std::string& file, int pictures) {
    make("videotestsrc pattern=ball num-buffers=" + std::to_string(pictures) +
         " ! video/x-raw,width=160,height=120,framerate=20/1 ! jpegenc ! avimux ! filesink location=" + file);
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(GrabberFiles, TheTestSourceRunsAtTheSizeThatIsAskedFor) {
  CaptureSource source;
  source.kind = "test";
  source.device = "snow";
  source.width = 321;  // rows that are no multiple of four bytes
  source.height = 242;
  source.rate_hz = 25.0;
  const auto now_ns = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const auto before_ns = now_ns();
  Taken taken(reading(source));
  ASSERT_TRUE(taken.wait([&] { return taken.seen.size() >= 10; }));
  taken.grabber().stop();
  EXPECT_EQ(taken.states, std::vector<std::string>{"OK"});
  EXPECT_EQ(taken.grabber().pictures(), taken.seen.size());
  for (std::size_t i = 0; i < taken.seen.size(); ++i) {
    EXPECT_EQ(taken.seen[i].width, 321);
    EXPECT_EQ(taken.seen[i].height, 242);
    EXPECT_TRUE(i == 0 || taken.seen[i].taken_ns > taken.seen[i - 1].taken_ns);
  }
  EXPECT_GT(taken.seen.front().taken_ns, before_ns - 1'000'000'000);
  EXPECT_LE(taken.seen.back().taken_ns, now_ns());
}

TEST_F(GrabberFiles, ColoursAreBgr) {
  Taken taken(reading("test", "red"));
  ASSERT_TRUE(taken.wait([&] { return !taken.seen.empty(); }));
  taken.grabber().stop();
  EXPECT_LT(taken.seen[0].mean[0], 40.0);
  EXPECT_LT(taken.seen[0].mean[1], 40.0);
  EXPECT_GT(taken.seen[0].mean[2], 200.0);
}

TEST_F(GrabberFiles, TheDevicesLatencyIsTakenOffTheTime) {
  GrabberConfig config = reading("test", "ball");
  config.latency_s = 1000.0;
  Taken taken(config);
  ASSERT_TRUE(taken.wait([&] { return !taken.seen.empty(); }));
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const double age_s = 1e-9 * static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() -
                                                  taken.seen[0].taken_ns);
  EXPECT_GE(age_s, 1000.0);
  EXPECT_LT(age_s, 1100.0);
}

TEST_F(GrabberFiles, AVideoFileBeginsAgain) {
  make_video(path("six.avi"), 6);
  GrabberConfig config = reading("file", path("six.avi"));
  config.loop = true;
  Taken taken(config);
  ASSERT_TRUE(taken.wait([&] { return taken.seen.size() >= 14; }));
  taken.grabber().stop();
  EXPECT_EQ(taken.seen[0].width, 160);
  EXPECT_EQ(taken.states, std::vector<std::string>{"OK"});
  EXPECT_EQ(taken.grabber().failures(), 0U);
}

TEST_F(GrabberFiles, AFileThatEndsIsLostByName) {
  make_video(path("two.avi"), 2);
  Taken taken(reading("file", path("two.avi")));
  ASSERT_TRUE(taken.wait([&] { return taken.states.size() >= 2; }));
  EXPECT_EQ(taken.states.back(), "LOST: camera: the end of it was reached");
}

TEST_F(GrabberFiles, NumberedPictures) {
  make("videotestsrc pattern=ball num-buffers=5 ! video/x-raw,width=64,height=48 ! pngenc ! multifilesink location=" +
       path("eye_%03d.png"));
  CaptureSource source;
  source.kind = "images";
  source.device = path("eye_%03d.png");
  source.rate_hz = 25.0;
  Taken taken(reading(source));
  ASSERT_TRUE(taken.wait([&] { return taken.seen.size() >= 3; }));
  EXPECT_EQ(taken.seen[0].width, 64);
  EXPECT_EQ(taken.seen[0].height, 48);
}

TEST_F(GrabberFiles, AMissingFileIsNamedAndFoundWhenItComes) {
  GrabberConfig config = reading("file", path("later.avi"));
  config.retry_s = 0.1;
  config.loop = true;
  Taken taken(config);
  ASSERT_TRUE(taken.wait([&] { return !taken.states.empty(); }));
  EXPECT_EQ(taken.states[0].rfind("LOST: camera: ", 0), 0U) << taken.states[0];
  make_video(path("made.avi"), 6);
  std::filesystem::rename(path("made.avi"), path("later.avi"));
  ASSERT_TRUE(taken.wait([&] { return !taken.seen.empty(); }));
  taken.grabber().stop();
  EXPECT_EQ(taken.states.at(1), "OK");
  EXPECT_GE(taken.grabber().failures(), 1U);
}

TEST_F(GrabberFiles, WhatIsNotThereIsLostWithItsName) {
  const std::vector<std::array<std::string, 3>> absent = {{"v4l2", "/dev/video77", "/dev/video77"},
                                                          {"file", "/nowhere/none.avi", "/nowhere/none.avi"},
                                                          {"pipeline", "nosuchelement", "nosuchelement"},
                                                          {"decklink", "0", ""}};
  for (const auto& [kind, device, word] : absent) {
    GrabberConfig config = reading(kind, device);
    config.silence_s = 5.0;
    Taken taken(config);
    ASSERT_TRUE(taken.wait([&] { return !taken.states.empty(); }));
    taken.grabber().stop();
    EXPECT_EQ(taken.states[0].rfind("LOST: camera: ", 0), 0U) << taken.states[0];
    EXPECT_NE(taken.states[0].find(word), std::string::npos) << taken.states[0];
    EXPECT_TRUE(taken.seen.empty());
  }
}

TEST_F(GrabberFiles, SilenceIsLostToo) {
  GrabberConfig config =
      reading("pipeline", "appsrc is-live=true caps=video/x-raw,format=BGR,width=32,height=32,framerate=5/1");
  config.silence_s = 0.3;
  Taken taken(config);
  ASSERT_TRUE(taken.wait([&] { return !taken.states.empty(); }));
  EXPECT_EQ(taken.states[0], "LOST: camera: no picture for 0.3 s");
}

TEST_F(GrabberFiles, AReaderThatThrowsIsSaidAndAskedAgain) {
  std::mutex mutex;
  std::condition_variable news;
  std::vector<std::string> states;
  GrabberConfig config = reading("test", "ball");
  config.name = "camera";
  config.retry_s = 0.05;
  Grabber grabber(
      config, [n = 0](const Picture&) mutable { n++ == 0 ? throw std::runtime_error("no room") : void(); },
      [&](const std::string& state) {
        const std::lock_guard<std::mutex> lock(mutex);
        states.push_back(state);
        news.notify_all();
      });
  grabber.start();
  std::unique_lock<std::mutex> lock(mutex);
  ASSERT_TRUE(news.wait_for(lock, kPatience, [&] { return states.size() >= 3; }));
  EXPECT_EQ(states, (std::vector<std::string>{"OK", "LOST: camera: no room", "OK"}));
}

TEST_F(GrabberFiles, NothingComesAfterStop) {
  for (int i = 0; i < 10; ++i) {
    Taken taken(reading("test", "ball"));
    if (i % 2 == 1) {
      ASSERT_TRUE(taken.wait([&] { return !taken.seen.empty(); }));
    }
    taken.grabber().stop();
    const std::size_t seen = taken.seen.size();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(taken.seen.size(), seen);
  }
}

}  // namespace
}  // namespace saras_ros1
