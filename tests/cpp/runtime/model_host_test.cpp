#include "saras/runtime/model_host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <thread>

#include "saras/model/model_error.hpp"
#include "saras/spatial/errors.hpp"
#include "support/touched_plane.hpp"

namespace saras {
namespace {

using test::plate_mesh;
using test::press_plate;
using test::RandomValues;

constexpr double kDt_s = 1e-3;

IndexedMeshPointer plate(int count) { return std::make_shared<IndexedMesh>(plate_mesh(count)); }

StampedTouch sample(int i, RandomValues& random) {
  const StiffnessGpInput input = press_plate(kDt_s * i, random);
  return {100.0 + kDt_s * i, input.tip_position, input.force, Vector3::Zero()};
}

template <typename Condition>
bool eventually(Condition&& condition) {
  for (int i = 0; i < 6000; ++i) {
    if (condition()) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

std::uint64_t count(const ModelHostStatistics& statistics, SampleVerdict verdict) {
  return statistics.verdicts[static_cast<std::size_t>(verdict)];
}

int known(const ModelView& view) {
  return static_cast<int>(std::count_if(view.estimates.begin(), view.estimates.end(),
                                        [](const auto& e) { return std::isfinite(e.stiffness_N_m); }));
}

TEST(TouchQueue, GivesBackInTheOrderOfStampsAndDropsTheOldest) {
  TouchQueue queue(3);
  for (const double stamp : {5.0, 2.0, 4.0}) {
    EXPECT_TRUE(queue.push({stamp}));
  }
  EXPECT_FALSE(queue.push({3.0}));
  std::vector<StampedTouch> taken;
  queue.take(taken);
  ASSERT_EQ(taken.size(), 3u);
  EXPECT_EQ(taken[0].stamp_s, 2.0);
  EXPECT_EQ(taken[1].stamp_s, 3.0);
  EXPECT_EQ(taken[2].stamp_s, 4.0);
  EXPECT_EQ(queue.dropped(), 1u);
  EXPECT_EQ(queue.waiting(), 0);
}

TEST(ModelHost, ThreadsLearnEverySampleWhileOthersLookLayAndForget) {
  RandomValues random(1);
  ModelHostConfig config;
  config.room = 100000;
  ModelHost host(plate(41), config);
  host.start();
  EXPECT_THROW(host.start(), Error);
  std::atomic<bool> over{false};
  std::thread looker([&] {
    while (!over) {
      const ModelView view = host.view();
      ASSERT_EQ(view.estimates.size(), view.laid->mesh.vertices.size());
      host.lay(plate(41), view.generation);
      host.wait_touched(0.01);
      host.take_touched();
      host.statistics();
    }
  });
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    EXPECT_TRUE(host.push(sample(i, random)));
  }
  EXPECT_TRUE(eventually([&] {
    const auto now = host.statistics();
    return count(now, SampleVerdict::kLearned) == kSamples && now.learning.count == kSamples;
  }));
  EXPECT_TRUE(eventually([&] { return known(host.view()) > 900 && host.statistics().stale == 0; }));
  over = true;
  looker.join();
  const ModelView before = host.view();
  for (const VertexEstimate& estimate : before.estimates) {
    EXPECT_EQ(std::isnan(estimate.stiffness_N_m), std::isinf(estimate.stiffness_std_N_m));
    if (estimate.stiffness_std_N_m < 20.0) {
      EXPECT_NEAR(estimate.stiffness_N_m, test::kPlateStiffness_N_m, 80.0);
    }
  }
  host.reset(plate(21));
  EXPECT_EQ(known(host.view()), 0);
  EXPECT_EQ(host.statistics().places, 0);
  EXPECT_FALSE(host.lay(plate(21), before.generation));
  EXPECT_THROW(host.lay(plate(41), host.view().generation), ModelError);
  EXPECT_FALSE(host.adopt({}, before.generation));
  host.stop();
  host.stop();
  EXPECT_EQ(host.failure(), "");
}

TEST(ModelHost, TheThreadsTellWhatTheCallersOwnThreadWould) {
  RandomValues one(2);
  RandomValues two(2);
  ModelHost threaded(plate(31));
  ModelHost stepped(plate(31));
  threaded.start();
  for (int i = 0; i < 5000; ++i) {
    threaded.push(sample(i, one));
    stepped.push(sample(i, two));
    if (i % 40 == 0) {
      stepped.learn_waiting();
      stepped.refresh(false);
    }
    ASSERT_TRUE(i % 40 != 0 || eventually([&] { return threaded.statistics().waiting < 1000; }));
  }
  ASSERT_TRUE(eventually([&] { return count(threaded.statistics(), SampleVerdict::kLearned) == 5000; }));
  threaded.stop();
  stepped.learn_waiting();
  threaded.refresh();
  stepped.refresh();
  const auto a = threaded.view().estimates;
  const auto b = stepped.view().estimates;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_TRUE(a[i].stiffness_std_N_m == b[i].stiffness_std_N_m) << i;
    EXPECT_TRUE(std::isnan(a[i].stiffness_N_m) ? std::isnan(b[i].stiffness_N_m)
                                               : a[i].stiffness_N_m == b[i].stiffness_N_m)
        << i;
  }
}

TEST(ModelHost, TouchedAreTheVerticesNearTheTipOnceEach) {
  RandomValues random(3);
  ModelHost host(plate(41));
  std::set<std::int32_t> seen;
  for (int i = 0; i < 3000; ++i) {
    const StampedTouch touch = sample(i, random);
    host.push(touch);
    if (i % 33 != 0 || i == 0) {
      continue;
    }
    host.learn_waiting();
    host.refresh(false);
    const TouchedVertices touched = host.take_touched();
    const std::set<std::int32_t> once(touched.vertices.begin(), touched.vertices.end());
    EXPECT_EQ(once.size(), touched.vertices.size());
    ASSERT_EQ(touched.estimates.size(), touched.vertices.size());
    for (const std::int32_t vertex : touched.vertices) {
      const Vector3& at = touched.laid->mesh.vertices[static_cast<std::size_t>(vertex)];
      EXPECT_LT((at - touch.position).norm(), host.config().near_m + 4e-3);
    }
    for (std::size_t v = 0; v < touched.laid->mesh.vertices.size(); ++v) {
      if ((touched.laid->mesh.vertices[v] - touch.position).norm() < 0.5 * host.config().near_m) {
        EXPECT_EQ(once.count(static_cast<std::int32_t>(v)), 1u) << i << " " << v;
      }
    }
    seen.insert(once.begin(), once.end());
  }
  EXPECT_FALSE(host.wait_touched(0.0));
  EXPECT_GT(seen.size(), 100u);
}

TEST(ModelHost, FarOutsideTheSensorsOffsetIsTaken) {
  ModelHost host(plate(11));
  for (int i = 0; i < 3000; ++i) {
    host.push({kDt_s * i, {0.0, 0.0, 0.02}, {0.0, 0.1, 0.2}, Vector3::Zero()});
  }
  host.learn_waiting();
  const ModelHostStatistics now = host.statistics();
  EXPECT_EQ(count(now, SampleVerdict::kNotTouching), 3000u);
  EXPECT_NEAR(now.bias_N.z(), 0.2, 0.01);
  host.push({4.0, {test::kNan, 0.0, 0.0}, Vector3::Zero(), Vector3::Zero()});
  host.learn_waiting();
  EXPECT_EQ(count(host.statistics(), SampleVerdict::kInvalid), 1u);
}

TEST(ModelHost, RefusesWhatCannotWork) {
  ModelHostConfig config;
  config.map_hz = 2.0 * config.touched_hz;
  EXPECT_THROW(ModelHost(plate(5), config), ConfigError);
  EXPECT_THROW(ModelHost(nullptr), ConfigError);
  EXPECT_THROW(IndexedMesh(SurfaceMesh{}), ModelError);
}

}  // namespace
}  // namespace saras
