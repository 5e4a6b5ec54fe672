// Two lines a law: Input in; expect_no_allocation(Law(config), in, {&in.field_that_moves});
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>

#include "saras/spatial/law.hpp"
#include "support/malloc_counter.hpp"

namespace saras::test {

/// Steps a law over good, moving, non-finite, stalled and again good input and expects no allocation in any step.
/// moving: numbers in the input that are moved and spoilt on the way.
template <typename Law, typename Input>
void expect_no_allocation(Law law, Input& input, std::initializer_list<double*> moving) {
  if (!can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Seconds dt : {0.01, 0.01, 0.0, kNan, 100.0, 0.01}) {
    for (const double value : {0.0, 1e-4, 2e-4, kNan, 3e-4, 5.0, 5.0}) {
      for (double* number : moving) {
        *number = value;
      }
      const MallocCounter counter;
      const auto output = law.step(input, dt);
      const std::size_t allocations = counter.count();
      EXPECT_EQ(allocations, 0u) << "value " << value << ", dt " << dt << ", " << to_string(output.status);
    }
  }
}

}  // namespace saras::test
