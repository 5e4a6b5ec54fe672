#include "saras/runtime/flight_recorder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <thread>

#include "pipeline/rig.hpp"
#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

/// A file that is gone after the test.
struct TemporaryFile {
  TemporaryFile() {
    char name[] = "/tmp/saras_flight_XXXXXX";
    const int descriptor = mkstemp(name);
    close(descriptor);
    path = name;
  }
  ~TemporaryFile() { std::remove(path.c_str()); }
  std::string path;
};

void fly(FlightRecorder& recorder, Pipeline& pipeline, test::PipelineRig& rig, std::uint64_t begin, std::uint64_t end) {
  FlightTick spare;
  for (std::uint64_t k = begin; k < end; ++k) {
    FlightTick* record = recorder.begin(pipeline);
    FlightTick& tick = record != nullptr ? *record : spare;
    tick.index = k;
    tick.dt_s = rig.random().uniform(5e-4, 2e-3);
    tick.input = rig.next();
    tick.input.overrun = rig.random().chance(0.02);
    tick.input.sides[1].nearness.distance_m = rig.random().chance(0.1) ? test::kNan : 0.01;
    tick.output = pipeline.step(tick.input, tick.dt_s);
    rig.follow(tick.output);
    if (record != nullptr) {
      recorder.commit();
    }
  }
}

class FlightRecords : public testing::TestWithParam<bool> {};

TEST_P(FlightRecords, ReplayToTheBit) {
  const PipelineConfig config = test::pipeline_config(GetParam());
  Pipeline pipeline(config);
  FlightRecorder recorder(5, 100);
  test::PipelineRig rig(1);
  const TemporaryFile file;
  // Before the ring is full, and after it went round.
  for (const auto& [begin, end] : {std::pair<std::uint64_t, std::uint64_t>{0, 250}, {250, 1730}}) {
    fly(recorder, pipeline, rig, begin, end);
    recorder.close();
    const std::uint64_t written = recorder.write(file.path, config, "a test");
    const FlightRecord record = read_flight(file.path);
    EXPECT_EQ(record.reason, "a test");
    EXPECT_EQ(record.chunks.back().ticks.back().index, end - 1);
    const FlightReplay replay = replay_flight(record);
    EXPECT_EQ(replay.ticks, written);
    EXPECT_EQ(replay.exact, written);
    EXPECT_EQ(replay.states_exact, replay.states);
    EXPECT_EQ(replay.states, record.chunks.size() - 1);
    EXPECT_EQ(replay.first_difference, -1);
  }
}

INSTANTIATE_TEST_SUITE_P(, FlightRecords, testing::Bool());

TEST(FlightRecorder, AChangedNumberIsSeen) {
  const PipelineConfig config = test::pipeline_config(false);
  Pipeline pipeline(config);
  FlightRecorder recorder(3, 100);
  test::PipelineRig rig(2);
  const TemporaryFile file;
  fly(recorder, pipeline, rig, 0, 150);
  recorder.close();
  recorder.write(file.path, config, "");
  FlightRecord record = read_flight(file.path);
  record.chunks[0].ticks[70].input.sides[0].handle.simball_T_handle.translation.x() += 1e-9;
  const FlightReplay replay = replay_flight(record);
  EXPECT_EQ(replay.first_difference, 70);
  EXPECT_LT(replay.exact, replay.ticks);
}

TEST(FlightRecorder, RefusesWhatIsNoRecord) {
  const PipelineConfig config = test::pipeline_config(false);
  Pipeline pipeline(config);
  FlightRecorder recorder(3, 50);
  test::PipelineRig rig(3);
  const TemporaryFile file;
  EXPECT_THROW(read_flight("/nowhere/at/all"), Error);
  EXPECT_THROW(read_flight(file.path), ProtocolError);
  fly(recorder, pipeline, rig, 0, 60);
  recorder.close();
  recorder.write(file.path, config, "");
  std::ifstream in(file.path, std::ios::binary);
  const std::string good((std::istreambuf_iterator<char>(in)), {});
  for (const std::size_t length : {std::size_t{0}, std::size_t{7}, std::size_t{8}, std::size_t{64}, good.size() / 2,
                                   good.size() / 16 * 8, good.size() - 8, good.size() - 1}) {
    std::ofstream(file.path, std::ios::binary | std::ios::trunc) << good.substr(0, length);
    EXPECT_THROW(read_flight(file.path), ProtocolError) << length;
  }
  std::string other = good;
  other[8] = 99;
  std::ofstream(file.path, std::ios::binary | std::ios::trunc) << other;
  EXPECT_THROW(read_flight(file.path), ProtocolError);
  EXPECT_THROW(recorder.write("/nowhere/at/all", config, ""), Error);
}

// Run by script/sanitize thread as well.
TEST(FlightRecorder, IsWrittenWhileItRecords) {
  const PipelineConfig config = test::pipeline_config(false);
  FlightRecorder recorder(6, 50);
  const TemporaryFile file;
  std::atomic<bool> stop{false};
  std::thread loop([&] {
    Pipeline pipeline(config);
    test::PipelineRig rig(5);
    for (std::uint64_t k = 0; !stop; k += 10) {
      fly(recorder, pipeline, rig, k, k + 10);
      std::this_thread::yield();
    }
  });
  for (int i = 0; i < 10; ++i) {
    recorder.request_close();
    while (recorder.close_pending()) {
      std::this_thread::yield();
    }
    recorder.write(file.path, config, "while it records");
    const FlightReplay replay = replay_flight(read_flight(file.path));
    EXPECT_TRUE(replay.ticks > 0 || i == 0) << "only the first may come before any step";
    EXPECT_EQ(replay.exact, replay.ticks);
    EXPECT_EQ(replay.states_exact, replay.states);
  }
  stop = true;
  loop.join();
}

}  // namespace
}  // namespace saras
