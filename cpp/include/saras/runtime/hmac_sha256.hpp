// HMAC-SHA-256 under one key, ready to use many times: OpenSSL's SHA-256, no allocation and no lock once made.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace saras {

using HmacKey = std::array<std::uint8_t, 32>;
using HmacTag = std::array<std::uint8_t, 32>;

class HmacSha256 {
 public:
  HmacSha256();
  explicit HmacSha256(const HmacKey& key) : HmacSha256() { set_key(key); }
  ~HmacSha256();
  HmacSha256(const HmacSha256&) = delete;
  HmacSha256& operator=(const HmacSha256&) = delete;

  void set_key(const HmacKey& key) noexcept;
  HmacTag tag(const std::uint8_t* data, std::size_t size) const noexcept;
  /// In a time that does not depend on where they differ.
  static bool same(const std::uint8_t* a, const std::uint8_t* b, std::size_t size) noexcept;

 private:
  struct Contexts;
  std::unique_ptr<Contexts> contexts_;
};

}  // namespace saras
