#include "saras/net/touchball_packet.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "saras/net/crc32.hpp"
#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

TouchballUp example_up() {
  TouchballUp up;
  up.session = 0x0123456789ABCDEF;
  up.seq = 42;
  up.sender_time_ns = -7;
  up.left.present = true;
  up.left.simball_T_handle = {Quaternion(0.5, 0.5, -0.5, 0.5), Vector3(0.1, -0.2, 0.3)};
  up.left.grip = 0.25;
  up.right.ledger = {9, 8, 1.5, true, false};
  return up;
}

void sign(TouchballUpBytes& bytes) {
  const auto crc = crc32(bytes.data(), bytes.size() - 4);
  for (int i = 0; i < 4; ++i) {
    bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  }
}

TEST(Crc32, IsTheIeeeOne) {
  const char* text = "123456789";
  EXPECT_EQ(crc32(reinterpret_cast<const std::uint8_t*>(text), 9), 0xCBF43926u);
}

// The bytes are a contract with programs that are not built from this tree.
TEST(TouchballPacket, LayoutIsLittleEndianAndFixed) {
  const TouchballUpBytes bytes = encode(example_up());
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 4), "STBU");
  EXPECT_EQ(bytes[4], 1);
  EXPECT_EQ(bytes[8], 0xEF);
  EXPECT_EQ(bytes[15], 0x01);
  EXPECT_EQ(bytes[16], 42);
  EXPECT_EQ(bytes[24], 0xF9);
  EXPECT_EQ(bytes[32], 1);              // left flags: present
  EXPECT_EQ(bytes[32 + 264], 1u << 4);  // right flags: ledger.requesting
  const TouchballDownBytes down = encode(TouchballDown{});
  EXPECT_EQ(std::string(down.begin(), down.begin() + 4), "STBD");
}

TEST(TouchballPacket, LayoutEndsWhereTheTrailerBegins) {
  TouchballUp up;
  up.right.guard.granted_J = 1.0;  // the last field: the high byte of 1.0 is 0x3F
  EXPECT_EQ(encode(up)[kTouchballUpSize - 21], 0x3F);
  TouchballDown down;
  down.right.ledger.sent_J = 1.0;
  EXPECT_EQ(encode(down)[kTouchballDownSize - 21], 0x3F);
}

TEST(TouchballPacket, RefusalLeavesThePacketAsItWas) {
  TouchballUpBytes bytes = encode(example_up());
  bytes[100] ^= 1;
  TouchballUp target;
  target.seq = 77;
  const PacketFault fault = decode(bytes.data(), bytes.size(), target);
  EXPECT_EQ(fault.error, PacketError::kChecksum);
  EXPECT_EQ(target.seq, 77u);
  EXPECT_FALSE(target.left.present);
}

TEST(TouchballPacket, AnAuthenticatedDatagramIsRefusedByName) {
  TouchballUpBytes bytes = encode(example_up());
  bytes[6] |= 1;
  sign(bytes);
  TouchballUp target;
  EXPECT_EQ(decode(bytes.data(), bytes.size(), target).error, PacketError::kAuthenticated);
  EXPECT_THROW(decode_up(bytes.data(), bytes.size()), ProtocolError);
}

TEST(TouchballPacket, AnAuthenticatedDatagramCarriesItsTagBeforeTheChecksum) {
  TouchballUpBytes bytes = encode(example_up(), Authentication::kTag);
  TouchballUp target;
  EXPECT_EQ(decode(bytes.data(), bytes.size(), target, Authentication::kTag).error, PacketError::kChecksum);
  std::array<std::uint8_t, kTouchballTagSize> tag;
  tag.fill(0xA5);
  seal(bytes.data(), bytes.size(), tag.data());
  EXPECT_EQ(bytes[6], 1);
  EXPECT_EQ(bytes[kTouchballUpSize - 21], encode(example_up())[kTouchballUpSize - 21]);
  EXPECT_EQ(bytes[kTouchballUpSize - 20], 0xA5);
  EXPECT_EQ(bytes[kTouchballUpSize - 5], 0xA5);
  EXPECT_FALSE(decode(bytes.data(), bytes.size(), target, Authentication::kTag));
  EXPECT_EQ(encode(target), encode(example_up()));  // the same fields
  const TouchballUpBytes plain = encode(example_up());
  EXPECT_EQ(decode(plain.data(), plain.size(), target, Authentication::kTag).error, PacketError::kUnauthenticated);
}

TEST(TouchballPacket, TheFrameIsCheckedWithoutReadingFurther) {
  const TouchballUpBytes bytes = encode(example_up(), Authentication::kTag);
  EXPECT_FALSE(check_frame<TouchballUp>(bytes.data(), bytes.size(), Authentication::kTag));
  EXPECT_EQ(check_frame<TouchballUp>(bytes.data(), bytes.size() - 1, Authentication::kTag).error, PacketError::kSize);
  EXPECT_EQ(check_frame<TouchballUp>(bytes.data(), bytes.size(), Authentication::kNone).error,
            PacketError::kAuthenticated);
  EXPECT_EQ(check_frame<TouchballUp>(nullptr, 0, Authentication::kTag).error, PacketError::kSize);
}

TEST(TouchballPacket, AHandshakeCarriesBothNonces) {
  TouchballHandshake sent;
  for (std::uint8_t i = 0; i < 16; ++i) {
    sent.nonce[i] = i;
    sent.echo[i] = static_cast<std::uint8_t>(0xF0 + i);
  }
  TouchballHandshakeBytes bytes;
  encode(sent, bytes);
  const std::array<std::uint8_t, kTouchballTagSize> tag{1};
  seal(bytes.data(), bytes.size(), tag.data());
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 4), "STBH");
  EXPECT_EQ(bytes[8 + 3], 3);
  EXPECT_EQ(bytes[24 + 3], 0xF3);
  TouchballHandshake received;
  ASSERT_FALSE(decode(bytes.data(), bytes.size(), received));
  EXPECT_EQ(received.nonce, sent.nonce);
  EXPECT_EQ(received.echo, sent.echo);
  EXPECT_EQ(decode(bytes.data(), bytes.size() - 1, received).error, PacketError::kSize);
  bytes[20] ^= 1;
  EXPECT_EQ(decode(bytes.data(), bytes.size(), received).error, PacketError::kChecksum);
}

TEST(TouchballPacket, ReservedBitsVersionsAndEnumsAreChecked) {
  const auto refused = [](std::size_t offset, std::uint8_t value) {
    TouchballUpBytes bytes = encode(example_up());
    bytes[offset] = value;
    sign(bytes);
    TouchballUp target;
    return decode(bytes.data(), bytes.size(), target).error;
  };
  EXPECT_EQ(refused(4, 2), PacketError::kVersion);
  EXPECT_EQ(refused(7, 1), PacketError::kReserved);
  EXPECT_EQ(refused(33, 1), PacketError::kReserved);
  EXPECT_EQ(refused(36, 200), PacketError::kOutOfRange);
  EXPECT_EQ(refused(kTouchballUpSize - 10, 1), PacketError::kReserved);
  EXPECT_EQ(refused(3, 'D'), PacketError::kMagic);
}

TEST(TouchballPacket, TheMessageNamesFieldValueAndBound) {
  TouchballUp up = example_up();
  up.right.grip = 1.5;
  TouchballUpBytes bytes;
  EXPECT_EQ(to_string(encode(up, bytes)), "right.grip = 1.5: must be in [0, 1]");
  up = example_up();
  up.left.simball_T_handle.translation.y() = 120.0;
  EXPECT_EQ(to_string(encode(up, bytes)), "left.handle_position[1] = 120: must be in [-10, 10]");
  up = example_up();
  up.left.ledger.sent_J = -1.0;
  EXPECT_EQ(to_string(encode(up, bytes)), "left.ledger.sent_J = -1: must be >= 0");
}

TEST(TouchballPacket, RandomBytesWithAGoodChecksumNeverDecodeToGarbage) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 20000; ++i) {
    TouchballUpBytes bytes = encode(example_up());
    for (int k = 0; k < 3; ++k) {
      bytes[8 + random() % (bytes.size() - 12)] = static_cast<std::uint8_t>(random());
    }
    sign(bytes);
    TouchballUp up;
    if (!decode(bytes.data(), bytes.size(), up)) {
      EXPECT_TRUE(is_valid(up.left.simball_T_handle) && is_valid(up.right.simball_T_handle));
      EXPECT_TRUE(up.left.grip >= 0 && up.left.grip <= 1 && up.left.guard.damping.allFinite());
      EXPECT_EQ(encode(up), bytes);
    }
  }
}

}  // namespace
}  // namespace saras
