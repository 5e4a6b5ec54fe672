// What the hand feels of virtual fixtures: springs towards the allowed side, towards a line or a path.
#pragma once

#include "saras/csa/teleop_fixture.hpp"

namespace saras::csa {

struct FixtureForceConfig {
  double force_limit_N = 1.5;  ///< of one fixture, and of all together
  Seconds ramp_s = 0.1;        ///< the force moves by at most its limit in this time
  Seconds dt_max_s = 0.1;      ///< longest time step
  void validate() const;       ///< throws ConfigError
};

struct FixtureForceInput {
  Pose base_T_tip;                       ///< measured
  Vector3 hand_ahead = Vector3::Zero();  ///< from the tip to where the hand wants it [m]; zero: not known
  FixtureWord word;
};

struct FixtureForceOutput {
  FixtureForceOutput() { distance_m.fill(std::numeric_limits<double>::quiet_NaN()); }

  Wrench wrench;                                ///< on the operator's hand, base axes
  std::array<double, kMaxFixtures> distance_m;  ///< of the tip to each border; negative: passed; NaN: unknown, or none
  int nearest = -1;                             ///< fixture with the least distance
  Vector3 closest = Vector3::Zero();            ///< its closest point, base frame
  Vector3 normal = Vector3::Zero();             ///< its direction towards what is allowed
  double violation_m = 0.0;                     ///< how far the tip is beyond the nearest border
  Status status = Status::kWaiting;  ///< LIMITED: a force is due. WAITING: no fixture is there, or they are off
};

struct FixtureForceState {
  Vector3 force = Vector3::Zero();
  FixtureState fixtures;
};

/// Each fixture: stiffness * max(0, start - d) towards what it allows. Of a wall d is the lesser of the tip's distance
/// and of that where the hand wants the tip, the latter along the tip's own normal: a hand that is past a thin wall is
/// not pulled to its far side. A hull kept in sums its faces, at most the corner of three. A line or path guides from
/// where the hand wants the tip; its force begins no further in than its middle. Never a pull towards a wall. The sum
/// is limited, and moves by at most force_limit / ramp_s: switching, an unknown place and a change of face are no step.
///
/// Fixtures or tip not known: force to zero on the ramp, distances NaN (STALE, INVALID_INPUT). Time step not valid:
/// zero at once (INVALID_TIME_STEP). What it may cost is tank_master's matter.
class FixtureForce {
 public:
  /// Throws ConfigError.
  FixtureForce(FixtureForceConfig config, const std::vector<TeleopFixture>& fixtures);
  FixtureForceOutput step(const FixtureForceInput& input, Seconds dt) noexcept;
  void reset(const FixtureForceState& state = {});
  const FixtureForceState& state() const { return state_; }
  const FixtureForceConfig& config() const { return config_; }
  const std::vector<TeleopFixture>& fixtures() const { return fixtures_; }

 private:
  Vector3 wall(const FixtureOutput& found, std::size_t fixture, const Vector3& hand_ahead) const noexcept;
  Vector3 guide(const FixtureOutput& of_hand, std::size_t fixture) const noexcept;
  Vector3 wanted(const FixtureForceInput& input, FixtureForceOutput& output) noexcept;

  FixtureForceConfig config_;
  std::vector<TeleopFixture> fixtures_;
  FixtureSet set_;
  std::vector<double> tube_m_;  ///< radius of each line and path; -1: a wall
  bool guides_ = false;         ///< whether there is a line or a path
  FixtureForceState state_;
};

static_assert(has_law_shape<FixtureForce, FixtureForceInput, FixtureForceState>());

}  // namespace saras::csa
