// What the loop does each time allocates nothing: receiving, checking, answering, recording.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "pipeline/rig.hpp"
#include "saras/runtime/clock.hpp"
#include "saras/runtime/console_socket.hpp"
#include "saras/runtime/flight_recorder.hpp"
#include "support/malloc_counter.hpp"

namespace saras {
namespace {

constexpr Seconds kDt = 0.001;

TEST(FlightRecorder, RecordingAllocatesNothing) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  Pipeline pipeline(test::pipeline_config(true));
  FlightRecorder recorder(3, 20);
  test::PipelineRig rig(4);
  rig.next();
  const test::MallocCounter counter;
  for (int k = 0; k < 200; ++k) {
    FlightTick* tick = recorder.begin(pipeline);
    ASSERT_NE(tick, nullptr);
    tick->input = rig.input();
    tick->output = pipeline.step(tick->input, kDt);
    recorder.commit();
  }
  EXPECT_EQ(counter.count(), 0u);
}

class Links : public testing::TestWithParam<bool> {};

TEST_P(Links, ReceivingAndAnsweringAllocatesNothing) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  const bool keyed = GetParam();
  const int peer = socket(AF_INET, SOCK_DGRAM, 0);
  ConsoleSocketConfig config;
  config.bind_port = 0;
  config.keyed = keyed;
  ConsoleSocket link(config);
  SessionKeys keys;
  keys.up.fill(1);
  keys.down.fill(2);
  link.set_session(keys);
  const HmacSha256 up_key(keys.up);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port = htons(static_cast<std::uint16_t>(link.port()));
  const test::MallocCounter counter;
  for (std::uint64_t seq = 1; seq <= 50; ++seq) {
    TouchballUp up;
    up.session = 3;
    up.seq = seq;
    up.sender_time_ns = monotonic_ns();
    up.left.present = true;
    TouchballUpBytes bytes;
    ASSERT_FALSE(encode(up, bytes, keyed ? Authentication::kTag : Authentication::kNone));
    if (keyed) {
      seal(bytes.data(), bytes.size(), up_key.tag(bytes.data(), bytes.size() - kTouchballTrailerSize).data());
    }
    for (int copies = 0; copies < 2; ++copies) {  // the second one is refused
      sendto(peer, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
    }
    bool came = false;
    for (int i = 0; i < 100000 && !came; ++i) {
      came = link.receive(monotonic_ns());
    }
    ASSERT_TRUE(came);
    TouchballDown down;
    link.send(down, monotonic_ns());
  }
  EXPECT_EQ(counter.count(), 0u);
  close(peer);
}

INSTANTIATE_TEST_SUITE_P(, Links, testing::Bool());

}  // namespace
}  // namespace saras
