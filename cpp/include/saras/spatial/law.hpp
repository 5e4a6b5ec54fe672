// The one shape of everything that runs each tick.
//
//   struct XConfig { ...; void validate() const; };   refuses bad values with a ConfigError
//   struct XInput, XOutput { ...; Status status; }, XState     plain copyable values
//   class X { explicit X(XConfig); XOutput step(const XInput&, Seconds dt) noexcept;
//             void reset(const XState& = {}); const XState& state() const; };
//
// step allocates nothing, throws nothing and reads no clock: time is an argument. Bad input gives the
// safe output and a status, and leaves the state as it was. Because the state is a value, a recorded
// run replays bit for bit.
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>

#include "saras/spatial/status.hpp"
#include "saras/spatial/types.hpp"

namespace saras {

template <typename Law, typename Input, typename State>
constexpr bool has_law_shape() {
  using Step = decltype(std::declval<Law&>().step(std::declval<const Input&>(), Seconds{}));
  return noexcept(std::declval<Law&>().step(std::declval<const Input&>(), Seconds{})) &&
         std::is_same_v<decltype(std::declval<Step>().status), Status> &&
         std::is_same_v<decltype(std::declval<const Law&>().state()), const State&> &&
         std::is_copy_constructible_v<State> && std::is_copy_assignable_v<State>;
}

/// True for a time step that a law may integrate over.
inline bool is_valid_time_step(Seconds dt, Seconds dt_max) noexcept {
  return std::isfinite(dt) && dt > 0.0 && dt <= dt_max;
}

}  // namespace saras
