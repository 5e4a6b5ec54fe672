// libFuzzer over what stands between a slave arm on the network and the laws. As touchball_fuzz.
#include "datagrams.hpp"
#include "saras/net/csa_packet.hpp"

namespace {

using namespace saras;

constexpr fuzz::Protocol kProtocol{{"SCSU", "SCSD", "SCSH"}, {kCsaUpSize, kCsaDownSize, kHandshakeSize}};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  if (const char* directory = std::getenv("SARAS_FUZZ_SEEDS")) {
    CsaUp up;
    up.session = 7;
    up.seq = 1;
    up.joints = 7;
    up.position[6] = 0.5;
    up.velocity[0] = -0.25;
    up.base_T_tip = {Quaternion(0.5, 0.5, -0.5, 0.5), Vector3(0.01, -0.02, -0.13)};
    up.has_force = true;
    up.tip_wrench.force = {1.0, -2.0, 0.5};
    CsaDown down;
    down.mode = CsaMode::kJoints;
    down.joints = 7;
    down.position[6] = 0.5;
    down.engagement = 3;
    fuzz::write_seeds(directory, up, down, CsaHandshake{});
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
  fuzz::take<CsaUp, CsaUpBytes, CsaDown, CsaDownBytes, CsaHandshake>(receiver, data, size);
  return 0;
}
