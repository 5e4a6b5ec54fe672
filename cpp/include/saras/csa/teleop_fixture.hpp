// A virtual fixture of ordinary teleoperation: where the set-point may go, and what the hand feels of it.
#pragma once

#include <vector>

#include "saras/csa/virtual_fixture.hpp"

namespace saras::csa {

/// In the arm's base frame. A hard fixture is a wall that the set-point does not pass; a soft one only tells the hand.
struct TeleopFixture {
  Fixture fixture;               ///< any kind but a remote centre: an arm that pivots about its trocar has one
  double stiffness_N_m = 150.0;  ///< force on the hand per metre that the tip is nearer than start_m
  double start_m = 0.003;        ///< the force begins this far on the allowed side of the border
  void validate() const;         ///< throws ConfigError naming the fixture, field, value, bound
};

/// What holds at the moment of all fixtures of a side.
struct FixtureWord {
  bool on = true;     ///< switched off: neither wall nor force, distances are told all the same
  bool known = true;  ///< whether it is known where they are; if not, the set-point stands and the force fades
};

/// All validated, as one set. Throws ConfigError; also for names that repeat and more than a set holds.
FixtureSet fixture_set(const std::vector<TeleopFixture>& fixtures);
/// The same of the hard ones.
FixtureSet hard_fixture_set(const std::vector<TeleopFixture>& fixtures);

/// A geometry as plain numbers, for records: its kind is the variant's index.
std::vector<double> to_numbers(const FixtureGeometry& geometry);
/// Inverse of to_numbers. Throws ConfigError for a kind or a count of numbers that to_numbers never gives.
FixtureGeometry to_geometry(int kind, const std::vector<double>& numbers);

}  // namespace saras::csa
