#include "saras/sim/tissue.hpp"

#include <gtest/gtest.h>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"

namespace saras {
namespace {

TissueConfig homogeneous() {
  TissueConfig config;
  config.inclusion_stiffness_N_m = config.stiffness_N_m;
  return config;
}

TissueOutput at(Tissue& tissue, const Vector3& position, const Vector3& velocity = Vector3::Zero()) {
  return tissue.step({position, velocity, Vector3::Zero()}, 1e-3);
}

TEST(Tissue, PressesBackWithStiffnessTimesDepth) {
  Tissue tissue(homogeneous());
  const TissueOutput output = at(tissue, Vector3(0.0, 0.0, -0.004));
  EXPECT_TRUE(output.contact);
  EXPECT_NEAR(output.depth, 0.004, 1e-15);
  // exerted by the tool: into the tissue, against the outward normal
  EXPECT_TRUE(output.wrench.force.isApprox(Vector3(0.0, 0.0, -1.2), 1e-12));
  EXPECT_FALSE(at(tissue, Vector3(0.0, 0.0, 0.001)).contact);
  EXPECT_EQ(at(tissue, Vector3(0.0, 0.0, 0.001)).wrench.force, Vector3::Zero());
}

TEST(Tissue, HuntCrossleyDampsPressingAndNeverPulls) {
  Tissue tissue(homogeneous());
  const double pressing = -at(tissue, Vector3(0, 0, -0.004), Vector3(0, 0, -0.01)).wrench.force.z();
  EXPECT_NEAR(pressing, 300.0 * 0.004 + 5000.0 * 0.004 * 0.01, 1e-12);
  for (double speed = 0.0; speed < 1.0; speed += 0.01) {
    EXPECT_LE(at(tissue, Vector3(0, 0, -0.004), Vector3(0, 0, speed)).wrench.force.z(), 0.0);
  }
}

TEST(Tissue, ASphereHasItsOwnNormalAndDepth) {
  TissueConfig config = homogeneous();
  config.curvature_1_m = 10.0;
  Tissue tissue(config);
  const Vector3 centre(0.0, 0.0, -0.1);
  const Vector3 direction = Vector3(0.3, -0.2, 0.9).normalized();
  const TissueOutput output = at(tissue, centre + (0.1 - 0.003) * direction);
  EXPECT_NEAR(output.depth, 0.003, 1e-15);
  EXPECT_TRUE(output.normal.isApprox(direction, 1e-12));
  EXPECT_TRUE(output.wrench.force.isApprox(-0.9 * direction, 1e-10));
}

TEST(Tissue, ForceIsTheGradientOfItsEnergyOverTheInclusion) {
  TissueConfig config;
  config.friction = 0.0;
  config.curvature_1_m = 5.0;
  config.exponent = 1.3;
  config.base_T_surface = {rotation_exp(Vector3(0.4, -0.2, 0.7)), Vector3(0.1, 0.2, -0.3)};
  Tissue tissue(config);
  const Vector3 point = config.base_T_surface * Vector3(0.015, 0.004, -0.006);
  const Vector3 exerted = at(tissue, point).wrench.force;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 step = 1e-7 * Vector3::Unit(axis);
    const double slope = (at(tissue, point + step).stored_energy_J - at(tissue, point - step).stored_energy_J) / 2e-7;
    EXPECT_NEAR(exerted[axis], slope, 1e-5);
  }
}

TEST(Tissue, ClosedPathsNeverGainEnergy) {
  Tissue tissue{TissueConfig{}};
  Random random(3);
  for (int path = 0; path < 50; ++path) {
    const Vector3 a(0.03 * random.uniform(), 0.01 * random.normal(), 0.008 * random.uniform());
    const double wx = 1.0 + 5.0 * random.uniform();
    const double wy = 1.0 + 5.0 * random.uniform();
    double work_by_tool = 0.0;
    const double dt = 1e-4;
    TissueOutput output;
    for (int i = 0; i < 20000; ++i) {
      const double t = (i + 0.5) * dt;  // midpoint: the sum is second-order in dt
      const Vector3 position(0.02 + a.x() * std::sin(wx * t), a.y() * std::sin(wy * t),
                             -0.002 + a.z() * std::cos(9.0 * t));
      const Vector3 velocity(a.x() * wx * std::cos(wx * t), a.y() * wy * std::cos(wy * t),
                             -9.0 * a.z() * std::sin(9.0 * t));
      output = at(tissue, position, velocity);
      if (i == 0) {
        work_by_tool = output.stored_energy_J;  // what is stored before the path begins may come back
      }
      work_by_tool += output.wrench.force.dot(velocity) * dt;
      ASSERT_GE(work_by_tool, output.stored_energy_J - 1e-6);
    }
  }
}

TEST(Tissue, NoiseRepeatsWithItsSeed) {
  TissueConfig config;
  config.force_noise_N = 0.1;
  Tissue one(config);
  Tissue two(config);
  double sum = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3 first = at(one, Vector3::UnitZ()).measured_wrench.force;
    ASSERT_EQ(first, at(two, Vector3::UnitZ()).measured_wrench.force);
    sum += first.squaredNorm() / 3.0;
  }
  EXPECT_NEAR(std::sqrt(sum / 20000), 0.1, 0.003);
}

TEST(Tissue, BadInputGivesNoNormalAndAStatus) {
  Tissue tissue(homogeneous());
  const TissueOutput output = at(tissue, Vector3(0.0, std::nan(""), 0.0));
  EXPECT_EQ(output.status, Status::kInvalidInput);
  EXPECT_EQ(output.normal, Vector3::Zero());
  TissueConfig config;
  config.stiffness_N_m = -1.0;
  EXPECT_THROW(Tissue{config}, ConfigError);
}

}  // namespace
}  // namespace saras
