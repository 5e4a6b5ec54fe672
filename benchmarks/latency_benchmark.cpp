// The real-time host on loopback: console datagram in, force out, set-points handed over. Prints JSON.
//
// A console of its own thread sends at a rate and receives; the host runs as it does under ROS, with both arms' samples
// at 100 Hz, two other tools and 100 regions.   latency_benchmark SECONDS RATE_HZ datagram|tick RECORD_S
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "saras/runtime/clock.hpp"
#include "saras/runtime/teleop_host.hpp"

namespace saras::benchmarks {
namespace {

PipelineConfig pipeline_config() {
  PipelineConfig config;
  config.tank_master.damping_min.setZero();
  config.tank_master.damping_max.setZero();
  config.tank_slave.applied_limit << 0.1, 0.1, 0.1, 1, 1, 1;
  config.tank_slave.damping_min << 1e-3, 1e-3, 1e-3, 0, 0, 0;
  config.tank_slave.damping_max << 3e-3, 3e-3, 3e-3, 0, 0, 0;
  config.tank_master.dt_max_s = config.tank_slave.dt_max_s = 0.1;
  for (VelocityIntegratorConfig& integrator : config.integrator) {
    integrator.shaft_through_rcm = true;
    integrator.dt_max_s = 0.1;
  }
  config.proximity_force = config.proximity_slowdown = true;
  config.distances.enabled = true;
  config.distances.other_tools = 2;
  for (int i = 0; i < 100; ++i) {
    const Vector3 corner(0.03 * (i % 10), 0.03 * (i / 10), -0.35);
    config.distances.regions.push_back(Parallelepiped(corner, {0.02, 0, 0}, {0, 0.02, 0}, {0, 0, 0.02}).corners());
  }
  return config;
}

SceneInput scene() {
  SceneInput scene;
  scene.base_known = {true, true};
  scene.world_T_base[1].translation.x() = 0.2;
  scene.regions_known = true;
  scene.others[0] = {{Vector3(0.1, 0.1, -0.2), Vector3(0.1, 0.1, 0.0), 0.004}, true};
  scene.others[1] = {{Vector3(0.2, 0.1, -0.2), Vector3(0.2, 0.1, 0.0), 0.004}, true};
  return scene;
}

TouchballUp datagram(std::uint64_t seq, std::int64_t now_ns) {
  TouchballUp packet;
  packet.session = 1;
  packet.seq = seq;
  packet.sender_time_ns = now_ns;
  const double t = 1e-9 * static_cast<double>(now_ns);
  for (TouchballUpSide* side : {&packet.left, &packet.right}) {
    side->present = side->calibrated = true;
    side->simball_T_handle.translation = {0.01 * std::cos(2 * t), 0.01 * std::sin(2 * t), -0.2};
  }
  return packet;
}

long resident_bytes() {
  std::ifstream file("/proc/self/statm");
  long total = 0;
  long resident = 0;
  file >> total >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

void print(const char* name, const HistogramSnapshot& h) {
  std::printf("\"%s\": {\"count\": %llu, \"p50\": %lld, \"p99\": %lld, \"p99.9\": %lld, \"max\": %lld}, ", name,
              static_cast<unsigned long long>(h.count), static_cast<long long>(h.quantile_ns(0.5)),
              static_cast<long long>(h.quantile_ns(0.99)), static_cast<long long>(h.quantile_ns(0.999)),
              static_cast<long long>(h.max_ns));
}

/// One step of the pipeline alone, both arms, 4 tools, 100 regions.
HistogramSnapshot time_steps(int steps) {
  Pipeline pipeline(pipeline_config());
  PipelineInput input;
  input.scene = scene();
  input.scene.age_s = 0.0;
  Histogram times;
  for (int k = 0; k < steps; ++k) {
    const TouchballUp up = datagram(static_cast<std::uint64_t>(k) + 1, k * 1'000'000LL);
    for (SideInput& side : input.sides) {
      side.handle.is_new = true;
      side.handle.age_s = side.arm.age_s = side.arm.wrench_age_s = side.channel.age_s = 0.0;
      side.handle.simball_T_handle = up.left.simball_T_handle;
      side.arm.is_new = k % 10 == 0;
      side.arm.interval_s = 0.01;
      side.arm.base_T_tip = {Quaternion(0, 1, 0, 0), Vector3(0.18, 0.0, -0.18)};
      side.arm.has_rcm = true;
      side.arm.rcm = {0.18, 0.0, -0.1};
      side.channel.state = ChannelState::kEngaged;
      side.channel.engagement = 1;
    }
    const std::int64_t begin_ns = monotonic_ns();
    pipeline.step(input, 0.001);
    times.record(monotonic_ns() - begin_ns);
  }
  return times.snapshot();
}

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

int bound_socket(int& port) {
  const int descriptor = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in own = loopback(0);
  bind(descriptor, reinterpret_cast<sockaddr*>(&own), sizeof(own));
  socklen_t size = sizeof(own);
  getsockname(descriptor, reinterpret_cast<sockaddr*>(&own), &size);
  port = ntohs(own.sin_port);
  const timeval patience{0, 100'000};
  setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  return descriptor;
}

void feed_arms(TeleopHost& host, const std::atomic<bool>& running) {
  while (running) {
    for (int side = 0; side < kSides; ++side) {
      host.set_arm_rcm(side, {0.18, 0.0, -0.1});
      host.set_arm_pose(side, {Quaternion(0, 1, 0, 0), Vector3(0.18, 0.0, -0.18)}, wall_ns());
      host.set_arm_wrench(side, {});
      host.set_supervisor(side, ChannelState::kEngaged, 1, false);
    }
    host.set_scene(scene());
    sleep_until_ns(monotonic_ns() + 10'000'000);
  }
}

int run(double seconds, double rate_hz, Pacing pacing, double record_s) {
  const HistogramSnapshot step = time_steps(100'000);
  int port = 0;
  const int console = bound_socket(port);
  HostConfig config;
  config.loop.pacing = pacing;
  config.console.bind_port = 0;
  config.console.console_port = port;
  config.pipeline = pipeline_config();
  config.record_s = record_s;
  TeleopHost host(config);
  std::atomic<bool> running{true};
  host.start();
  std::thread arms([&] { feed_arms(host, running); });

  // From the sending of a datagram to the first answer that echoes it, as a console sees it.
  Histogram round_trip;
  std::thread receiver([&] {
    std::array<std::uint8_t, 2048> data;
    TouchballDown down;
    std::uint64_t echoed = 0;
    while (running) {
      const ssize_t size = recv(console, data.data(), data.size(), 0);
      const std::int64_t now_ns = monotonic_ns();
      if (size > 0 && !decode(data.data(), static_cast<std::size_t>(size), down) && down.echo_seq > echoed) {
        echoed = down.echo_seq;
        round_trip.record(now_ns - down.echo_time_ns);
      }
    }
  });
  const sockaddr_in to = loopback(host.console().port());
  const auto period_ns = static_cast<std::int64_t>(1e9 / rate_hz);
  std::int64_t due_ns = monotonic_ns();
  const std::int64_t end_ns = due_ns + static_cast<std::int64_t>(1e9 * seconds);
  long resident_first = 0;
  for (std::uint64_t seq = 1; due_ns < end_ns; ++seq, due_ns += period_ns) {
    sleep_until_ns(due_ns);
    const TouchballUpBytes bytes = encode(datagram(seq, monotonic_ns()));
    sendto(console, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
    if (resident_first == 0 && due_ns > end_ns - static_cast<std::int64_t>(0.9e9 * seconds)) {
      resident_first = resident_bytes();  // after a tenth of the time: all that is ever touched was touched
    }
  }
  const long resident_last = resident_bytes();
  running = false;
  arms.join();
  receiver.join();
  host.stop();
  const HostStatistics statistics = host.statistics();
  std::printf("{");
  print("pipeline_step", step);
  print("round_trip", round_trip.snapshot());
  print("force_sent", statistics.reply);
  print("set_point_handed", statistics.handed);
  print("lateness", statistics.loop.lateness);
  print("execution", statistics.loop.execution);
  std::printf(
      "\"steps\": %llu, \"overruns\": %llu, \"holds\": %llu, \"left_out\": %llu, \"resident_growth_bytes\": %ld, ",
      static_cast<unsigned long long>(statistics.steps), static_cast<unsigned long long>(statistics.loop.overruns),
      static_cast<unsigned long long>(statistics.loop.holds), static_cast<unsigned long long>(statistics.left_out),
      resident_last - resident_first);
  std::printf("\"realtime\": \"%s\"}\n", host.loop().report().text().c_str());
  close(console);
  return 0;
}

}  // namespace
}  // namespace saras::benchmarks

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: %s SECONDS RATE_HZ datagram|tick RECORD_S\n", argv[0]);
    return 2;
  }
  using saras::Pacing;
  const Pacing pacing = std::strcmp(argv[3], "tick") == 0 ? Pacing::kTick : Pacing::kDatagram;
  return saras::benchmarks::run(std::atof(argv[1]), std::atof(argv[2]), pacing, std::atof(argv[4]));
}
