// What the fuzzers of both protocols share: what must hold for every datagram, and for the stream behind the decoder.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "saras/net/crc32.hpp"
#include "saras/net/link_age.hpp"
#include "saras/net/packet_fault.hpp"
#include "saras/net/replay_window.hpp"
#include "saras/net/sequence_filter.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace saras::fuzz {

// Unlike assert it is there in every build; the fuzzer reports the abort with the input that led to it.
inline void require(bool holds, const char* what) {
  if (!holds) {
    std::fprintf(stderr, "does not hold: %s\n", what);
    std::abort();
  }
}

inline constexpr std::uint64_t kUntouched = 0x5A5A5A5A5A5A5A5A;

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
    seal(again.data(), again.size(), data + size - kPacketTrailerSize);
  }
  require(again.size() == size && std::memcmp(again.data(), data, size) == 0, "the same bytes again");
  return true;
}

template <typename Packet>
void handshake_round_trip(const std::uint8_t* data, std::size_t size) {
  Packet handshake;
  if (!decode(data, size, handshake)) {
    std::array<std::uint8_t, kHandshakeSize> again;
    encode(handshake, again);
    seal(again.data(), again.size(), data + size - kPacketTrailerSize);
    require(std::memcmp(again.data(), data, size) == 0, "the same bytes again");
  }
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

/// The datagrams of one protocol: up, down, handshake.
struct Protocol {
  const char* magic[3];
  std::size_t size[3];
};

inline void fix_frame(const Protocol& protocol, std::uint8_t* data, std::size_t size, unsigned choice) {
  std::memcpy(data, protocol.magic[choice % 3], 4);
  data[4] = 1;
  data[5] = data[7] = 0;
  data[6] = choice % 3 == 2 ? 1 : static_cast<std::uint8_t>(choice / 3 % 2);
  if (data[6] == 0) {
    std::memset(data + size - kPacketTrailerSize, 0, kPacketTagSize);
  }
  const std::uint32_t crc = crc32(data, size - 4);
  for (int i = 0; i < 4; ++i) {
    data[size - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  }
}

/// Three of four mutants get a good length, magic and checksum, or no mutant would come past them.
inline std::size_t mutate(const Protocol& protocol, std::uint8_t* data, std::size_t size, std::size_t max_size,
                          unsigned seed) {
  size = LLVMFuzzerMutate(data, size, max_size);
  if (seed % 4 == 0) {
    return size;
  }
  // Its own kind, mostly; else another one.
  unsigned kind = size <= protocol.size[2] + 8 ? 2 : size <= protocol.size[1] + 8 ? 1 : 0;
  kind = seed / 4 % 16 == 0 ? (kind + 1) % 3 : kind;
  const std::size_t wanted = protocol.size[kind];
  if (wanted > max_size) {
    return size;
  }
  if (size < wanted) {
    std::memset(data + size, 0, wanted - size);
  }
  fix_frame(protocol, data, wanted, kind + 3 * (seed / 64 % 2));
  return wanted;
}

/// Up and down in both forms, and the handshake.
template <typename Up, typename UpBytes, typename Down, typename DownBytes, typename Hello>
void take(Receiver& receiver, const std::uint8_t* data, std::size_t size) {
  static std::int64_t now_ns = 0;
  for (const Authentication authentication : {Authentication::kNone, Authentication::kTag}) {
    Up up;
    Down down;
    const bool is_up = round_trip<Up, UpBytes>(data, size, authentication, up);
    const bool is_down = round_trip<Down, DownBytes>(data, size, authentication, down);
    require(!(is_up && is_down), "a datagram has one direction");
    now_ns += 10'000'000;
    if (is_up) {
      receiver.take(up.session, up.seq, up.sender_time_ns, now_ns);
    }
    if (is_down) {
      receiver.take(down.session, down.seq, down.sender_time_ns, now_ns);
    }
  }
  handshake_round_trip<Hello>(data, size);
}

template <typename Bytes>
void write(const std::string& directory, const char* name, const Bytes& bytes) {
  std::ofstream(directory + "/" + name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// A corpus of encoded datagrams.
template <typename Up, typename Down, typename Hello>
void write_seeds(const std::string& directory, const Up& up, const Down& down, const Hello& hello) {
  const std::uint8_t tag[kPacketTagSize] = {1, 2, 3};
  auto sealed_up = encode(up, Authentication::kTag);
  auto sealed_down = encode(down, Authentication::kTag);
  std::array<std::uint8_t, kHandshakeSize> handshake;
  encode(hello, handshake);
  seal(sealed_up.data(), sealed_up.size(), tag);
  seal(sealed_down.data(), sealed_down.size(), tag);
  seal(handshake.data(), handshake.size(), tag);
  write(directory, "up", encode(up, Authentication::kNone));
  write(directory, "down", encode(down, Authentication::kNone));
  write(directory, "up_sealed", sealed_up);
  write(directory, "down_sealed", sealed_down);
  write(directory, "handshake", handshake);
}

}  // namespace saras::fuzz
