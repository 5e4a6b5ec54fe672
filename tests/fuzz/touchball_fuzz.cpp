// libFuzzer over what stands between a console and the laws: the decoders, and the windows behind them.
// Run by script/fuzz. With SARAS_FUZZ_SEEDS=DIR it writes a corpus of encoded datagrams into DIR and ends.
#include "datagrams.hpp"
#include "saras/net/touchball_packet.hpp"

namespace {

using namespace saras;

constexpr fuzz::Protocol kProtocol{{"STBU", "STBD", "STBH"},
                                   {kTouchballUpSize, kTouchballDownSize, kTouchballHandshakeSize}};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  if (const char* directory = std::getenv("SARAS_FUZZ_SEEDS")) {
    TouchballUp up;
    up.session = 7;
    up.seq = 1;
    up.left.present = up.left.calibrated = up.right.clutch = true;
    up.left.simball_T_handle = {Quaternion(0.5, 0.5, -0.5, 0.5), Vector3(0.01, -0.02, 0.13)};
    up.left.guard.energy_J = 0.4;
    up.right.ledger = {9, 8, 1.5, true, false};
    TouchballDown down;
    down.left.touch_wrench.force = {1.0, -2.0, 0.5};
    down.left.state = ChannelState::kEngaged;
    fuzz::write_seeds(directory, up, down, TouchballHandshake{});
    std::exit(0);
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return fuzz::mutate(kProtocol, data, size, max_size, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::Receiver receiver;  // a stream over all inputs
  fuzz::take<TouchballUp, TouchballUpBytes, TouchballDown, TouchballDownBytes, TouchballHandshake>(receiver, data,
                                                                                                   size);
  return 0;
}
