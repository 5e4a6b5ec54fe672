// Who may move an arm: one operator at a time, by claim, and from one to the next by offer and acceptance.
#pragma once

#include <array>
#include <cstdint>

#include "saras/spatial/law.hpp"

namespace saras {

/// Operators are 1..kMaxOperators.
inline constexpr std::uint8_t kNobody = 0;
inline constexpr std::uint8_t kMaxOperators = 4;

enum class LeaseAct : std::uint8_t { kSilent = 0, kRelease, kWithdraw, kOffer, kAccept, kClaim };
inline constexpr std::size_t kLeaseActs = 6;
const char* to_string(LeaseAct act) noexcept;

struct LeaseState {
  std::uint8_t holder = kNobody;
  std::uint8_t offered_to = kNobody;  ///< by the holder; nobody when there is no offer
};
constexpr bool operator==(const LeaseState& a, const LeaseState& b) noexcept {
  return a.holder == b.holder && a.offered_to == b.offered_to;
}

/// What one act of operator `by` does; `to` counts for an offer only. An act that `by` may not do changes nothing.
constexpr LeaseState next_lease(LeaseState state, LeaseAct act, std::uint8_t by, std::uint8_t to = kNobody) noexcept {
  if (by == kNobody || by > kMaxOperators || to > kMaxOperators) {
    return state;
  }
  const bool holds = state.holder == by;
  switch (act) {
    case LeaseAct::kSilent:
      if (holds) {
        return {};
      }
      return {state.holder, state.offered_to == by ? kNobody : state.offered_to};
    case LeaseAct::kRelease:
      return holds ? LeaseState{} : state;
    case LeaseAct::kWithdraw:
      return holds ? LeaseState{by, kNobody} : state;
    case LeaseAct::kOffer:
      return holds && to != by && to != kNobody ? LeaseState{by, to} : state;
    case LeaseAct::kAccept:
      return state.holder != kNobody && state.offered_to == by ? LeaseState{by, kNobody} : state;
    case LeaseAct::kClaim:
      return state.holder == kNobody ? LeaseState{by, kNobody} : state;
  }
  return state;
}

/// What one operator's console says in one step.
struct OperatorSigns {
  bool alive = false;  ///< heard within its limit; ages are judged by the caller
  bool claim = false;
  bool release = false;
  bool withdraw = false;            ///< takes an offer back
  bool accept = false;              ///< takes what was offered in an earlier step
  std::uint8_t offer_to = kNobody;  ///< operator to whom the lease is offered
};

struct LeaseInput {
  std::array<OperatorSigns, kMaxOperators> operators;  ///< [i] is operator i + 1
};

struct LeaseOutput {
  std::uint8_t holder = kNobody;
  std::uint8_t offered_to = kNobody;
  std::array<bool, kMaxOperators> refused{};  ///< this operator asked for something that it may not have now
  Status status = Status::kOk;                ///< WAITING: nobody holds the arm; INVALID_*: nothing was granted
};

/// The lease of one arm. Silence of the holder releases to nobody, never to another operator, and nobody can claim in
/// the same step: the supervisor always sees the gap and holds. An offer is accepted in a later step than it was made
/// in, so that who accepts has seen it. Of two who claim in one step the lower number gets it.
///
/// dt not finite or <= 0, or an offer to a number that is no operator: releases and silence still count, nothing is
/// granted or offered. Time enters in no other way.
class Lease {
 public:
  Lease() = default;
  LeaseOutput step(const LeaseInput& input, Seconds dt) noexcept;
  void reset(const LeaseState& state = {}) { state_ = state; }
  const LeaseState& state() const { return state_; }

 private:
  LeaseState state_;
};

static_assert(has_law_shape<Lease, LeaseInput, LeaseState>());

}  // namespace saras
