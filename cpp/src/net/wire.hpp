// Little-endian reader and writer that check each value where it crosses the wire.
//
// A packet's layout is written once, as a template over Writer or Reader; both refuse the same values.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "saras/net/packet_fault.hpp"
#include "saras/spatial/types.hpp"

namespace saras::wire {

inline constexpr double kUnbounded = std::numeric_limits<double>::max();

inline void put(std::uint8_t* bytes, std::uint64_t value, int count) noexcept {
  for (int i = 0; i < count; ++i) {
    bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}
inline std::uint64_t get(const std::uint8_t* bytes, int count) noexcept {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) {
    value |= static_cast<std::uint64_t>(bytes[i]) << (8 * i);
  }
  return value;
}

/// What Writer and Reader share: the first fault found, and which side is being handled.
class Checked {
 public:
  void side(const char* name) noexcept { side_ = name; }
  const PacketFault& fault() const noexcept { return fault_; }
  void refuse(PacketError error, const char* field, double value, double lowest = 0, double highest = 0,
              int element = -1) noexcept {
    if (!fault_) {
      fault_ = {error, side_, field, element, value, lowest, highest};
    }
  }

 protected:
  void check(const char* field, double value, double lowest, double highest, int element) noexcept {
    if (!std::isfinite(value)) {
      refuse(PacketError::kNotFinite, field, value, lowest, highest, element);
    } else if (value < lowest || value > highest) {
      refuse(PacketError::kOutOfRange, field, value, lowest, highest, element);
    }
  }
  void check_unit(const char* field, const Quaternion& rotation) noexcept {
    const double norm = rotation.norm();
    if (!(std::abs(norm - 1.0) <= kUnitQuaternionTolerance)) {
      refuse(PacketError::kNotUnit, field, norm);
    }
  }

 private:
  const char* side_ = "";
  PacketFault fault_;
};

class Writer : public Checked {
 public:
  explicit Writer(std::uint8_t* bytes) noexcept : at_(bytes) {}

  template <typename Integer>
  void integer(const Integer& value, int bytes = sizeof(Integer)) noexcept {
    put(at_, static_cast<std::uint64_t>(value), bytes);
    at_ += bytes;
  }
  void number(const char* field, const double& value, double lowest = -kUnbounded, double highest = kUnbounded,
              int element = -1) noexcept {
    check(field, value, lowest, highest, element);
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    integer(bits);
  }
  template <typename Vector>
  void vector(const char* field, const Vector& value, double lowest = -kUnbounded,
              double highest = kUnbounded) noexcept {
    for (int i = 0; i < static_cast<int>(value.size()); ++i) {
      number(field, value[i], lowest, highest, i);
    }
  }
  void quaternion(const char* field, const Quaternion& value) noexcept {
    vector(field, value.coeffs());
    check_unit(field, value);
  }
  template <typename Enum>
  void enumeration(const char* field, const Enum& value, Enum highest) noexcept {
    check(field, static_cast<double>(value), 0.0, static_cast<double>(highest), -1);
    integer(static_cast<std::uint32_t>(value));
  }
  /// A u32 within bounds.
  void count(const char* field, const std::uint32_t& value, std::uint32_t lowest, std::uint32_t highest) noexcept {
    check(field, value, lowest, highest, -1);
    integer(value);
  }
  /// One u32; flag i is bit i.
  template <typename... Flags>
  void flags(const Flags&... flag) noexcept {
    std::uint32_t bits = 0;
    int i = 0;
    ((bits |= (flag ? 1u : 0u) << i++), ...);
    integer(bits);
  }

 private:
  std::uint8_t* at_;
};

class Reader : public Checked {
 public:
  explicit Reader(const std::uint8_t* bytes) noexcept : at_(bytes) {}

  template <typename Integer>
  void integer(Integer& value, int bytes = sizeof(Integer)) noexcept {
    value = static_cast<Integer>(get(at_, bytes));
    at_ += bytes;
  }
  void number(const char* field, double& value, double lowest = -kUnbounded, double highest = kUnbounded,
              int element = -1) noexcept {
    std::uint64_t bits = 0;
    integer(bits);
    std::memcpy(&value, &bits, sizeof value);
    check(field, value, lowest, highest, element);
  }
  template <typename Vector>
  void vector(const char* field, Vector& value, double lowest = -kUnbounded, double highest = kUnbounded) noexcept {
    for (int i = 0; i < static_cast<int>(value.size()); ++i) {
      number(field, value[i], lowest, highest, i);
    }
  }
  void quaternion(const char* field, Quaternion& value) noexcept {
    vector(field, value.coeffs());
    check_unit(field, value);
  }
  template <typename Enum>
  void enumeration(const char* field, Enum& value, Enum highest) noexcept {
    std::uint32_t number = 0;
    integer(number);
    check(field, number, 0.0, static_cast<double>(highest), -1);
    value = static_cast<Enum>(number);
  }
  void count(const char* field, std::uint32_t& value, std::uint32_t lowest, std::uint32_t highest) noexcept {
    integer(value);
    check(field, value, lowest, highest, -1);
  }
  template <typename... Flags>
  void flags(Flags&... flag) noexcept {
    std::uint32_t bits = 0;
    integer(bits);
    if (bits >> sizeof...(flag)) {
      refuse(PacketError::kReserved, "flags", bits);
    }
    int i = 0;
    ((flag = (bits >> i++) & 1u), ...);
  }

 private:
  const std::uint8_t* at_;
};

}  // namespace saras::wire
