#include "saras/net/crc32.hpp"

#include <array>

namespace saras {
namespace {

constexpr std::array<std::uint32_t, 256> make_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t remainder = i;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1u) ? 0xEDB88320u : 0u);
    }
    table[i] = remainder;
  }
  return table;
}

constexpr auto kTable = make_table();

}  // namespace

std::uint32_t crc32(const std::uint8_t* data, std::size_t size) noexcept {
  std::uint32_t remainder = 0xFFFFFFFFu;
  for (std::size_t i = 0; i < size; ++i) {
    remainder = (remainder >> 8) ^ kTable[(remainder ^ data[i]) & 0xFFu];
  }
  return ~remainder;
}

}  // namespace saras
