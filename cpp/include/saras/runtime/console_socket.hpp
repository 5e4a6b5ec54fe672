// The platform's end of the Touchball UDP link inside the loop: one socket, what comes in, what is refused and why.
//
// Same rules and same order of checks as the Python end (saras.net.trust, docs/protocols.md). Handshakes, a few
// datagrams at the start of a session, are handed to another thread; the session that they give comes back by
// set_session().
#pragma once

#include <netinet/in.h>

#include <atomic>
#include <cstdint>
#include <string>

#include "saras/net/link_age.hpp"
#include "saras/net/replay_window.hpp"
#include "saras/net/sequence_filter.hpp"
#include "saras/net/touchball_packet.hpp"
#include "saras/runtime/hmac_sha256.hpp"
#include "saras/runtime/mailbox.hpp"

namespace saras {

struct ConsoleSocketConfig {
  std::string bind_host = "127.0.0.1";  ///< numeric IPv4
  int bind_port = 48010;                ///< 0: any free one
  std::string console_host = "127.0.0.1";
  int console_port = 48011;
  Seconds age_limit_s = 0.06;  ///< a datagram older than this on arrival is dropped
  bool keyed = false;          ///< only authenticated datagrams are believed; else loopback addresses only
  std::uint64_t session = 1;   ///< of the datagrams down
  void validate() const;       ///< throws ConfigError
};

/// Datagrams since the start. Names as in saras.net.trust.COUNTS and the separate node's diagnostics.
struct ConsoleCounts {
  std::uint64_t accepted = 0, gaps = 0, duplicate = 0, out_of_order = 0, old_session = 0, sessions = 0;
  std::uint64_t overdue = 0, malformed = 0, foreign = 0;
  std::uint64_t unauthenticated = 0, replayed = 0, too_old = 0, far_ahead = 0, handshake_refused = 0;
};

/// Keys of an authenticated session, derived by the handshake.
struct SessionKeys {
  HmacKey up{}, down{};
};

/// The newest datagram that was believed.
struct ReceivedUp {
  TouchballUp packet;
  std::int64_t received_ns = 0;  ///< monotonic clock when it was read
  std::int64_t arrival_ns = 0;   ///< wall clock when the kernel had it; 0: not told
  std::int64_t stamp_ns = 0;     ///< wall clock at which it was sent, with the exact spacing of the sender's clock
  Seconds interval_s = 0.0;      ///< since the one before by the sender's clock; 0: the first of its session
  bool left_new = false, right_new = false;  ///< a valid reading of that handle came since the last take
};

class ConsoleSocket {
 public:
  /// Binds. Throws ConfigError naming the address.
  explicit ConsoleSocket(ConsoleSocketConfig config);
  ~ConsoleSocket();
  ConsoleSocket(const ConsoleSocket&) = delete;
  ConsoleSocket& operator=(const ConsoleSocket&) = delete;

  int descriptor() const noexcept { return socket_; }
  int port() const noexcept;

  // ---- the loop's thread; nothing allocates, nothing waits

  /// Reads all that is there (at most kMostAtOnce); true when something newer was believed: see newest().
  bool receive(std::int64_t now_ns) noexcept;
  const ReceivedUp& newest() const noexcept { return newest_; }
  bool has_newest() const noexcept { return has_newest_; }
  /// Completes session, sequence, time and echo, and sends. A console that is not there is no error; with keys nothing
  /// goes out before a session.
  void send(TouchballDown& packet, std::int64_t now_ns) noexcept;

  // ---- another thread

  /// The next datagram of a handshake, if one waits.
  bool take_handshake(TouchballHandshakeBytes& bytes) noexcept;
  /// A new session: what comes after is checked with its keys, numbers and clock begin anew.
  void set_session(const SessionKeys& keys) noexcept { session_.write(keys); }
  /// Sends bytes as they are (answers of a handshake).
  void send_raw(const std::uint8_t* data, std::size_t size) noexcept;
  /// Monotonic time at which the session was last heard [ns]; 0: not yet in this session.
  std::int64_t heard_ns() const noexcept { return heard_ns_.load(std::memory_order_relaxed); }
  ConsoleCounts counts() const noexcept;
  /// Age of the newest information [s] at a time of the monotonic clock; infinite before the first datagram.
  Seconds age_s() const noexcept { return age_s_.load(std::memory_order_relaxed); }

  static constexpr int kMostAtOnce = 64;

 private:
  static constexpr std::size_t kHandshakes = 8;
  using Count = std::atomic<std::uint64_t>;
  struct Counters {
    Count overdue{0}, malformed{0}, foreign{0}, unauthenticated{0}, replayed{0}, too_old{0}, far_ahead{0},
        handshake_refused{0};
    Count accepted{0}, gaps{0}, duplicate{0}, out_of_order{0}, old_session{0}, sessions{0};
  };

  void begin_session(std::int64_t now_ns) noexcept;
  void take_datagram(const std::uint8_t* data, std::size_t size, std::int64_t now_ns, std::int64_t arrival_ns) noexcept;
  bool trusted(const std::uint8_t* data, std::size_t size, TouchballUp& packet, std::int64_t now_ns) noexcept;
  void accept(const TouchballUp& packet, std::int64_t now_ns, std::int64_t arrival_ns) noexcept;
  void queue_handshake(const std::uint8_t* data) noexcept;
  std::int64_t stamp(std::int64_t sender_time_ns) noexcept;

  ConsoleSocketConfig config_;
  int socket_ = -1;
  sockaddr_in console_{};
  // of the loop
  SequenceFilter sequence_;
  LinkAge age_;
  ReplayWindow window_;
  HmacSha256 up_key_, down_key_;
  bool has_session_ = false, is_heard_ = false;
  std::int64_t began_ns_ = 0;
  bool has_newest_ = false, has_anchor_ = false, is_first_ = true, news_ = false;
  std::int64_t anchor_ns_ = 0;
  ReceivedUp newest_;
  std::uint64_t seq_ = 0;
  // shared
  Mailbox<SessionKeys> session_;
  std::array<TouchballHandshakeBytes, kHandshakes> handshakes_;
  std::atomic<std::uint64_t> handshakes_in_{0}, handshakes_out_{0};
  std::atomic<std::int64_t> heard_ns_{0};
  std::atomic<double> age_s_;
  Counters counters_;
};

}  // namespace saras
