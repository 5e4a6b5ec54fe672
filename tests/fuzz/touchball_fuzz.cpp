// libFuzzer over what stands between the network and the laws: the decoders, and the windows behind them.
// Run by script/fuzz. With SARAS_FUZZ_SEEDS=DIR it writes a corpus of encoded datagrams into DIR and ends.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "saras/net/crc32.hpp"
#include "saras/net/link_age.hpp"
#include "saras/net/replay_window.hpp"
#include "saras/net/sequence_filter.hpp"
#include "saras/net/touchball_packet.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using namespace saras;

// Unlike assert it is there in every build; the fuzzer reports the abort with the input that led to it.
void require(bool holds, const char* what) {
  if (!holds) {
    std::fprintf(stderr, "does not hold: %s\n", what);
    std::abort();
  }
}

constexpr std::uint64_t kUntouched = 0x5A5A5A5A5A5A5A5A;

/// What is accepted is encoded to the same bytes again; what is refused changes nothing and says why.
template <typename Packet, typename Bytes>
bool round_trip(const std::uint8_t* data, std::size_t size, Authentication authentication, Packet& packet) {
  packet.session = kUntouched;
  const PacketFault fault = decode(data, size, packet, authentication);
  const PacketFault frame = check_frame<Packet>(data, size, authentication);
  if (fault) {
    require(packet.session == kUntouched, "a refused datagram leaves the packet as it was");
    require(!to_string(fault).empty(), "a refusal has a text");
    return false;
  }
  require(!frame, "what is decoded has passed the frame's check");
  Bytes again;
  require(!encode(packet, again, authentication), "what was decoded can be encoded");
  if (authentication == Authentication::kTag) {
    seal(again.data(), again.size(), data + size - kTouchballTrailerSize);
  }
  require(again.size() == size && std::memcmp(again.data(), data, size) == 0, "the same bytes again");
  return true;
}

/// The stream behind the decoder: never backwards, never twice, and ages that can be used.
class Receiver {
 public:
  void take(std::uint64_t session, std::uint64_t seq, std::int64_t sent_ns, std::int64_t now_ns) {
    const ReplayVerdict first = window_.accept(seq);
    require(window_.accept(seq) != ReplayVerdict::kNew, "no number is new twice");
    require(first == ReplayVerdict::kNew || window_.newest() == newest_, "a refused number moves nothing");
    newest_ = window_.newest();
    if (filter_.accept(session, seq)) {
      require(!filter_.accept(session, seq), "nothing is delivered twice");
    }
    require(age_.received(sent_ns, now_ns) >= 0.0, "an age is not negative");
    require(age_.age_s(now_ns) >= 0.0, "an age is not negative");
  }

 private:
  ReplayWindow window_;
  SequenceFilter filter_;
  LinkAge age_;
  std::uint64_t newest_ = 0;
};

void fix_frame(std::uint8_t* data, std::size_t size, unsigned choice) {
  static constexpr const char* kMagic[] = {"STBU", "STBD", "STBH"};
  std::memcpy(data, kMagic[choice % 3], 4);
  data[4] = 1;
  data[5] = data[7] = 0;
  data[6] = choice % 3 == 2 ? 1 : static_cast<std::uint8_t>(choice / 3 % 2);
  if (data[6] == 0) {
    std::memset(data + size - kTouchballTrailerSize, 0, kTouchballTagSize);
  }
  const std::uint32_t crc = crc32(data, size - 4);
  for (int i = 0; i < 4; ++i) {
    data[size - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  }
}

void write(const std::string& directory, const char* name, const std::uint8_t* data, std::size_t size) {
  std::ofstream(directory + "/" + name, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
}

void write_seeds(const std::string& directory) {
  TouchballUp up;
  up.session = 7;
  up.seq = 1;
  up.left.present = up.left.calibrated = up.right.clutch = true;
  up.left.simball_T_handle = {Quaternion(0.5, 0.5, -0.5, 0.5), Vector3(0.01, -0.02, 0.13)};
  up.left.guard.energy_J = 0.4;
  up.right.ledger = {9, 8, 1.5, true, false};
  TouchballDown down;
  down.left.touch_wrench.force = {1.0, -2.0, 0.5};
  down.left.state = ChannelState::kEngaged;
  const std::uint8_t tag[kTouchballTagSize] = {1, 2, 3};
  const TouchballUpBytes plain_up = encode(up);
  const TouchballDownBytes plain_down = encode(down);
  TouchballUpBytes sealed_up = encode(up, Authentication::kTag);
  TouchballDownBytes sealed_down = encode(down, Authentication::kTag);
  TouchballHandshakeBytes handshake;
  encode(TouchballHandshake{}, handshake);
  seal(sealed_up.data(), sealed_up.size(), tag);
  seal(sealed_down.data(), sealed_down.size(), tag);
  seal(handshake.data(), handshake.size(), tag);
  write(directory, "up", plain_up.data(), plain_up.size());
  write(directory, "down", plain_down.data(), plain_down.size());
  write(directory, "up_sealed", sealed_up.data(), sealed_up.size());
  write(directory, "down_sealed", sealed_down.data(), sealed_down.size());
  write(directory, "handshake", handshake.data(), handshake.size());
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  if (const char* directory = std::getenv("SARAS_FUZZ_SEEDS")) {
    write_seeds(directory);
    std::exit(0);
  }
  return 0;
}

/// Three of four mutants get a good length, magic and checksum, or no mutant would come past them.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  size = LLVMFuzzerMutate(data, size, max_size);
  if (seed % 4 == 0) {
    return size;
  }
  static constexpr std::size_t kSizes[] = {kTouchballUpSize, kTouchballDownSize, kTouchballHandshakeSize};
  // Its own kind, mostly; else another one.
  unsigned kind = size <= kTouchballHandshakeSize + 8 ? 2 : size <= kTouchballDownSize + 8 ? 1 : 0;
  kind = seed / 4 % 16 == 0 ? (kind + 1) % 3 : kind;
  const std::size_t wanted = kSizes[kind];
  if (wanted > max_size) {
    return size;
  }
  if (size < wanted) {
    std::memset(data + size, 0, wanted - size);
  }
  fix_frame(data, wanted, kind + 3 * (seed / 64 % 2));
  return wanted;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Receiver receiver;  // a stream over all inputs
  static std::int64_t now_ns = 0;
  for (const Authentication authentication : {Authentication::kNone, Authentication::kTag}) {
    TouchballUp up;
    TouchballDown down;
    const bool is_up = round_trip<TouchballUp, TouchballUpBytes>(data, size, authentication, up);
    const bool is_down = round_trip<TouchballDown, TouchballDownBytes>(data, size, authentication, down);
    require(!(is_up && is_down), "a datagram has one direction");
    now_ns += 10'000'000;
    if (is_up) {
      receiver.take(up.session, up.seq, up.sender_time_ns, now_ns);
    }
    if (is_down) {
      receiver.take(down.session, down.seq, down.sender_time_ns, now_ns);
    }
  }
  TouchballHandshake handshake;
  if (!decode(data, size, handshake)) {
    TouchballHandshakeBytes again;
    encode(handshake, again);
    seal(again.data(), again.size(), data + size - kTouchballTrailerSize);
    require(std::memcmp(again.data(), data, size) == 0, "the same bytes again");
  }
  return 0;
}
