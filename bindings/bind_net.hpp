// What the bindings of all datagrams share.
#pragma once

#include <algorithm>
#include <string>

#include "law.hpp"
#include "saras/net/packet_fault.hpp"

namespace saras::bindings {

void bind_net_csa(py::module_& m);

template <typename Bytes>
py::bytes to_bytes(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <typename Decode>
auto decode_buffer(const py::buffer& data, Decode decode) {
  const py::buffer_info info = data.request();
  return decode(static_cast<const std::uint8_t*>(info.ptr), static_cast<std::size_t>(info.size * info.itemsize));
}

inline Authentication authentication(bool authenticated) {
  return authenticated ? Authentication::kTag : Authentication::kNone;
}

template <typename Packet>
auto frame_checker() {
  return [](const py::buffer& data, bool authenticated) {
    const PacketFault fault = decode_buffer(data, [&](const std::uint8_t* bytes, std::size_t size) {
      return check_frame<Packet>(bytes, size, authentication(authenticated));
    });
    if (fault) {
      throw ProtocolError(to_string(fault));
    }
  };
}

inline constexpr const char* kCheckFrameDoc =
    "Length, magic, version, and a tag or none as wanted: what is checked before the tag. Raises ProtocolError.";
inline constexpr const char* kEncodeDoc =
    "Bytes; raises ProtocolError. An authenticated datagram is whole only after seal().";
inline constexpr const char* kDecodeDoc =
    "Strict; raises ProtocolError naming field and value. The tag is the caller's to check, before.";

/// encode, check_frame, decode and SIZE of a packet that may or may not carry a tag.
template <typename Packet, typename Decode>
void bind_codec(Struct<Packet>& packet, Decode decode, std::size_t size) {
  packet.cls()
      .def(
          "encode",
          [](const Packet& self, bool authenticated) { return to_bytes(encode(self, authentication(authenticated))); },
          py::arg("authenticated") = false, kEncodeDoc)
      .def_static("check_frame", frame_checker<Packet>(), py::arg("data"), py::arg("authenticated"), kCheckFrameDoc)
      .def_static(
          "decode",
          [decode](const py::buffer& data, bool authenticated) {
            return decode_buffer(data, [&](const std::uint8_t* bytes, std::size_t length) {
              return decode(bytes, length, authentication(authenticated));
            });
          },
          py::arg("data"), py::arg("authenticated") = false, kDecodeDoc);
  packet.cls().attr("SIZE") = size;
}

/// A nonce as bytes on the Python side.
using Nonce = std::array<std::uint8_t, 16>;

inline Nonce to_nonce(const py::bytes& value) {
  const std::string text = value;
  Nonce nonce;
  if (text.size() != nonce.size()) {
    throw ProtocolError("nonce: " + std::to_string(text.size()) + " bytes: must be 16");
  }
  std::copy(text.begin(), text.end(), nonce.begin());
  return nonce;
}

template <typename Packet, typename Decode>
void bind_handshake(py::module_& m, const char* name, Decode decode) {
  Struct<Packet> packet(m, name, "Message that begins an authenticated session.");
  packet
      .field(
          "nonce", [](Packet& self) { return to_bytes(self.nonce); },
          [](Packet& self, const py::bytes& value) { self.nonce = to_nonce(value); }, "(16 bytes) drawn by the sender")
      .field(
          "echo", [](Packet& self) { return to_bytes(self.echo); },
          [](Packet& self, const py::bytes& value) { self.echo = to_nonce(value); },
          "(16 bytes) the receiver's own nonce, as the sender heard it; 0: none");
  packet.cls()
      .def(
          "encode",
          [](const Packet& self) {
            std::array<std::uint8_t, kHandshakeSize> bytes;
            encode(self, bytes);
            return to_bytes(bytes);
          },
          "Bytes, whole only after seal().")
      .def_static("check_frame", frame_checker<Packet>(), py::arg("data"), py::arg("authenticated") = true,
                  kCheckFrameDoc)
      .def_static(
          "decode", [decode](const py::buffer& data) { return decode_buffer(data, decode); }, py::arg("data"),
          kDecodeDoc);
  packet.cls().attr("SIZE") = kHandshakeSize;
}

}  // namespace saras::bindings
