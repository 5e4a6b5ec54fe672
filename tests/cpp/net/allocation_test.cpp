// The codec and the stream's filters serve the control loops: they allocate nothing, good datagram or bad.
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "saras/net/csa_packet.hpp"
#include "saras/net/link_age.hpp"
#include "saras/net/replay_window.hpp"
#include "saras/net/sequence_filter.hpp"
#include "saras/net/touchball_packet.hpp"
#include "support/malloc_counter.hpp"

namespace saras {
namespace {

TEST(NetAllocation, NothingInTheLoopAllocates) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  TouchballUp up;
  TouchballDown down;
  TouchballUpBytes up_bytes;
  TouchballDownBytes down_bytes;
  SequenceFilter filter;
  ReplayWindow window;
  const std::array<std::uint8_t, kTouchballTagSize> tag{};
  LinkAge age;
  int refused = 0;
  const test::MallocCounter counter;
  for (int i = 0; i < 8; ++i) {
    up.left.grip = i == 3 ? std::numeric_limits<double>::quiet_NaN() : 0.5;
    refused += encode(up, up_bytes) ? 1 : 0;
    refused += encode(down, down_bytes) ? 1 : 0;
    up_bytes[40] ^= i == 5 ? 1 : 0;
    refused += decode(up_bytes.data(), up_bytes.size(), up) ? 1 : 0;
    refused += decode(down_bytes.data(), down_bytes.size() - (i == 6), down) ? 1 : 0;
    filter.accept(1, static_cast<std::uint64_t>(i / 2));
    window.accept(static_cast<std::uint64_t>(i / 2));
    refused += encode(up, up_bytes, Authentication::kTag) ? 1 : 0;
    seal(up_bytes.data(), up_bytes.size(), tag.data());
    refused += check_frame<TouchballUp>(up_bytes.data(), up_bytes.size(), Authentication::kTag) ? 1 : 0;
    refused += decode(up_bytes.data(), up_bytes.size(), up, Authentication::kTag) ? 1 : 0;
    age.received(i * 1000, i * 2000);
  }
  const std::size_t allocations = counter.count();
  EXPECT_EQ(allocations, 0u);
  EXPECT_EQ(refused, 6);  // NaN at two encodes, the same at two decodes, a flipped bit, a short datagram
}

TEST(NetAllocation, NorDoesTheLinkOfASlaveElsewhere) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  CsaUp up;
  CsaDown down;
  CsaUpBytes up_bytes;
  CsaDownBytes down_bytes;
  const std::array<std::uint8_t, kPacketTagSize> tag{};
  int refused = 0;
  const test::MallocCounter counter;
  for (int i = 0; i < 8; ++i) {
    refused += encode(up, up_bytes) ? 1 : 0;
    refused += encode(down, down_bytes, Authentication::kTag) ? 1 : 0;
    seal(down_bytes.data(), down_bytes.size(), tag.data());
    up_bytes[100] ^= i == 5 ? 1 : 0;
    refused += decode(up_bytes.data(), up_bytes.size(), up) ? 1 : 0;
    refused += decode(down_bytes.data(), down_bytes.size(), down, Authentication::kTag) ? 1 : 0;
  }
  const std::size_t allocations = counter.count();
  EXPECT_EQ(allocations, 0u);
  EXPECT_EQ(refused, 1);
}

}  // namespace
}  // namespace saras
