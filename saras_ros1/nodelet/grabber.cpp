#include "grabber.hpp"

#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>

#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

using Steady = std::chrono::steady_clock;

constexpr GstClockTime kPoll_ns = 50'000'000;
constexpr std::int64_t kOldest_ns = 5'000'000'000;  // an older time is none: a source without sensible ones
constexpr const char* kEnd = "end";                 // of a file; what play() says then
// sync: files at their own speed. drop: a reader that is slow gets the newest picture.
constexpr const char* kSink =
    " ! videoconvert ! video/x-raw,format=BGR ! appsink name=out max-buffers=2 drop=true sync=true";

template <auto Free>
struct Freed {
  template <typename T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Message = std::unique_ptr<GstMessage, Freed<gst_message_unref>>;
using Sample = std::unique_ptr<GstSample, Freed<gst_sample_unref>>;
template <typename T>
using Object = std::unique_ptr<T, Freed<gst_object_unref>>;

void begin_gstreamer() {
  GError* error = nullptr;
  if (gst_init_check(nullptr, nullptr, &error) == FALSE) {
    const std::string why = error != nullptr ? error->message : "no reason given";
    g_clear_error(&error);
    throw saras::Error("GStreamer does not start: " + why);
  }
}

/// A sentence without its full stop.
std::string sentence(std::string text) {
  while (!text.empty() && (text.back() == '.' || text.back() == ' ' || text.back() == '\n')) {
    text.pop_back();
  }
  return text;
}

/// What an error says; frees it.
std::string words(GError* error) {
  std::string text = sentence(error != nullptr ? error->message : "no reason given");
  g_clear_error(&error);
  return text;
}

/// The last line of what GStreamer tells developers: which file or device it was.
std::string detail(gchar* debug) {
  const std::string all = debug != nullptr ? debug : "";
  g_free(debug);
  const std::size_t line = all.find_last_of('\n');
  return line == std::string::npos ? "" : sentence(all.substr(line + 1));
}

/// What ended the pipeline, if something did.
std::optional<std::string> failure(GstBus* bus) {
  const auto kinds = static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS);
  const Message message(gst_bus_pop_filtered(bus, kinds));
  if (!message) {
    return std::nullopt;
  }
  if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) {
    return kEnd;
  }
  GError* error = nullptr;
  gchar* debug = nullptr;
  gst_message_parse_error(message.get(), &error, &debug);
  const std::string more = detail(debug);
  return std::string(GST_OBJECT_NAME(GST_MESSAGE_SRC(message.get()))) + ": " + words(error) +
         (more.empty() ? "" : ": " + more);
}

/// A pipeline that is stopped when it goes out of scope, whatever happens.
struct Pipeline {
  explicit Pipeline(GstElement* made) : element(made) {}
  ~Pipeline() { gst_element_set_state(element.get(), GST_STATE_NULL); }
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;
  Object<GstElement> element;
};

/// How long ago a buffer's picture was taken, by the pipeline's clock; 0 where that says nothing.
std::int64_t age_ns(GstElement* pipeline, GstSample* sample) {
  const GstBuffer* buffer = gst_sample_get_buffer(sample);
  const Object<GstClock> clock(gst_element_get_clock(pipeline));
  if (!clock || !GST_BUFFER_PTS_IS_VALID(buffer)) {
    return 0;
  }
  const GstClockTime running =
      gst_segment_to_running_time(gst_sample_get_segment(sample), GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
  if (!GST_CLOCK_TIME_IS_VALID(running)) {
    return 0;
  }
  const auto age = static_cast<std::int64_t>(gst_clock_get_time(clock.get()) - gst_element_get_base_time(pipeline)) -
                   static_cast<std::int64_t>(running);
  return age >= 0 && age <= kOldest_ns ? age : 0;
}

std::int64_t epoch_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// The pixels of a sample, mapped while this lives.
class MappedPicture {
 public:
  explicit MappedPicture(GstSample* sample) {
    const GstCaps* caps = gst_sample_get_caps(sample);
    GstBuffer* buffer = gst_sample_get_buffer(sample);
    mapped_ = caps != nullptr && buffer != nullptr && gst_video_info_from_caps(&info_, caps) != FALSE &&
              gst_video_frame_map(&frame_, &info_, buffer, GST_MAP_READ) != FALSE;
  }
  ~MappedPicture() {
    if (mapped_) {
      gst_video_frame_unmap(&frame_);
    }
  }
  MappedPicture(const MappedPicture&) = delete;
  MappedPicture& operator=(const MappedPicture&) = delete;
  explicit operator bool() const { return mapped_; }
  saras::ImageView pixels() const {
    saras::ImageView view;
    view.data = static_cast<std::uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame_, 0));
    view.width = GST_VIDEO_FRAME_WIDTH(&frame_);
    view.height = GST_VIDEO_FRAME_HEIGHT(&frame_);
    view.stride = static_cast<std::size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame_, 0));
    view.format = saras::PixelFormat::kBgr8;
    return view;
  }

 private:
  GstVideoInfo info_{};
  GstVideoFrame frame_{};
  bool mapped_ = false;
};

}  // namespace

Grabber::Grabber(GrabberConfig config, OnPicture on_picture, OnState on_state)
    : config_(std::move(config)), on_picture_(std::move(on_picture)), on_state_(std::move(on_state)) {
  begin_gstreamer();
}

void Grabber::start() { thread_ = std::thread(&Grabber::run, this); }

void Grabber::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  ending_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

std::string Grabber::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

void Grabber::say(const std::string& state) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (state == state_) {
      return;
    }
    state_ = state;
  }
  on_state_(state);
}

void Grabber::wait_to_retry() {
  std::unique_lock<std::mutex> lock(mutex_);
  ending_.wait_for(lock, std::chrono::duration<double>(config_.retry_s), [this] { return ends_.load(); });
}

void Grabber::run() {
  while (!ends_) {
    const std::uint64_t before = pictures_;
    std::string why;
    try {
      why = play();
    } catch (const std::exception& error) {  // of a callback: it must not end the process, and the others in it
      why = error.what();
    }
    if (ends_) {
      return;
    }
    if (why == kEnd && config_.loop && pictures_ > before) {  // one without any would begin again for ever
      continue;
    }
    ++failures_;
    say("LOST: " + config_.name + ": " + (why == kEnd ? "the end of it was reached" : why));
    wait_to_retry();
  }
}

/// Until something ends it: what that was.
std::string Grabber::play() {
  GError* error = nullptr;
  GstElement* made = gst_parse_launch((config_.source + kSink).c_str(), &error);
  if (made == nullptr) {
    return words(error);
  }
  gst_object_ref_sink(made);
  const Pipeline pipeline(made);
  if (error != nullptr) {  // GStreamer would go on without the element that it does not have
    return words(error);
  }
  const Object<GstElement> out(gst_bin_get_by_name(GST_BIN(made), "out"));
  const Object<GstBus> bus(gst_element_get_bus(made));
  if (gst_element_set_state(made, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) {
    return failure(bus.get()).value_or("it cannot be started");
  }
  auto heard = Steady::now();
  while (!ends_) {
    const Sample sample(gst_app_sink_try_pull_sample(GST_APP_SINK(out.get()), kPoll_ns));
    if (!sample) {
      if (const auto why = failure(bus.get())) {
        return *why;
      }
      if (std::chrono::duration<double>(Steady::now() - heard).count() > config_.silence_s) {
        std::ostringstream text;
        text << "no picture for " << config_.silence_s << " s";
        return text.str();
      }
      if (gst_app_sink_is_eos(GST_APP_SINK(out.get())) != FALSE) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));  // its message is under way
      }
      continue;
    }
    heard = Steady::now();
    Picture picture;
    picture.taken_ns = epoch_ns() - age_ns(made, sample.get()) - std::llround(1e9 * config_.latency_s);
    const MappedPicture mapped(sample.get());
    if (!mapped) {
      return "a picture without a format";
    }
    picture.pixels = mapped.pixels();
    ++pictures_;
    say("OK");
    on_picture_(picture);
  }
  return "stopped";
}

}  // namespace saras_ros1
