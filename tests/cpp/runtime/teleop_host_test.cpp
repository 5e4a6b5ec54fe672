#include "saras/runtime/teleop_host.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "pipeline/rig.hpp"
#include "saras/runtime/clock.hpp"
#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

/// A console of a few lines.
class Peer {
 public:
  Peer() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bind(socket_, reinterpret_cast<sockaddr*>(&own), sizeof(own));
    timeval patience{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  }
  ~Peer() { close(socket_); }
  int port() const {
    sockaddr_in own{};
    socklen_t size = sizeof(own);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
    return ntohs(own.sin_port);
  }
  void send(int port, const void* data, std::size_t size) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    sendto(socket_, data, size, 0, reinterpret_cast<sockaddr*>(&to), sizeof(to));
  }
  TouchballDown receive() const {
    std::array<std::uint8_t, 2048> data;
    const ssize_t size = recv(socket_, data.data(), data.size(), 0);
    EXPECT_GT(size, 0) << "no datagram came";
    return decode_down(data.data(), static_cast<std::size_t>(std::max<ssize_t>(0, size)));
  }

 private:
  int socket_;
};

HostConfig config_for(const Peer& peer) {
  HostConfig config;
  config.loop.realtime = {0, false};
  config.loop.hold_after_s = 5.0;
  config.console.bind_port = 0;
  config.console.console_port = peer.port();
  config.console.age_limit_s = 10.0;
  config.pipeline = test::pipeline_config(false);
  config.pipeline.proximity_slowdown = config.pipeline.proximity_force = false;
  config.pipeline.handle_timeout_s = config.pipeline.arm_timeout_s = config.pipeline.channel_timeout_s = 10.0;
  config.record_s = 3.0;
  return config;
}

TouchballUp up(std::uint64_t seq) {
  TouchballUp packet;
  packet.session = 5;
  packet.seq = seq;
  packet.sender_time_ns = static_cast<std::int64_t>(seq) * 1'000'000;
  for (TouchballUpSide* side : {&packet.left, &packet.right}) {
    side->present = side->calibrated = true;
    side->simball_T_handle.translation = {0.00002 * static_cast<double>(seq), 0.0, -0.2};
  }
  return packet;
}

void feed(TeleopHost& host, std::int64_t stamp_ns) {
  for (int side = 0; side < kSides; ++side) {
    host.set_arm_rcm(side, {0.18, 0.0, -0.10});
    host.set_arm_pose(side, {Quaternion(0, 1, 0, 0), Vector3(0.18, 0.0, -0.18)}, stamp_ns);
    host.set_arm_wrench(side, {});
    host.set_supervisor(side, ChannelState::kEngaged, 1, false);
  }
}

TEST(TeleopHost, AnswersEachDatagramAndItsRecordReplays) {
  const Peer peer;
  TeleopHost host(config_for(peer));
  feed(host, 1);
  host.start();
  TouchballDown down;
  for (std::uint64_t seq = 1; seq <= 300; ++seq) {
    feed(host, static_cast<std::int64_t>(seq) * 1'000'000 + 1);
    const TouchballUpBytes bytes = encode(up(seq));
    peer.send(host.console().port(), bytes.data(), bytes.size());
    do {
      down = peer.receive();
    } while (down.echo_seq != seq);
  }
  EXPECT_EQ(down.left.state, ChannelState::kEngaged);
  EXPECT_EQ(down.left.engagement, 1u);
  HostSnapshot snapshot;
  while (snapshot.up.seq != 300 && host.wait(20.0)) {  // the answer is sent before the observers are told
    snapshot = host.snapshot();
  }
  EXPECT_EQ(snapshot.up.seq, 300u);
  EXPECT_TRUE(snapshot.tick.output.sides[0].has_set_point);
  EXPECT_FALSE(snapshot.held);
  EXPECT_NEAR(snapshot.tick.dt_s, 0.001, 1e-12) << "by the sender's clock";

  const std::string path = testing::TempDir() + "saras_host.flight";
  EXPECT_GE(host.write_record(path, "while it runs"), 299u);
  const FlightReplay replay = replay_flight(read_flight(path));
  EXPECT_EQ(replay.exact, replay.ticks);
  std::remove(path.c_str());
  host.stop();
  EXPECT_EQ(host.console().counts().accepted, 300u);
  EXPECT_EQ(host.statistics().steps - host.statistics().silent_steps, 300u);
  EXPECT_EQ(host.statistics().reply.count, 300u);
}

TEST(TeleopHost, GoesOnWithoutAConsoleAndSaysSo) {
  const Peer peer;
  HostConfig config = config_for(peer);
  config.pipeline.handle_timeout_s = 0.05;
  TeleopHost host(config);
  feed(host, 1);
  host.start();
  for (int i = 0; i < 5; ++i) {
    const TouchballDown down = peer.receive();
    EXPECT_EQ(down.echo_session, 0u);
    EXPECT_EQ(to_vector(down.left.touch_wrench), Vector6::Zero());
  }
  EXPECT_TRUE(host.wait(20.0));
  EXPECT_FALSE(host.snapshot().has_up);
  host.stop();
  EXPECT_EQ(host.statistics().steps, host.statistics().silent_steps);
}

TEST(TeleopHost, CountsWhatItRefuses) {
  const Peer peer;
  TeleopHost host(config_for(peer));
  host.start();
  const TouchballUpBytes good = encode(up(7));
  TouchballUpBytes bad = good;
  bad[200] ^= 255;
  const int port = host.console().port();
  peer.send(port, bad.data(), bad.size());
  peer.send(port, good.data(), good.size() - 1);
  peer.send(port, good.data(), 0);
  peer.send(port, good.data(), good.size());
  peer.send(port, good.data(), good.size());
  TouchballUp old = up(9);
  old.session = 4;
  const TouchballUpBytes before = encode(old);
  peer.send(port, before.data(), before.size());
  ConsoleCounts counts;
  for (int i = 0; i < 2000 && counts.old_session == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    counts = host.console().counts();
  }
  host.stop();
  EXPECT_EQ(counts.malformed, 3u);
  EXPECT_EQ(counts.accepted, 1u);
  EXPECT_EQ(counts.duplicate, 1u);
  EXPECT_EQ(counts.old_session, 1u);
}

TEST(TeleopHost, RefusesAddressesThatNeedAKey) {
  const Peer peer;
  HostConfig config = config_for(peer);
  config.console.bind_host = "0.0.0.0";
  EXPECT_THROW(TeleopHost{config}, ConfigError);
  config.console.keyed = true;
  EXPECT_NO_THROW(TeleopHost{config});
  config.console.console_host = "console";
  EXPECT_THROW(TeleopHost{config}, ConfigError);
}

}  // namespace
}  // namespace saras
