// Laws and painters of the room allocate nothing, whatever the input.
#include <gtest/gtest.h>

#include "saras/overlay/awareness_inset.hpp"
#include "saras/overlay/image_watch.hpp"
#include "saras/overlay/overlay_painter.hpp"
#include "saras/overlay/stiffness_overlay.hpp"
#include "support/no_allocation.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

ToolOverlayInput five_tools() {
  ToolOverlayInput in;
  in.count = 5;
  in.distances_age_s = in.tools_age_s = in.camera_age_s = 0.0;
  for (int i = 0; i < 5; ++i) {
    OverlayTool& tool = in.tools[static_cast<std::size_t>(i)];
    tool.name = ShortText("PSM1");
    tool.tip = Vector3(0.01 * i, 0, 0.1);
    tool.trocar = Vector3(0.01, 0.05 * i, -0.1);
    tool.on_tool = tool.tip;
    tool.on_partner = tool.tip + Vector3(0.01, 0.01, 0);
    tool.distance_m = tool.known_distance_m = 0.004 * i;
    tool.state = ProximityState::kClear;
  }
  return in;
}

CameraConfig camera(bool rectified) {
  CameraConfig config;
  config.width_px = 640;
  config.height_px = 480;
  config.K << 500, 0, 320, 0, 500, 240, 0, 0, 1;
  config.P << 500, 0, 320, -2, 0, 500, 240, 0, 0, 0, 1, 0;
  config.distortion = {-0.3, 0.1, 0.001, 0.001, 0.0, 0.0, 0.0, 0.0};
  config.rectified = rectified;
  return config;
}

TEST(OverlayAllocation, ToolOverlay) {
  ToolOverlayInput in = five_tools();
  test::expect_no_allocation(ToolOverlay({}), in,
                             {&in.tools[0].tip.x(), &in.tools[1].distance_m, &in.camera_T_world.translation.z()});
}
TEST(OverlayAllocation, FrozenWatch) {
  FrozenWatchInput in;
  double unused = 0.0;
  test::expect_no_allocation(FrozenWatch({}), in, {&unused});
}
TEST(OverlayAllocation, StereoPairing) {
  StereoPairingInput in{EyeSide::kLeft, 5};
  double unused = 0.0;
  test::expect_no_allocation(StereoPairing({}), in, {&unused});
}
TEST(OverlayAllocation, Painters) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  std::vector<std::uint8_t> pixels(640 * 480 * 4);
  ToolOverlay law({});
  ToolOverlayInput in = five_tools();
  const NoticePainter notices;
  for (const bool rectified : {true, false}) {
    const OverlayPainter painter(camera(rectified), {});
    for (const PixelFormat format : {PixelFormat::kBgr8, PixelFormat::kMono8, PixelFormat::kRgba8}) {
      const ImageView image{pixels.data(), 640, 480, static_cast<std::size_t>(640 * channels(format)), format};
      for (const double value : {0.1, -0.2, test::kNan, 1e9}) {
        in.tools[2].tip.z() = value;
        const ToolOverlayOutput out = law.step(in, 0.04);
        const test::MallocCounter counter;
        EXPECT_TRUE(painter.draw(out, image));
        notices.draw(OverlayNotice::kFrozen, image);
        const std::size_t allocations = counter.count();
        EXPECT_EQ(allocations, 0u);
      }
    }
  }
}
TEST(OverlayAllocation, AwarenessInset) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  std::vector<std::uint8_t> pixels(640 * 480 * 3);
  const ImageView image{pixels.data(), 640, 480, 640 * 3, PixelFormat::kBgr8};
  const AwarenessInset inset(640, 480, {});
  AwarenessView view;
  view.known = true;
  view.text = ShortText("FULL CONTACT");
  view.center = view.tip = view.proxy = view.closest = Vector3(0.1, 0.0, -0.1);
  view.force_N = Vector3(0.0, 0.0, 2.0);
  view.region_corners = kMaxRegionCorners;
  for (const double value : {0.1, -0.2, test::kNan, 1e9}) {
    view.proxy.x() = view.region[3].y() = view.normal.z() = value;
    const test::MallocCounter counter;
    EXPECT_TRUE(inset.draw(view, image));
    const std::size_t allocations = counter.count();
    EXPECT_EQ(allocations, 0u);
  }
}
TEST(OverlayAllocation, StiffnessOverlay) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  std::vector<std::uint8_t> pixels(640 * 480 * 3);
  const ImageView image{pixels.data(), 640, 480, 640 * 3, PixelFormat::kBgr8};
  std::vector<MapVertex> vertices = {{{0.0, 0.0, 0.1}, 300.0, 10.0}, {{0.02, 0.0, 0.1}, 900.0, 10.0}, {{0, 0.02, 0.1}}};
  const std::vector<MapTriangle> triangles = {{0, 1, 2}, {2, 1, 0}, {0, 1, 7}, {-1, 1, 2}};
  StiffnessMapView map;
  map.vertices = vertices.data();
  map.vertex_count = static_cast<int>(vertices.size());
  map.triangles = triangles.data();
  map.triangle_count = static_cast<int>(triangles.size());
  for (const bool rectified : {true, false}) {
    StiffnessOverlay overlay(camera(rectified), {});
    for (const double value : {0.1, -0.2, test::kNan, 1e9}) {
      vertices[0].at.z() = vertices[1].std_N_m = value;
      const test::MallocCounter counter;
      EXPECT_TRUE(overlay.draw(map, image));
      EXPECT_TRUE(overlay.draw_unknown(image));
      const std::size_t allocations = counter.count();
      EXPECT_EQ(allocations, 0u);
    }
  }
}

}  // namespace
}  // namespace saras
