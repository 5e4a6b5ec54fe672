// A console on loopback: sends datagrams at a rate from one thread, hears the answers in another.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "phase_histogram.hpp"
#include "saras/kinematics/simball_handle.hpp"
#include "saras/net/touchball_packet.hpp"
#include "saras/runtime/clock.hpp"

namespace saras::benchmarks {

/// Both hands on a slow circle.
inline TouchballUp moving_hands(std::uint64_t session, std::uint64_t seq, std::int64_t now_ns) {
  static const SimballHandle handle{SimballHandleConfig()};
  TouchballUp packet;
  packet.session = session;
  packet.seq = seq;
  packet.sender_time_ns = now_ns;
  const double t = 1e-9 * static_cast<double>(now_ns);
  const Vector4 joints(0.05 * std::cos(2 * t), 0.05 * std::sin(2 * t), 0.0, 0.05);
  for (TouchballUpSide* side : {&packet.left, &packet.right}) {
    side->present = side->calibrated = true;
    side->ledger.session = session;
    side->ledger.seq = seq;
    side->simball_T_handle = handle.forward(joints);
    side->joints = {joints[0], joints[1], joints[2], joints[3]};
  }
  return packet;
}

inline sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

/// A UDP socket on loopback whose recv gives up after 100 ms. own_port 0: any, and it is told. Ends the program on
/// failure.
inline int bound_socket(int& own_port) {
  const int descriptor = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in own = loopback(own_port);
  if (descriptor < 0 || bind(descriptor, reinterpret_cast<sockaddr*>(&own), sizeof(own)) != 0) {
    std::perror("bind");
    std::exit(1);
  }
  socklen_t size = sizeof(own);
  getsockname(descriptor, reinterpret_cast<sockaddr*>(&own), &size);
  own_port = ntohs(own.sin_port);
  const timeval patience{0, 100'000};
  setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  return descriptor;
}

/// From construction to destruction. round_trip: from the sending of a datagram to the first answer that echoes it.
class LoopbackConsole {
 public:
  LoopbackConsole(int descriptor, int platform_port, double rate_hz)
      : descriptor_(descriptor), to_(loopback(platform_port)), period_ns_(static_cast<std::int64_t>(1e9 / rate_hz)) {
    receiver_ = std::thread([this] { receive(); });
    sender_ = std::thread([this] { send(); });
  }
  ~LoopbackConsole() {
    running_ = false;
    sender_.join();
    receiver_.join();
  }
  LoopbackConsole(const LoopbackConsole&) = delete;
  LoopbackConsole& operator=(const LoopbackConsole&) = delete;

  PhaseHistogram round_trip;

 private:
  void send() {
    const auto session = static_cast<std::uint64_t>(wall_ns());
    std::int64_t due_ns = monotonic_ns();
    for (std::uint64_t seq = 1; running_; ++seq, due_ns += period_ns_) {
      sleep_until_ns(due_ns);
      const TouchballUpBytes bytes = encode(moving_hands(session, seq, monotonic_ns()));
      sendto(descriptor_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof(to_));
    }
  }

  void receive() {
    std::array<std::uint8_t, 2048> data;
    TouchballDown down;
    std::uint64_t echoed = 0;
    while (running_) {
      const ssize_t size = recv(descriptor_, data.data(), data.size(), 0);
      const std::int64_t now_ns = monotonic_ns();
      if (size > 0 && !decode(data.data(), static_cast<std::size_t>(size), down) && down.echo_seq > echoed) {
        echoed = down.echo_seq;
        round_trip.record(now_ns - down.echo_time_ns);
      }
    }
  }

  int descriptor_;
  sockaddr_in to_;
  std::int64_t period_ns_;
  std::atomic<bool> running_{true};
  std::thread sender_, receiver_;
};

}  // namespace saras::benchmarks
