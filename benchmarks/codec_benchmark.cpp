#include "groups.hpp"
#include "saras/net/touchball_packet.hpp"

namespace saras::benchmarks {
namespace {

constexpr int kCount = 100000;

TouchballUp up_packet() {
  TouchballUp packet;
  packet.session = 7;
  for (TouchballUpSide* side : {&packet.left, &packet.right}) {
    side->present = side->calibrated = true;
    side->simball_T_handle.translation = {0.01, 0.02, 0.03};
    side->ledger.sent_J = 0.25;
    side->guard.energy_J = 0.4;
  }
  return packet;
}

}  // namespace

std::vector<Row> codec_rows() {
  std::vector<Row> rows;
  TouchballUp up = up_packet();
  TouchballUpBytes up_bytes{};
  rows.push_back(measure("codec", "touchball_up_encode", kCount, [&](int i) {
    up.seq = static_cast<std::uint64_t>(i);
    keep(encode(up, up_bytes));
  }));
  TouchballUp received;
  rows.push_back(measure("codec", "touchball_up_decode", kCount,
                         [&](int) { keep(decode(up_bytes.data(), up_bytes.size(), received)); }));

  TouchballDown down;
  down.left.touch_wrench.force = down.right.touch_wrench.force = {0.5, -0.2, 1.0};
  TouchballDownBytes down_bytes{};
  rows.push_back(measure("codec", "touchball_down_encode", kCount, [&](int i) {
    down.seq = static_cast<std::uint64_t>(i);
    keep(encode(down, down_bytes));
  }));
  TouchballDown answered;
  rows.push_back(measure("codec", "touchball_down_decode", kCount,
                         [&](int) { keep(decode(down_bytes.data(), down_bytes.size(), answered)); }));
  return rows;
}

}  // namespace saras::benchmarks
