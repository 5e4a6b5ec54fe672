#include <gtest/gtest.h>

#include <cmath>

#include "saras/kinematics/dvrk_ecm.hpp"
#include "saras/kinematics/dvrk_psm.hpp"
#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"
#include "support/random_values.hpp"

namespace saras::dvrk {
namespace {

/// Modified DH, row by row: the table of the dVRK, not our closed form.
Pose row(double alpha, double a, double theta, double d) {
  const Pose twist = {Quaternion(Eigen::AngleAxisd(alpha, Vector3::UnitX())), Vector3(a, 0.0, 0.0)};
  const Quaternion turn(Eigen::AngleAxisd(theta, Vector3::UnitZ()));
  return twist * Pose{turn, Vector3(0.0, 0.0, d)};
}

Pose by_table(const PsmConfig& config, const Vector6& q) {
  Eigen::Matrix3d tip;
  tip << 0, -1, 0, 0, 0, 1, -1, 0, 0;
  return row(M_PI / 2, 0, q[0] + M_PI / 2, 0) * row(-M_PI / 2, 0, q[1] - M_PI / 2, 0) *
         row(M_PI / 2, 0, 0, q[2] - config.insertion_offset_m) * row(0, 0, q[3], config.tool_length_m) *
         row(-M_PI / 2, 0, q[4] - M_PI / 2, 0) * row(-M_PI / 2, config.wrist_offset_m, q[5] - M_PI / 2, 0) *
         Pose{Quaternion(tip), Vector3::Zero()};
}

template <typename Config>
auto random_joints(const Config& config, test::RandomValues& random) {
  auto q = config.lower;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = random.uniform(config.lower[i], config.upper[i]);
  }
  return q;
}

double gap(const Pose& a, const Pose& b) { return to_vector(displacement(a, b)).norm(); }

TEST(DvrkPsm, ForwardGivesTheCheckValues) {
  const Psm arm(psm_config(find_tool("400006"), Body::kClassic));
  const Vector6 first = (Vector6() << 0, 0, 0.1, 0, 0, 0).finished();
  const Vector6 second = (Vector6() << 0.3, -0.2, 0.15, 0.5, 0.4, -0.3).finished();
  EXPECT_LT((arm.forward(first).translation - Vector3(0, 0, -0.0935)).norm(), 1e-6);
  EXPECT_LT((arm.forward(second).translation - Vector3(0.039913, 0.025318, -0.134778)).norm(), 1e-6);
}

TEST(DvrkPsm, ForwardIsTheProductOfTheTableForEveryToolAndBody) {
  test::RandomValues random(1);
  for (const Tool& tool : tools()) {
    for (const Body body : {Body::kClassic, Body::kSi}) {
      if (body == Body::kSi && tool.length_m == kClassicLength) {
        EXPECT_THROW(psm_config(tool, body), ConfigError);
        continue;
      }
      const Psm arm(psm_config(tool, body));
      for (int i = 0; i < 100; ++i) {
        const Vector6 q = random_joints(arm.config(), random);
        EXPECT_LT(gap(arm.forward(q), by_table(arm.config(), q)), 1e-12);
      }
    }
  }
}

TEST(DvrkPsm, InverseOfForwardIsTheIdentity) {
  test::RandomValues random(2);
  for (const char* model : {"400006", "420194"}) {
    const Psm arm(psm_config(find_tool(model), Body::kClassic));
    for (int i = 0; i < 20000; ++i) {
      const Vector6 q = random_joints(arm.config(), random);
      const PsmSolution solution = arm.inverse(arm.forward(q), q);
      ASSERT_TRUE(solution.ok()) << describe(solution.refusal);
      ASSERT_LT((solution.q - q).norm(), 1e-7) << q.transpose();
    }
  }
}

TEST(DvrkPsm, InverseHoldsWhereADirectionIsFree) {
  test::RandomValues random(3);
  const Psm arm;
  const PsmConfig& config = arm.config();
  const double behind = config.tool_length_m - config.insertion_offset_m;
  for (int i = 0; i < 20000; ++i) {
    Vector6 q = random_joints(config, random);
    const double off = std::pow(10.0, random.uniform(-14.0, -3.0)) * (random.chance(0.5) ? 1.0 : -1.0);
    if (random.chance(0.5)) {  // wrist in the remote centre
      q[2] = off - behind;
    } else {  // tip on the wrist's yaw axis through the remote centre
      q[4] = random.uniform(-0.9, 0.9);
      q[2] = off - config.wrist_offset_m / std::cos(q[4]) - behind;
    }
    q = q.cwiseMax(config.lower).cwiseMin(config.upper);
    const PsmSolution solution = arm.inverse(arm.forward(q), q);
    ASSERT_TRUE(solution.ok()) << describe(solution.refusal) << " at " << q.transpose();
    ASSERT_LT(gap(arm.forward(solution.q), arm.forward(q)), 1e-8) << q.transpose();
    ASSERT_LT((solution.q - q).norm(), 1e-6) << q.transpose() << " off " << off;
  }
}

TEST(DvrkPsm, RollTakesTheTurnNearestToTheOldOne) {
  const Psm arm;
  Vector6 q = (Vector6() << 0.1, 0.2, 0.1, 3.5, 0.3, -0.2).finished();
  Vector6 near = q;
  EXPECT_LT((arm.inverse(arm.forward(q), near).value() - q).norm(), 1e-9);
  near[3] = -3.0;
  EXPECT_NEAR(arm.inverse(arm.forward(q), near).value()[3], 3.5 - 2.0 * M_PI, 1e-9);
  q[3] = 0.5;  // the turn nearest to -4.5 would be outside the limits
  near[3] = -4.5;
  EXPECT_NEAR(arm.inverse(arm.forward(q), near).value()[3], 0.5, 1e-9);
}

TEST(DvrkPsm, WhatCannotBeReachedIsNamed) {
  const Psm arm;
  const Vector6 near = (Vector6() << 0, 0, 0.1, 0, 0, 0).finished();
  Pose pose = arm.forward(near);
  pose.translation.z() = -0.5;
  try {
    arm.inverse(pose, near).value();
    FAIL();
  } catch (const KinematicsError& error) {
    EXPECT_STREQ(error.what(), "insertion [m] = 0.5065: must be in [0, 0.24]");
  }
  pose.translation.z() = test::kNan;
  EXPECT_THROW(arm.inverse(pose, near).value(), KinematicsError);
  EXPECT_THROW(find_tool("LARGE_NEEDLE_DRIVER"), ConfigError);
  EXPECT_EQ(find_tool("LARGE_NEEDLE_DRIVER:420006[12]").length_m, kSiLength);
  PsmConfig config;
  config.wrist_offset_m = -0.01;
  EXPECT_THROW(Psm{config}, ConfigError);
}

TEST(DvrkEcm, ForwardInverseAndWhatRemains) {
  test::RandomValues random(4);
  for (const Endoscope endoscope : {Endoscope::kStraight, Endoscope::kUp, Endoscope::kDown}) {
    for (const Body body : {Body::kClassic, Body::kSi}) {
      const Ecm arm(ecm_config(endoscope, body));
      for (int i = 0; i < 3000; ++i) {
        const Vector4 q = random_joints(arm.config(), random);
        const Pose pose = arm.forward(q);
        ASSERT_LT((arm.inverse(pose, q, 1e-6).value() - q).norm(), 1e-6);
        // A rotation that four joints do not reach: the best roll leaves the least.
        const double tilt = random.uniform(0.01, 0.5);
        const Pose tilted = {pose.rotation * Quaternion(Eigen::AngleAxisd(tilt, Vector3::UnitY())), pose.translation};
        const EcmSolution part = arm.inverse(tilted, q, M_PI);
        EXPECT_LE(part.rotation_error_rad, tilt + 1e-9);
        if (part.ok()) {
          EXPECT_LT((arm.forward(part.q).translation - pose.translation).norm(), 1e-12);
          EXPECT_EQ(arm.inverse(tilted, q, 1e-6).ok(), part.rotation_error_rad <= 1e-6);
        }
      }
    }
  }
}

TEST(DvrkEcm, TheEndoscopeLooksWhereItsNameSays) {
  const Vector4 q(0, 0, 0.1, 0);
  const auto view = [&q](Endoscope endoscope) {
    return Vector3(Ecm(ecm_config(endoscope, Body::kClassic)).forward(q).rotation * Vector3::UnitZ());
  };
  const Pose straight = Ecm().forward(q);
  EXPECT_LT((view(Endoscope::kStraight) + Vector3::UnitZ()).norm(), 1e-12);
  const Vector3 up = straight.rotation * Vector3::UnitY();
  EXPECT_NEAR(view(Endoscope::kUp).dot(up), 0.5, 1e-12);
  EXPECT_NEAR(view(Endoscope::kDown).dot(up), -0.5, 1e-12);
  EXPECT_NEAR(straight.translation.z(), -0.1007, 1e-12);
}

TEST(Dvrk, JacobiansAgreeWithCentralDifferences) {
  test::RandomValues random(5);
  const Psm psm;
  const Ecm ecm(ecm_config(Endoscope::kUp, Body::kSi));
  const double step = 1e-6;
  for (int i = 0; i < 500; ++i) {
    const Vector6 q = random_joints(psm.config(), random);
    const Vector4 e = random_joints(ecm.config(), random);
    for (int k = 0; k < 6; ++k) {
      const Vector6 h = step * Vector6::Unit(k);
      const Vector6 slope = to_vector(displacement(psm.forward(q - h), psm.forward(q + h))) / (2.0 * step);
      EXPECT_LT((slope - psm.jacobian(q).col(k)).norm(), 1e-8);
    }
    for (int k = 0; k < 4; ++k) {
      const Vector4 h = step * Vector4::Unit(k);
      const Vector6 slope = to_vector(displacement(ecm.forward(e - h), ecm.forward(e + h))) / (2.0 * step);
      EXPECT_LT((slope - ecm.jacobian(e).col(k)).norm(), 1e-8);
    }
  }
}

}  // namespace
}  // namespace saras::dvrk
