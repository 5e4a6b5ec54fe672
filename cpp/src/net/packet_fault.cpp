// What a refused packet is told to its user.
#include "saras/net/packet_fault.hpp"

#include <cstring>
#include <sstream>

#include "frame.hpp"

namespace saras {

std::string to_string(const PacketFault& fault) {
  std::ostringstream text;
  text.precision(17);
  text << fault.side << (*fault.side ? "." : "") << fault.field;
  if (fault.element >= 0) {
    text << '[' << fault.element << ']';
  }
  const auto hex = [&text](double value) -> std::ostream& {
    return text << "0x" << std::hex << static_cast<std::uint64_t>(value) << std::dec;
  };
  text << " = ";
  switch (fault.error) {
    case PacketError::kNone:
      return "no fault";
    case PacketError::kSize:
      text << fault.value << " bytes: this packet has " << fault.lowest;
      break;
    case PacketError::kChecksum:
      hex(fault.value) << ": the datagram is damaged, its CRC-32 is ";
      hex(fault.lowest);
      break;
    case PacketError::kMagic:
      hex(fault.value) << ": another protocol or direction, expected ";
      hex(fault.lowest);
      break;
    case PacketError::kVersion:
      text << fault.value << ": this program speaks version " << fault.lowest;
      break;
    case PacketError::kAuthenticated:
      hex(fault.value) << ": the datagram is authenticated, this end has no key file";
      break;
    case PacketError::kUnauthenticated:
      hex(fault.value) << ": the datagram is not authenticated, give its sender the key file of this end";
      break;
    case PacketError::kReserved:
      hex(fault.value) << ": reserved bits must be 0";
      break;
    case PacketError::kNotFinite:
      text << fault.value << ": must be finite";
      break;
    case PacketError::kOutOfRange:
      text << fault.value << ": must be ";
      if (fault.highest == wire::kUnbounded) {
        text << ">= " << fault.lowest;
      } else {
        text << "in [" << fault.lowest << ", " << fault.highest << ']';
      }
      break;
    case PacketError::kNotUnit:
      text << fault.value << " (norm): must be 1 within 1e-6";
      break;
  }
  return text.str();
}

void seal(std::uint8_t* bytes, std::size_t size, const std::uint8_t* tag) noexcept {
  std::memcpy(bytes + size - kPacketTrailerSize, tag, kPacketTagSize);
  wire::put(bytes + size - wire::kChecksumSize, crc32(bytes, size - wire::kChecksumSize), 4);
}

}  // namespace saras
