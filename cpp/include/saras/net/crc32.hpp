// CRC-32 of IEEE 802.3 (reflected polynomial 0xEDB88320, as in zlib).
#pragma once

#include <cstddef>
#include <cstdint>

namespace saras {

std::uint32_t crc32(const std::uint8_t* data, std::size_t size) noexcept;

}  // namespace saras
