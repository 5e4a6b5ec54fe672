#include "saras/runtime/console_socket.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "saras/runtime/clock.hpp"
#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

// Larger than any datagram of the protocol, so that an oversized one is seen as such and not as a good prefix.
constexpr std::size_t kReceiveBytes = 2048;
constexpr std::int64_t kFutureToleranceNs = 1'000'000;
constexpr std::int64_t kClockStepNs = 1'000'000'000;
/// A session whose first datagram comes later than this began with held-back ones: their age has no measure yet.
constexpr std::int64_t kLifetimeNs = 2'000'000'000;
constexpr double kSecond = 1e9;

void count(std::atomic<std::uint64_t>& counter) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

sockaddr_in address(const char* field, const std::string& host, int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1) {
    throw ConfigError(std::string(field) + " = " + host + ": must be a numeric IPv4 address");
  }
  return address;
}

bool is_loopback(const sockaddr_in& address) { return (ntohl(address.sin_addr.s_addr) >> 24) == 127; }

std::int64_t arrival_of(msghdr& message) noexcept {
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SCM_TIMESTAMPNS) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(part), sizeof(time));
      return time.tv_sec * 1'000'000'000 + time.tv_nsec;
    }
  }
  return 0;
}

}  // namespace

void ConsoleSocketConfig::validate() const {
  validate::in_range("bind_port", bind_port, 0, 65535);
  validate::in_range("console_port", console_port, 1, 65535);
  validate::in_range("age_limit_s", age_limit_s, 0.005, 10.0);
  for (const auto& [field, host] : {std::pair{"bind_host", bind_host}, {"console_host", console_host}}) {
    if (!is_loopback(address(field, host, 0)) && !keyed) {
      throw ConfigError(std::string(field) + " = " + host +
                        ": must be a loopback address: the link is not authenticated without a key file");
    }
  }
}

ConsoleSocket::ConsoleSocket(ConsoleSocketConfig config)
    : config_((config.validate(), std::move(config))),
      console_(address("console_host", config_.console_host, config_.console_port)),
      age_s_(std::numeric_limits<double>::infinity()) {
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on));
  const sockaddr_in own = address("bind_host", config_.bind_host, config_.bind_port);
  if (socket_ < 0 || bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own)) != 0) {
    const std::string reason = std::strerror(errno);
    if (socket_ >= 0) {
      close(socket_);
    }
    throw ConfigError("bind address " + config_.bind_host + ":" + std::to_string(config_.bind_port) + ": " + reason);
  }
}

ConsoleSocket::~ConsoleSocket() { close(socket_); }

int ConsoleSocket::port() const noexcept {
  sockaddr_in own{};
  socklen_t size = sizeof(own);
  getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
  return ntohs(own.sin_port);
}

bool ConsoleSocket::receive(std::int64_t now_ns) noexcept {
  if (config_.keyed && session_.update()) {
    begin_session(now_ns);
  }
  news_ = false;
  newest_.left_new = newest_.right_new = false;
  std::array<std::uint8_t, kReceiveBytes> data;
  std::array<char, 64> control;
  for (int i = 0; i < kMostAtOnce; ++i) {
    sockaddr_in sender{};
    iovec part{data.data(), data.size()};
    msghdr message{};
    message.msg_name = &sender;
    message.msg_namelen = sizeof(sender);
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = recvmsg(socket_, &message, 0);
    if (size < 0) {
      if (errno == EINTR || errno == ECONNREFUSED) {
        continue;
      }
      break;
    }
    if (sender.sin_addr.s_addr != console_.sin_addr.s_addr) {
      count(counters_.foreign);
      continue;
    }
    take_datagram(data.data(), static_cast<std::size_t>(size), now_ns, arrival_of(message));
  }
  age_s_.store(age_.age_s(now_ns), std::memory_order_relaxed);
  const SequenceCounts& sequence = sequence_.counts();
  counters_.gaps.store(sequence.gaps, std::memory_order_relaxed);
  counters_.duplicate.store(sequence.duplicate, std::memory_order_relaxed);
  counters_.out_of_order.store(sequence.out_of_order, std::memory_order_relaxed);
  counters_.old_session.store(sequence.old_session, std::memory_order_relaxed);
  counters_.sessions.store(sequence.sessions, std::memory_order_relaxed);
  return news_;
}

void ConsoleSocket::begin_session(std::int64_t now_ns) noexcept {
  up_key_.set_key(session_.value().up);
  down_key_.set_key(session_.value().down);
  has_session_ = true;
  is_heard_ = false;
  began_ns_ = now_ns;
  heard_ns_.store(0, std::memory_order_relaxed);
  window_.reset();
  sequence_.restart();
  age_.reset();
  has_anchor_ = false;
  is_first_ = true;
}

void ConsoleSocket::take_datagram(const std::uint8_t* data, std::size_t size, std::int64_t now_ns,
                                  std::int64_t arrival_ns) noexcept {
  TouchballUp packet;
  if (config_.keyed) {
    if (size == kTouchballHandshakeSize) {
      queue_handshake(data);
      return;
    }
    if (!trusted(data, size, packet, now_ns)) {
      return;
    }
  } else if (decode(data, size, packet)) {
    count(counters_.malformed);
    return;
  }
  accept(packet, now_ns, arrival_ns);
}

// Order: frame, tag, fields, replay. What fails earlier changes nothing that a later check looks at.
bool ConsoleSocket::trusted(const std::uint8_t* data, std::size_t size, TouchballUp& packet,
                            std::int64_t now_ns) noexcept {
  if (check_frame<TouchballUp>(data, size, Authentication::kTag)) {
    const bool untagged = !check_frame<TouchballUp>(data, size, Authentication::kNone);
    count(untagged ? counters_.unauthenticated : counters_.malformed);
    return false;
  }
  const std::size_t signed_size = size - kTouchballTrailerSize;
  if (!has_session_ ||
      !HmacSha256::same(up_key_.tag(data, signed_size).data(), data + signed_size, kTouchballTagSize)) {
    count(counters_.unauthenticated);
    return false;
  }
  if (decode(data, size, packet, Authentication::kTag)) {
    count(counters_.malformed);
    return false;
  }
  if (!is_heard_ && now_ns - began_ns_ > kLifetimeNs) {
    count(counters_.handshake_refused);
    return false;
  }
  switch (window_.accept(packet.seq)) {
    case ReplayVerdict::kReplayed:
      count(counters_.replayed);
      return false;
    case ReplayVerdict::kTooOld:
      count(counters_.too_old);
      return false;
    case ReplayVerdict::kFarAhead:
      count(counters_.far_ahead);
      return false;
    case ReplayVerdict::kNew:
      break;
  }
  is_heard_ = true;
  heard_ns_.store(now_ns, std::memory_order_relaxed);
  return true;
}

void ConsoleSocket::accept(const TouchballUp& packet, std::int64_t now_ns, std::int64_t arrival_ns) noexcept {
  const std::uint64_t previous = sequence_.session();
  if (!sequence_.accept(packet.session, packet.seq)) {
    return;
  }
  if (packet.session != previous) {
    age_.reset();
    has_anchor_ = false;
    is_first_ = true;
  }
  if (age_.received(packet.sender_time_ns, now_ns) > config_.age_limit_s) {
    count(counters_.overdue);
    return;
  }
  const std::int64_t before_ns = newest_.packet.sender_time_ns;
  // Several at once: the interval reaches back to the one that was taken last.
  const double passed_s = is_first_ ? 0.0 : static_cast<double>(packet.sender_time_ns - before_ns) / kSecond;
  newest_.interval_s = news_ ? newest_.interval_s + passed_s : passed_s;
  is_first_ = false;
  newest_.packet = packet;
  newest_.received_ns = now_ns;
  newest_.arrival_ns = arrival_ns;
  newest_.stamp_ns = stamp(packet.sender_time_ns);
  newest_.left_new = newest_.left_new || packet.left.present;
  newest_.right_new = newest_.right_new || packet.right.present;
  has_newest_ = news_ = true;
  count(counters_.accepted);
}

// Sender's time on the wall clock. A stamp never lies in the future; a stepped clock anchors anew.
std::int64_t ConsoleSocket::stamp(std::int64_t sender_time_ns) noexcept {
  const std::int64_t now_ns = wall_ns();
  if (has_anchor_) {
    const std::int64_t behind_ns = now_ns - (sender_time_ns + anchor_ns_);
    if (-kFutureToleranceNs <= behind_ns && behind_ns <= kClockStepNs) {
      return sender_time_ns + anchor_ns_;
    }
  }
  has_anchor_ = true;
  anchor_ns_ = now_ns - sender_time_ns;
  return now_ns;
}

void ConsoleSocket::send(TouchballDown& packet, std::int64_t now_ns) noexcept {
  if (config_.keyed && !has_session_) {
    return;
  }
  packet.session = config_.session;
  packet.seq = ++seq_;
  packet.sender_time_ns = now_ns;
  if (has_newest_) {
    packet.echo_session = newest_.packet.session;
    packet.echo_seq = newest_.packet.seq;
    packet.echo_time_ns = newest_.packet.sender_time_ns;
    packet.echo_hold_ns = now_ns - newest_.received_ns;
  }
  TouchballDownBytes bytes;
  if (encode(packet, bytes, config_.keyed ? Authentication::kTag : Authentication::kNone)) {
    return;  // a number that is not finite must not leave
  }
  if (config_.keyed) {
    seal(bytes.data(), bytes.size(), down_key_.tag(bytes.data(), bytes.size() - kTouchballTrailerSize).data());
  }
  send_raw(bytes.data(), bytes.size());
}

void ConsoleSocket::send_raw(const std::uint8_t* data, std::size_t size) noexcept {
  (void)!sendto(socket_, data, size, MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&console_), sizeof(console_));
}

void ConsoleSocket::queue_handshake(const std::uint8_t* data) noexcept {
  const std::uint64_t in = handshakes_in_.load(std::memory_order_relaxed);
  if (in - handshakes_out_.load(std::memory_order_acquire) >= kHandshakes) {
    return;  // the other end asks again
  }
  std::memcpy(handshakes_[in % kHandshakes].data(), data, kTouchballHandshakeSize);
  handshakes_in_.store(in + 1, std::memory_order_release);
}

bool ConsoleSocket::take_handshake(TouchballHandshakeBytes& bytes) noexcept {
  const std::uint64_t out = handshakes_out_.load(std::memory_order_relaxed);
  if (out == handshakes_in_.load(std::memory_order_acquire)) {
    return false;
  }
  bytes = handshakes_[out % kHandshakes];
  handshakes_out_.store(out + 1, std::memory_order_release);
  return true;
}

ConsoleCounts ConsoleSocket::counts() const noexcept {
  const auto read = [](const Count& counter) { return counter.load(std::memory_order_relaxed); };
  ConsoleCounts counts;
  counts.accepted = read(counters_.accepted);
  counts.gaps = read(counters_.gaps);
  counts.duplicate = read(counters_.duplicate);
  counts.out_of_order = read(counters_.out_of_order);
  counts.old_session = read(counters_.old_session);
  counts.sessions = read(counters_.sessions);
  counts.overdue = read(counters_.overdue);
  counts.malformed = read(counters_.malformed);
  counts.foreign = read(counters_.foreign);
  counts.unauthenticated = read(counters_.unauthenticated);
  counts.replayed = read(counters_.replayed);
  counts.too_old = read(counters_.too_old);
  counts.far_ahead = read(counters_.far_ahead);
  counts.handshake_refused = read(counters_.handshake_refused);
  return counts;
}

}  // namespace saras
