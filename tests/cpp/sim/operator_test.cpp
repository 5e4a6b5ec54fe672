#include "saras/sim/operator.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

TEST(SecondOrderStep, MatchesTheClosedForms) {
  // critically damped: x = (1 + w t) e^{-w t}
  const double w = 60.0;
  const double dt = 0.01;
  const SecondOrderStep critical = second_order_step(w * w, 2.0 * w, dt);
  EXPECT_NEAR(critical.a_xx, (1.0 + w * dt) * std::exp(-w * dt), 1e-12);
  EXPECT_NEAR(critical.a_xv, dt * std::exp(-w * dt), 1e-12);
  EXPECT_NEAR(critical.b_x * w * w, 1.0 - critical.a_xx, 1e-13);
  // undamped: x = cos w t
  EXPECT_NEAR(second_order_step(w * w, 0.0, 1.0).a_xx, std::cos(w), 1e-11);
  // a free mass: x = u t^2 / 2
  EXPECT_NEAR(second_order_step(0.0, 0.0, 0.3).b_x, 0.045, 1e-15);
  // negative damping: v = e^{c t}
  EXPECT_NEAR(second_order_step(0.0, -2.0, 0.5).a_vv, std::exp(1.0), 1e-13);
}

TEST(Operator, RestsWhereForceAndStiffnessBalance) {
  Operator hand(OperatorConfig::normal());
  OperatorInput input;
  input.force = Vector3(2.0, 0.0, -1.0);
  input.intended_position = Vector3(0.01, 0.02, 0.03);
  OperatorOutput output;
  for (int i = 0; i < 5000; ++i) {
    output = hand.step(input, 1e-3);
  }
  EXPECT_TRUE(output.position.isApprox(Vector3(0.02, 0.02, 0.025), 1e-9));
  EXPECT_EQ(output.status, Status::kOk);
}

TEST(Operator, IsExactForHeldInputsWhateverTheStep) {
  OperatorInput input;
  input.force = Vector3(1.0, -2.0, 0.5);
  Operator fine(OperatorConfig::weak());
  Operator coarse(OperatorConfig::weak());
  for (int i = 0; i < 1000; ++i) {
    fine.step(input, 1e-4);
  }
  coarse.step(input, 0.1);
  EXPECT_LT((fine.state().position - coarse.state().position).norm(), 1e-12);
  EXPECT_LT((fine.state().velocity - coarse.state().velocity).norm(), 1e-10);
}

TEST(Operator, AnActiveHandStaysWithinStopsAndSpeed) {
  Operator hand(OperatorConfig::active());
  OperatorInput input;
  input.force = Vector3(0.1, 0.0, 0.0);
  for (int i = 0; i < 20000; ++i) {
    const OperatorOutput output = hand.step(input, 1e-3);
    ASSERT_LE(output.position.norm(), hand.config().workspace_radius_m * (1.0 + 1e-12));
    ASSERT_LE(output.velocity.norm(), hand.config().speed_max_m_s * (1.0 + 1e-12));
  }
}

TEST(Operator, BadInputKeepsTheState) {
  Operator hand(OperatorConfig::normal());
  OperatorInput input;
  input.force = Vector3(1.0, 0.0, 0.0);
  hand.step(input, 1e-3);
  const Vector3 before = hand.state().position;
  input.force[1] = std::nan("");
  EXPECT_EQ(hand.step(input, 1e-3).status, Status::kInvalidInput);
  input.force[1] = 0.0;
  EXPECT_EQ(hand.step(input, 0.0).status, Status::kInvalidTimeStep);
  EXPECT_EQ(hand.state().position, before);
}

TEST(Operator, RefusesAMassOfZero) {
  OperatorConfig config;
  config.hand_mass_kg = 0.0;
  EXPECT_THROW(Operator{config}, ConfigError);
}

}  // namespace
}  // namespace saras
