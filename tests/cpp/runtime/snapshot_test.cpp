#include "saras/runtime/snapshot.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "saras/overlay/overlay_painter.hpp"

namespace saras {
namespace {

constexpr int kSize = 96;

CameraConfig camera() {
  CameraConfig config;
  config.width_px = config.height_px = kSize;
  config.K << 60, 0, 48, 0, 60, 48, 0, 0, 1;
  config.P.leftCols<3>() = config.K;
  config.P.col(3).setZero();
  return config;
}

/// What the writers of the overlay's node know, and whether it may be shown as green.
struct Heard {
  ToolOverlayInput input;
  bool may_be_green = false;
};

Heard heard(std::uint64_t n) {
  Heard value;
  OverlayTool& tool = value.input.tools[0];
  value.input.count = 1;
  value.input.camera_age_s = 0.0;
  tool.tip = Vector3(-0.05, 0.0, 0.1);
  tool.trocar = Vector3(0.05, 0.0, 0.1);
  tool.distance_m = n % 3 == 0 ? std::numeric_limits<double>::quiet_NaN() : 0.05;
  tool.state = n % 5 == 0 ? ProximityState::kUnknown : ProximityState::kClear;
  value.input.distances_age_s = n % 7 == 0 ? 1.0 : 0.01;
  value.input.tools_age_s = n % 11 == 0 ? 1.0 : 0.01;
  value.may_be_green = n % 3 != 0 && n % 5 != 0 && n % 7 != 0 && n % 11 != 0;
  return value;
}

bool has_green(const std::vector<std::uint8_t>& rgb) {
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    if (rgb[i + 1] > rgb[i] + 40 && rgb[i + 1] > rgb[i + 2] + 40) {
      return true;
    }
  }
  return false;
}

// Run by script/sanitize thread as well: the sanitizer is the judge of the lock.
TEST(Snapshot, UnderContentionNoPictureIsGreenThatMustNotBe) {
  Snapshot<Heard> snapshot(heard(0));
  std::atomic<bool> stop{false};
  std::vector<std::thread> writers;
  for (std::uint64_t writer = 0; writer < 2; ++writer) {
    writers.emplace_back([&snapshot, &stop, writer] {
      for (std::uint64_t n = writer; !stop; n += 2) {
        if (n % 2 == 0) {
          snapshot.write(heard(n));
        } else {
          snapshot.change([n](Heard& value) { value = heard(n); });
        }
      }
    });
  }
  // Two eyes that draw at the same time.
  std::atomic<int> unsafe{0}, green{0};
  std::vector<std::thread> eyes;
  for (int eye = 0; eye < 2; ++eye) {
    eyes.emplace_back([&] {
      const OverlayPainter painter(camera(), {});
      ToolOverlay law({});
      // A busy machine may let the writers wait for long.
      for (int frame = 0; frame < 300 || (green == 0 && frame < 100'000); ++frame) {
        std::vector<std::uint8_t> rgb(kSize * kSize * 3, 30);
        const Heard now = snapshot.read();
        painter.draw(law.step(now.input, 0.04), {rgb.data(), kSize, kSize, kSize * 3, PixelFormat::kRgb8});
        const bool is_green = has_green(rgb);
        unsafe += is_green && !now.may_be_green ? 1 : 0;
        green += is_green ? 1 : 0;
      }
    });
  }
  for (std::thread& eye : eyes) {
    eye.join();
  }
  stop = true;
  for (std::thread& writer : writers) {
    writer.join();
  }
  EXPECT_EQ(unsafe, 0);
  EXPECT_GT(green, 0) << "the test would see nothing";
}

TEST(Snapshot, NoUpdateIsLost) {
  Snapshot<long> sum(0);
  std::vector<std::thread> writers;
  for (int writer = 0; writer < 4; ++writer) {
    writers.emplace_back([&sum] {
      for (int i = 0; i < 20000; ++i) {
        sum.change([](long& value) { ++value; });
      }
    });
  }
  for (std::thread& writer : writers) {
    writer.join();
  }
  EXPECT_EQ(sum.read(), 80000);
}

}  // namespace
}  // namespace saras
