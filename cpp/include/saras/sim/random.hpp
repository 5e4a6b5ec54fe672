// A small seeded generator whose whole state is one number, so that it can live in a law's State and a run repeats
// bit for bit on every platform (the distributions of <random> differ between standard libraries).
#pragma once

#include <cstdint>

namespace saras {

/// SplitMix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed = 0) : state_(seed) {}

  std::uint64_t bits() noexcept;
  /// Uniform in [0, 1).
  double uniform() noexcept;
  /// True with the given probability; always uses one draw, so that changing a probability keeps the other draws.
  bool chance(double probability) noexcept { return uniform() < probability; }
  /// Standard normal (Box-Muller).
  double normal() noexcept;

 private:
  std::uint64_t state_;
};

}  // namespace saras
