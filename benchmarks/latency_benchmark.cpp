// The real-time host on loopback: console datagram in, force out, set-points handed over. Prints JSON.
//
// A console of its own thread sends at a rate and receives; the host runs as it does under ROS, with both arms' samples
// at 100 Hz, two other tools and 100 regions.   latency_benchmark SECONDS RATE_HZ datagram|tick RECORD_S
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "loopback_console.hpp"
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

long resident_bytes() {
  std::ifstream file("/proc/self/statm");
  long total = 0;
  long resident = 0;
  file >> total >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

/// One step of the pipeline alone, both arms, 4 tools, 100 regions.
HistogramSnapshot time_steps(int steps) {
  Pipeline pipeline(pipeline_config());
  PipelineInput input;
  input.scene = scene();
  input.scene.age_s = 0.0;
  Histogram times;
  for (int k = 0; k < steps; ++k) {
    const TouchballUp up = moving_hands(1, static_cast<std::uint64_t>(k) + 1, k * 1'000'000LL);
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
  const int descriptor = bound_socket(port);
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

  HistogramSnapshot round_trip;
  long resident_first = 0;
  {
    LoopbackConsole console(descriptor, host.console().port(), rate_hz);
    std::this_thread::sleep_for(std::chrono::duration<double>(0.1 * seconds));
    resident_first = resident_bytes();  // by now all that is ever touched was touched
    std::this_thread::sleep_for(std::chrono::duration<double>(0.9 * seconds));
    round_trip = console.round_trip.end_phase();
  }
  const long resident_last = resident_bytes();
  running = false;
  arms.join();
  host.stop();
  const HostStatistics statistics = host.statistics();
  std::printf("{");
  print_json("pipeline_step", step);
  std::printf(", ");
  print_json("round_trip", round_trip);
  std::printf(", ");
  print_json("force_sent", statistics.reply);
  std::printf(", ");
  print_json("set_point_handed", statistics.handed);
  std::printf(", ");
  print_json("lateness", statistics.loop.lateness);
  std::printf(", ");
  print_json("execution", statistics.loop.execution);
  std::printf(", ");
  std::printf(
      "\"steps\": %llu, \"overruns\": %llu, \"holds\": %llu, \"left_out\": %llu, \"resident_growth_bytes\": %ld, ",
      static_cast<unsigned long long>(statistics.steps), static_cast<unsigned long long>(statistics.loop.overruns),
      static_cast<unsigned long long>(statistics.loop.holds), static_cast<unsigned long long>(statistics.left_out),
      resident_last - resident_first);
  std::printf("\"realtime\": \"%s\"}\n", host.loop().report().text().c_str());
  close(descriptor);
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
