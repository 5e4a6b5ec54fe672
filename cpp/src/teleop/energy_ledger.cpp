#include "saras/teleop/energy_ledger.hpp"

#include <algorithm>
#include <cmath>

namespace saras {

void LedgerSender::send(double energy_J) noexcept {
  if (std::isfinite(energy_J) && energy_J > 0.0) {
    message_.sent_J += energy_J;
  }
}

LedgerMessage LedgerSender::next() noexcept {
  ++message_.seq;
  return message_;
}

double LedgerReceiver::credit(const LedgerMessage& message) noexcept {
  const bool usable = std::isfinite(message.sent_J) && message.sent_J >= 0.0;
  const bool older = state_.has_baseline && (message.session < state_.session ||
                                             (message.session == state_.session && message.seq <= state_.seq));
  if (!usable || older) {
    ++state_.ignored;
    return 0.0;
  }
  if (!state_.has_baseline || message.session > state_.session) {
    state_.has_baseline = true;
    state_.session = message.session;
    state_.seq = message.seq;
    state_.seen_J = message.sent_J;
    return 0.0;
  }
  state_.seq = message.seq;
  const double credit_J = std::max(0.0, message.sent_J - state_.seen_J);
  state_.seen_J = std::max(state_.seen_J, message.sent_J);
  state_.credited_J += credit_J;
  return credit_J;
}

}  // namespace saras
