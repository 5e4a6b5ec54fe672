#include "saras/safety/supervisor.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

constexpr Seconds kDt = 0.01;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// All there, aligned, held by operator 1, nobody asks for anything.
SupervisorInput calm() {
  SupervisorInput in;
  in.estop = false;
  for (ChannelInput& channel : in.channels) {
    channel.all_there = channel.aligned = true;
    channel.holder = 1;
  }
  return in;
}

Supervisor engaged() {
  Supervisor supervisor;
  SupervisorInput in = calm();
  supervisor.step(in, kDt);
  in.channels[0].engage_by = in.channels[1].engage_by = 1;
  supervisor.step(in, kDt);
  return supervisor;
}

Supervisor in_state(SafetyState state) {
  SupervisorState memory;
  for (ChannelMemory& channel : memory.channels) {
    channel.state = state;
    channel.engaged_by = state == SafetyState::kEngaged ? 1 : kNobody;
  }
  Supervisor supervisor;
  supervisor.reset(memory);
  return supervisor;
}

TEST(Supervisor, RefusesConfigurations) {
  SupervisorConfig config;
  config.channels = 9;
  try {
    Supervisor{config};
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("channels"), std::string::npos) << error.what();
  }
  config = {};
  config.steps_missing_hold = 0;
  EXPECT_THROW(Supervisor{config}, ConfigError);
}

TEST(Supervisor, EngagesWhenAskedOnly) {
  Supervisor supervisor;
  SupervisorInput in = calm();
  for (int i = 0; i < 100; ++i) {
    const SupervisorOutput out = supervisor.step(in, kDt);
    EXPECT_EQ(out.channels[0].state, SafetyState::kReady);
    EXPECT_FALSE(out.channels[0].may_move || out.channels[1].may_move);
  }
  in.channels[1].engage_by = 1;
  const SupervisorOutput out = supervisor.step(in, kDt);
  EXPECT_FALSE(out.channels[0].may_move);
  EXPECT_TRUE(out.channels[1].may_move);
  EXPECT_EQ(out.channels[1].engagement, 1u);
  EXPECT_EQ(out.whole, CrtkState::kEnabled);
  EXPECT_EQ(supervisor.step(in, kDt).channels[1].engagement, 1u) << "asking again is no new engagement";
}

TEST(Supervisor, RefusesWithoutLeaseAlignmentOrAllThere) {
  for (int missing = 0; missing < 3; ++missing) {
    Supervisor supervisor;
    SupervisorInput in = calm();
    supervisor.step(in, kDt);
    in.channels[0].engage_by = missing == 0 ? 2 : 1;
    in.channels[0].aligned = missing != 1;
    in.channels[0].all_there = missing != 2;
    const SupervisorOutput out = supervisor.step(in, kDt);
    EXPECT_TRUE(out.channels[0].engage_refused) << missing;
    EXPECT_FALSE(out.channels[0].may_move) << missing;
  }
}

TEST(Supervisor, OneHiccupIsNoLossTwoAre) {
  Supervisor supervisor = engaged();
  SupervisorInput in = calm();
  in.channels[0].all_there = false;
  EXPECT_EQ(supervisor.step(in, kDt).channels[0].state, SafetyState::kEngaged);
  EXPECT_EQ(supervisor.step(calm(), kDt).channels[0].state, SafetyState::kEngaged);
  EXPECT_EQ(supervisor.step(in, kDt).channels[0].state, SafetyState::kEngaged);
  const SupervisorOutput out = supervisor.step(in, kDt);
  EXPECT_EQ(out.channels[0].state, SafetyState::kHold);
  EXPECT_TRUE(out.channels[1].may_move) << "the other channel goes on";
  EXPECT_EQ(supervisor.step(calm(), kDt).channels[0].state, SafetyState::kHold) << "latched";
}

TEST(Supervisor, EstopWinsInOneStepFromEveryStateWithEveryOtherFault) {
  for (std::size_t state = 0; state < kSafetyStates; ++state) {
    for (int bits = 0; bits < 1 << 7; ++bits) {
      for (const Seconds dt : {kDt, 0.0, kNan}) {
        Supervisor supervisor = in_state(static_cast<SafetyState>(state));
        SupervisorInput in;
        in.estop = true;
        in.estop_reset = (bits & 1) != 0;
        for (ChannelInput& channel : in.channels) {
          channel.all_there = (bits & 2) != 0;
          channel.aligned = (bits & 4) != 0;
          channel.fault = (bits & 8) != 0;
          channel.hold = (bits & 16) != 0;
          channel.disengage = (bits & 32) != 0;
          channel.holder = 1;
          channel.engage_by = (bits & 64) != 0 ? 1 : 200;
        }
        const SupervisorOutput out = supervisor.step(in, dt);
        EXPECT_TRUE(out.estop_latched);
        EXPECT_EQ(out.whole, CrtkState::kFault);
        for (int i = 0; i < 2; ++i) {
          EXPECT_EQ(out.channels[i].state, SafetyState::kEstop) << state << " " << bits << " " << dt;
          EXPECT_FALSE(out.channels[i].may_move);
        }
      }
    }
  }
}

TEST(Supervisor, ResetAloneNeverMoves) {
  Supervisor supervisor = engaged();
  SupervisorInput in = calm();
  in.estop = true;
  supervisor.step(in, kDt);
  in = calm();
  EXPECT_TRUE(supervisor.step(in, kDt).estop_latched) << "a released button is no reset";
  in.estop_reset = true;
  in.channels[0].engage_by = 1;  // an engage in the step of the reset does not count
  SupervisorOutput out = supervisor.step(in, kDt);
  EXPECT_FALSE(out.estop_latched);
  EXPECT_EQ(out.channels[0].state, SafetyState::kHold);
  EXPECT_TRUE(out.channels[0].engage_refused);
  for (int i = 0; i < 10; ++i) {
    out = supervisor.step(calm(), kDt);
    EXPECT_FALSE(out.channels[0].may_move || out.channels[1].may_move);
  }
  in = calm();
  in.channels[0].engage_by = 1;
  EXPECT_TRUE(supervisor.step(in, kDt).channels[0].may_move);
}

TEST(Supervisor, TheClutchStillsAndChangesNoState) {
  Supervisor supervisor = engaged();
  SupervisorInput in = calm();
  in.channels[0].clutch = true;
  SupervisorOutput out = supervisor.step(in, kDt);
  EXPECT_EQ(out.channels[0].state, SafetyState::kEngaged);
  EXPECT_FALSE(out.channels[0].may_move);
  EXPECT_TRUE(supervisor.step(calm(), kDt).channels[0].may_move);
}

TEST(Supervisor, AnEngagementBelongsToWhoAskedForIt) {
  for (const std::uint8_t holder : {std::uint8_t{0}, std::uint8_t{2}}) {
    Supervisor supervisor = engaged();
    SupervisorInput in = calm();
    in.channels[0].holder = holder;
    in.channels[0].engage_by = 2;  // even if the new one asks in the same step
    const SupervisorOutput out = supervisor.step(in, kDt);
    EXPECT_EQ(out.channels[0].state, SafetyState::kHold);
    EXPECT_TRUE(out.channels[1].may_move);
    EXPECT_EQ(supervisor.step(in, kDt).channels[0].may_move, holder == 2) << "asked again, aligned, with the lease";
  }
}

TEST(Supervisor, BadInputGrantsNothingAndKeepsTheState) {
  for (const bool bad_time : {true, false}) {
    Supervisor supervisor = engaged();
    SupervisorInput in = calm();
    in.channels[1].holder = bad_time ? 1 : 5;
    in.channels[0].hold = true;
    const SupervisorOutput out = supervisor.step(in, bad_time ? kNan : kDt);
    EXPECT_EQ(out.status, bad_time ? Status::kInvalidTimeStep : Status::kInvalidInput);
    EXPECT_FALSE(out.channels[0].may_move || out.channels[1].may_move);
    EXPECT_EQ(supervisor.state().channels[0].state, SafetyState::kEngaged);
    EXPECT_TRUE(supervisor.step(calm(), kDt).channels[0].may_move);
  }
}

TEST(Supervisor, NothingIsSafeByDefault) {
  Supervisor supervisor = engaged();
  EXPECT_TRUE(supervisor.step({}, kDt).estop_latched) << "an E-stop button that nobody read is pressed";
}

}  // namespace
}  // namespace saras
