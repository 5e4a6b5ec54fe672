#include "saras/safety/lease.hpp"

#include <limits>

namespace saras {
namespace {

/// One operator's acts that give something away or take a word back: always allowed, whatever else is wrong.
void apply_leaving(LeaseState& state, const OperatorSigns& signs, std::uint8_t by) noexcept {
  if (!signs.alive) {
    state = next_lease(state, LeaseAct::kSilent, by);
  }
  if (signs.release) {
    state = next_lease(state, LeaseAct::kRelease, by);
  }
  if (signs.withdraw) {
    state = next_lease(state, LeaseAct::kWithdraw, by);
  }
}

}  // namespace

const char* to_string(LeaseAct act) noexcept {
  switch (act) {
    case LeaseAct::kSilent:
      return "SILENT";
    case LeaseAct::kRelease:
      return "RELEASE";
    case LeaseAct::kWithdraw:
      return "WITHDRAW";
    case LeaseAct::kOffer:
      return "OFFER";
    case LeaseAct::kAccept:
      return "ACCEPT";
    case LeaseAct::kClaim:
      return "CLAIM";
  }
  return "UNKNOWN";
}

LeaseOutput Lease::step(const LeaseInput& input, Seconds dt) noexcept {
  LeaseOutput output;
  const LeaseState before = state_;
  for (std::uint8_t by = 1; by <= kMaxOperators; ++by) {
    apply_leaving(state_, input.operators[by - 1U], by);
  }
  if (!is_valid_time_step(dt, std::numeric_limits<double>::infinity())) {
    output.status = Status::kInvalidTimeStep;
  }
  for (const OperatorSigns& signs : input.operators) {
    if (signs.offer_to > kMaxOperators) {
      output.status = Status::kInvalidInput;
    }
  }
  const bool valid = output.status == Status::kOk;
  // Who left in this step leaves the arm to nobody; an offer made in this step is accepted in a later one.
  const LeaseState standing = state_;
  for (std::uint8_t by = 1; by <= kMaxOperators; ++by) {
    const OperatorSigns& signs = input.operators[by - 1U];
    bool& refused = output.refused[by - 1U];
    const bool may_ask = valid && signs.alive;
    if (signs.offer_to != kNobody) {
      const bool possible = may_ask && standing.holder == by && signs.offer_to != by && !signs.withdraw &&
                            signs.offer_to <= kMaxOperators && input.operators[signs.offer_to - 1U].alive;
      // Accepted by a lower number in this very step: it is no longer his to offer.
      if (possible && state_.holder == by) {
        state_ = next_lease(state_, LeaseAct::kOffer, by, signs.offer_to);
      } else {
        refused = true;
      }
    }
    if (signs.accept) {
      if (may_ask && standing.holder != kNobody && standing.offered_to == by && state_.offered_to == by) {
        state_ = next_lease(state_, LeaseAct::kAccept, by);
      } else {
        refused = true;
      }
    }
    if (signs.claim && standing.holder != by) {
      if (may_ask && before.holder == kNobody && state_.holder == kNobody) {
        state_ = next_lease(state_, LeaseAct::kClaim, by);
      } else {
        refused = true;
      }
    }
  }
  output.holder = state_.holder;
  output.offered_to = state_.offered_to;
  if (valid && state_.holder == kNobody) {
    output.status = Status::kWaiting;
  }
  return output;
}

}  // namespace saras
