#include "saras/kinematics/rcm_arm.hpp"

#include <gtest/gtest.h>

#include <random>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"

namespace saras {
namespace {

const Vector3 kRcm = Vector3(mesa::kNominalRcm.data());

class RcmArmTest : public ::testing::Test {
 protected:
  Vector6 random_joints(double margin = 0.0) {
    std::uniform_real_distribution<double> unit(margin, 1.0 - margin);
    Vector6 q;
    for (int i = 0; i < 6; ++i) {
      q[i] = arm_.config().lower[i] + unit(random_) * (arm_.config().upper[i] - arm_.config().lower[i]);
    }
    return q;
  }
  /// A tip in the cone of 50 degrees, 30 to 170 mm deep.
  Vector3 random_tip() {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const double tilt = 50.0 / 180.0 * M_PI * std::sqrt(unit(random_));
    const double azimuth = 2.0 * M_PI * unit(random_);
    const double depth = 0.03 + 0.14 * unit(random_);
    return kRcm +
           depth * Vector3(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), -std::cos(tilt));
  }
  Vector6 near(double elbow) const {
    Vector6 q = Vector6::Zero();
    q[1] = elbow;
    return q;
  }

  RcmArm arm_;
  std::mt19937 random_{7};
};

TEST_F(RcmArmTest, ForwardAndJacobianAgreeWithKdl) {
  const Chain chain = arm_.chain();
  for (int i = 0; i < 2000; ++i) {
    const Vector6 q = random_joints();
    const Twist error = displacement(arm_.forward(q), chain.forward(q));
    EXPECT_LT(error.linear.norm() + error.angular.norm(), 1e-12);
    EXPECT_LT((arm_.jacobian(q) - chain.jacobian(q)).norm(), 1e-12);
  }
}

TEST_F(RcmArmTest, InverseGivesTheJointsBack) {
  for (int i = 0; i < 5000; ++i) {
    const Vector6 q = random_joints();
    if (std::abs(q[1]) < 1e-3) {
      continue;  // stretched: the elbow's side is not in the pose
    }
    const RcmSolution solution = arm_.inverse(arm_.forward(q), q);
    ASSERT_TRUE(solution.ok()) << describe(solution.violation);
    EXPECT_LT((solution.q - q).norm(), 1e-8) << q.transpose();
  }
}

TEST_F(RcmArmTest, PivotReachesTheDocumentedWorkspaceWithTheShaftThroughTheTrocar) {
  for (int i = 0; i < 5000; ++i) {
    const Vector3 tip = random_tip();
    const double roll = -3.0 + 6.0 * i / 5000.0;
    for (const double elbow : {1.0, -1.0}) {
      const RcmSolution solution = arm_.inverse_pivot(tip, roll, kRcm, near(elbow));
      ASSERT_TRUE(solution.ok()) << describe(solution.violation) << " tip " << tip.transpose();
      EXPECT_LT((arm_.forward(solution.q).translation - tip).norm(), 1e-12);
      EXPECT_LT(arm_.rcm_deviation(solution.q, kRcm), 1e-12);
      EXPECT_GT(elbow * solution.q[1], 0.0);
      EXPECT_DOUBLE_EQ(solution.q[5], roll);
    }
    EXPECT_FALSE(arm_.reachable(tip, kRcm));
  }
}

TEST_F(RcmArmTest, PivotJacobianMovesTheTipAsAskedAndKeepsTheTrocar) {
  for (int i = 0; i < 1000; ++i) {
    const Vector6 q = arm_.inverse_pivot(random_tip(), 0.3, kRcm, near(i % 2 ? 1.0 : -1.0)).value();
    const auto jacobian = arm_.pivot_jacobian(q, kRcm);
    ASSERT_TRUE(jacobian);
    const Eigen::Vector4d rates = Eigen::Vector4d::Random();
    const Vector6 twist = arm_.jacobian(q) * (*jacobian * rates);
    EXPECT_LT((twist.head<3>() - rates.head<3>()).norm(), 1e-9);
    EXPECT_NEAR(twist.tail<3>().dot(arm_.forward(q).rotation * Vector3::UnitZ()), rates[3], 1e-9);
    const double step = 1e-6;  // the deviation is of second order in the step
    EXPECT_LT(arm_.rcm_deviation(q + step * (*jacobian * rates), kRcm), 1e-9);
  }
}

TEST_F(RcmArmTest, PivotPoseTurnsTheShaftThroughTheTrocarAndNothingElse) {
  for (int i = 0; i < 1000; ++i) {
    const Vector6 q = arm_.inverse_pivot(random_tip(), 0.5, kRcm, near(1.0)).value();
    Pose pose = arm_.forward(q);
    EXPECT_LT(displacement(pose, *arm_.pivot_pose(pose, kRcm)).angular.norm(), 1e-7);
    pose.rotation = (rotation_exp(0.2 * Vector3::Random()) * pose.rotation).normalized();
    const auto turned = arm_.pivot_pose(pose, kRcm);
    ASSERT_TRUE(turned);
    const Vector3 turn = displacement(pose, *turned).angular;
    EXPECT_LT(std::abs(turn.dot(pose.rotation * Vector3::UnitZ())), 1e-9);  // no roll in it
    const RcmSolution solution = arm_.inverse(*turned, q);
    ASSERT_TRUE(solution.ok());
    EXPECT_LT(arm_.rcm_deviation(solution.q, kRcm), 1e-9);
  }
}

TEST_F(RcmArmTest, ParallelModeKeepsTheUniversalJoint) {
  for (int i = 0; i < 2000; ++i) {
    const Vector6 q = random_joints(0.02);
    const RcmSolution solution = arm_.inverse_parallel(arm_.forward(q).translation, q[5], q);
    ASSERT_TRUE(solution.ok()) << describe(solution.violation);
    EXPECT_LT((solution.q - q).norm(), 1e-6) << q.transpose();
  }
}

TEST_F(RcmArmTest, RefusalsNameWhatStandsInTheWay) {
  const auto word = [this](const Vector3& tip) { return describe(arm_.reachable(tip, kRcm)); };
  EXPECT_NE(word(kRcm + Vector3(0, 0, -0.28)).find("insertion [m] = 0.25: must be in [0, 0.2]"), std::string::npos)
      << word(kRcm + Vector3(0, 0, -0.28));
  EXPECT_NE(word(kRcm + Vector3(0, 0, 0.05)).find("z of the shaft"), std::string::npos);
  EXPECT_NE(word(kRcm + Vector3(0, 0, -0.001)).find("depth"), std::string::npos);
  EXPECT_NE(word(kRcm + Vector3(-0.2, 0, -0.1)).find("shoulder [m] = 0.38: must be in [0, 0.32]"), std::string::npos);
  EXPECT_EQ(arm_.reachable(Vector3::Constant(NAN), kRcm).reason, Unreachable::kInvalidInput);
  EXPECT_THROW(arm_.inverse_pivot(kRcm + Vector3(0, 0, -0.28), 0.0, kRcm, near(1.0)).value(), KinematicsError);
  Vector6 q = Vector6::Zero();
  q[3] = 1.2;
  EXPECT_EQ(describe(arm_.check_limits(q)), "universal_2 [rad] = 1.2: must be in [-1, 1]");
}

TEST_F(RcmArmTest, ConfigRefusesWhatCannotBe) {
  RcmArmConfig config;
  config.scara_link_1_m = -0.1;
  EXPECT_THROW(RcmArm{config}, ConfigError);
  config = {};
  config.lower[4] = 0.5;
  EXPECT_THROW(RcmArm{config}, ConfigError);
}

}  // namespace
}  // namespace saras
