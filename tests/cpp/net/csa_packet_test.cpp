#include "saras/net/csa_packet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "saras/net/crc32.hpp"
#include "saras/net/touchball_packet.hpp"
#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

using Random = std::mt19937_64;

double number(Random& random) { return std::uniform_real_distribution<>(-9.0, 9.0)(random); }

Pose pose(Random& random) {
  const Quaternion rotation(number(random), number(random), number(random), number(random) + 20.0);
  return {rotation.normalized(), Vector3(number(random), number(random), number(random))};
}

void fill(CsaJoints& values, std::uint32_t joints, Random& random) {
  for (std::uint32_t i = 0; i < joints; ++i) {
    values[i] = number(random);
  }
}

void fill(CsaStream& stream, Random& random) {
  stream.session = random();
  stream.seq = random();
  stream.sender_time_ns = static_cast<std::int64_t>(random());
  stream.echo_session = random();
  stream.echo_seq = random();
  stream.echo_time_ns = static_cast<std::int64_t>(random());
  stream.echo_hold_ns = static_cast<std::int64_t>(random());
}

CsaUp random_up(Random& random) {
  CsaUp up;
  fill(up, random);
  up.homed = random() & 1;
  up.has_force = random() & 1;
  up.state = static_cast<CsaSlaveState>(random() % 4);
  up.hold = static_cast<CsaHold>(random() % 5);
  up.joints = 1 + static_cast<std::uint32_t>(random() % kCsaMaxJoints);
  up.engagement = random();
  fill(up.position, up.joints, random);
  fill(up.velocity, up.joints, random);
  fill(up.effort, up.joints, random);
  up.base_T_tip = pose(random);
  up.tip_twist = {Vector3(number(random), 0.0, 1.0), Vector3(0.0, number(random), 0.0)};
  up.tip_wrench = {Vector3(number(random), 2.0, 0.0), Vector3(0.0, 0.0, number(random))};
  return up;
}

CsaDown random_down(Random& random) {
  CsaDown down;
  fill(down, random);
  down.mode = static_cast<CsaMode>(random() % 3);
  down.joints = down.mode == CsaMode::kJoints ? 1 + static_cast<std::uint32_t>(random() % kCsaMaxJoints) : 0;
  down.engagement = random();
  fill(down.position, down.joints, random);
  down.base_T_tip = pose(random);
  return down;
}

template <typename Bytes>
void sign(Bytes& bytes) {
  const auto crc = crc32(bytes.data(), bytes.size() - 4);
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  }
}

template <typename Bytes>
void put(Bytes& bytes, std::size_t at, double value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);  // the test runs on little-endian machines
  sign(bytes);
}

TEST(CsaPacket, DecodeInvertsEncode) {
  Random random(1);
  for (int draw = 0; draw < 2000; ++draw) {
    const CsaUpBytes up = encode(random_up(random));
    const CsaDownBytes down = encode(random_down(random));
    CsaUp up_again;
    CsaDown down_again;
    ASSERT_FALSE(decode(up.data(), up.size(), up_again));
    ASSERT_FALSE(decode(down.data(), down.size(), down_again));
    ASSERT_EQ(encode(up_again), up);
    ASSERT_EQ(encode(down_again), down);
  }
}

// The bytes are a contract with programs that are not built from this tree (docs/protocols.md).
TEST(CsaPacket, LayoutIsThatOfTheTable) {
  CsaUp up;
  up.homed = up.has_force = true;
  up.state = CsaSlaveState::kPaused;
  up.hold = CsaHold::kRefused;
  up.joints = 7;
  up.engagement = 0x1122;
  up.position[6] = up.velocity[6] = up.effort[6] = 1.0;  // high byte 0x3F
  up.base_T_tip.translation.z() = 1.0;
  up.tip_twist.angular.z() = up.tip_wrench.torque.z() = 1.0;
  up.echo_hold_ns = 0x0405060708090A0B;
  const CsaUpBytes bytes = encode(up);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 4), "SCSU");
  EXPECT_EQ(bytes[4], 1);
  EXPECT_EQ(bytes[56], 0x0B);
  EXPECT_EQ(bytes[64], 3);
  EXPECT_EQ(bytes[68], 2);
  EXPECT_EQ(bytes[72], 3);
  EXPECT_EQ(bytes[76], 7);
  EXPECT_EQ(bytes[80], 0x22);
  for (const std::size_t last : {88 + 7 * 8 - 1, 184 + 7 * 8 - 1, 280 + 7 * 8 - 1, 399, 431, 479, 527}) {
    EXPECT_EQ(bytes[last], 0x3F) << last;
  }
  CsaDown down;
  down.mode = CsaMode::kJoints;
  down.joints = 2;
  down.engagement = 0x33;
  down.position[1] = down.base_T_tip.translation.z() = 1.0;
  const CsaDownBytes out = encode(down);
  EXPECT_EQ(std::string(out.begin(), out.begin() + 4), "SCSD");
  EXPECT_EQ(out[64], 1);
  EXPECT_EQ(out[68], 2);
  EXPECT_EQ(out[72], 0x33);
  EXPECT_EQ(out[80 + 15], 0x3F);
  EXPECT_EQ(out[199], 0x3F);
  EXPECT_EQ(out[231], 0x3F);  // w of the quaternion
}

TEST(CsaPacket, EveryFlippedBitAndEveryOtherLengthIsRefused) {
  Random random(2);
  const CsaDownBytes good = encode(random_down(random));
  CsaDown target;
  target.seq = 77;
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    CsaDownBytes bytes = good;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    ASSERT_TRUE(decode(bytes.data(), bytes.size(), target)) << bit;
  }
  for (std::size_t size = 0; size < good.size(); ++size) {
    ASSERT_EQ(decode(good.data(), size, target).error, PacketError::kSize);
  }
  EXPECT_EQ(target.seq, 77u);
}

TEST(CsaPacket, EveryNumberThatIsNoneIsRefusedByBothEnds) {
  Random random(3);
  CsaUp up = random_up(random);
  up.joints = kCsaMaxJoints;
  fill(up.position, up.joints, random);
  const CsaUpBytes good = encode(up);
  for (std::size_t at = 88; at < 528; at += 8) {
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      CsaUpBytes bytes = good;
      put(bytes, at, bad);
      CsaUp target;
      const PacketFault fault = decode(bytes.data(), bytes.size(), target);
      ASSERT_TRUE(fault.error == PacketError::kNotFinite || fault.error == PacketError::kNotUnit) << at;
    }
  }
  up.effort[3] = std::nan("");
  CsaUpBytes bytes;
  EXPECT_EQ(to_string(encode(up, bytes)), "effort[3] = nan: must be finite");
}

TEST(CsaPacket, TheNumberOfJointsBindsWhatFollows) {
  const auto fault = [](const CsaUp& up) {
    CsaUpBytes bytes;
    return to_string(encode(up, bytes));
  };
  CsaUp up;
  up.joints = 0;
  EXPECT_EQ(fault(up), "joints = 0: must be in [1, 12]");
  up.joints = 13;
  EXPECT_EQ(fault(up), "joints = 13: must be in [1, 12]");
  up.joints = 6;
  up.velocity[6] = 0.1;
  EXPECT_EQ(fault(up), "velocity[6] = 0.10000000000000001: must be in [0, 0]");
  up = {};
  up.base_T_tip.translation.x() = 100.0;
  EXPECT_EQ(fault(up), "tip_position[0] = 100: must be in [-10, 10]");
  CsaDown down;
  CsaDownBytes bytes;
  down.mode = CsaMode::kJoints;
  EXPECT_EQ(to_string(encode(down, bytes)), "joints = 0: must be in [1, 12]");
  down.mode = CsaMode::kCartesian;
  down.joints = 6;
  EXPECT_EQ(to_string(encode(down, bytes)), "joints = 6: must be in [0, 0]");
  // A forged count of 2^32 - 1 reads nothing beyond the datagram.
  CsaUpBytes forged = encode(CsaUp{});
  std::fill(forged.begin() + 76, forged.begin() + 80, std::uint8_t{0xFF});
  sign(forged);
  CsaUp target;
  EXPECT_EQ(decode(forged.data(), forged.size(), target).error, PacketError::kOutOfRange);
}

TEST(CsaPacket, EnumsReservedBitsAndOtherProtocolsAreRefused) {
  const auto refused = [](std::size_t offset, std::uint8_t value) {
    CsaUpBytes bytes = encode(CsaUp{});
    bytes[offset] = value;
    sign(bytes);
    CsaUp target;
    return decode(bytes.data(), bytes.size(), target).error;
  };
  EXPECT_EQ(refused(4, 2), PacketError::kVersion);
  EXPECT_EQ(refused(7, 1), PacketError::kReserved);
  EXPECT_EQ(refused(64, 4), PacketError::kReserved);
  EXPECT_EQ(refused(68, 4), PacketError::kOutOfRange);
  EXPECT_EQ(refused(72, 5), PacketError::kOutOfRange);
  EXPECT_EQ(refused(3, 'D'), PacketError::kMagic);
  EXPECT_EQ(refused(0, 'T'), PacketError::kMagic);
  EXPECT_EQ(refused(6, 1), PacketError::kAuthenticated);
  // A handshake of one protocol is none of the other: the same keys may serve both.
  CsaHandshakeBytes hello;
  encode(CsaHandshake{}, hello);
  EXPECT_EQ(check_frame<TouchballHandshake>(hello.data(), hello.size(), Authentication::kTag).error,
            PacketError::kMagic);
  EXPECT_FALSE(check_frame<CsaHandshake>(hello.data(), hello.size(), Authentication::kTag));
  const std::array<std::uint8_t, kPacketTagSize> tag{9};
  seal(hello.data(), hello.size(), tag.data());
  EXPECT_NO_THROW(decode_csa_handshake(hello.data(), hello.size()));
  EXPECT_THROW(decode_csa_up(hello.data(), hello.size()), ProtocolError);
  EXPECT_THROW(decode_csa_down(nullptr, 0), ProtocolError);
}

}  // namespace
}  // namespace saras
