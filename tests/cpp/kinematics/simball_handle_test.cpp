#include "saras/kinematics/simball_handle.hpp"

#include <gtest/gtest.h>

#include <random>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"

namespace saras {
namespace {

Vector4 random_joints(const SimballHandle& handle, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Vector4 q;
  for (int i = 0; i < 4; ++i) {
    q[i] = handle.config().lower[i] + unit(random) * (handle.config().upper[i] - handle.config().lower[i]);
  }
  return q;
}

TEST(SimballHandle, InverseGivesTheJointsBackFromPoseAndFromPoint) {
  const SimballHandle handle;
  std::mt19937 random(3);
  for (int i = 0; i < 5000; ++i) {
    const Vector4 q = random_joints(handle, random);
    const Pose pose = handle.forward(q);
    EXPECT_LT((*handle.inverse(pose) - q).norm(), 1e-9);
    EXPECT_LT((*handle.inverse(pose.translation, q[2]) - q).norm(), 1e-9);
    // The shaft passes the pivot.
    EXPECT_LT(pose.translation.cross(pose.rotation * Vector3::UnitZ()).norm(), 1e-15);
  }
}

TEST(SimballHandle, JacobianAgreesWithCentralDifferences) {
  const SimballHandle handle;
  std::mt19937 random(4);
  const double step = 1e-6;
  for (int i = 0; i < 500; ++i) {
    const Vector4 q = random_joints(handle, random);
    const auto jacobian = handle.jacobian(q);
    for (int k = 0; k < 4; ++k) {
      const Vector4 h = step * Vector4::Unit(k);
      const Twist moved = displacement(handle.forward(q - h), handle.forward(q + h));
      EXPECT_LT((to_vector(moved) / (2.0 * step) - jacobian.col(k)).norm(), 1e-8);
    }
  }
}

TEST(SimballHandle, SignsAreAsDocumented) {
  const SimballHandle handle;
  EXPECT_NEAR(handle.forward(Vector4::Zero()).translation.z(), simball::kHandleDistance, 1e-15);
  EXPECT_LT(handle.forward(Vector4(0.3, 0, 0, 0)).translation.y(), 0.0);
  EXPECT_GT(handle.forward(Vector4(0, 0.3, 0, 0)).translation.x(), 0.0);
  EXPECT_NEAR(handle.forward(Vector4(0, 0, 0, 0.1)).translation.z(), simball::kHandleDistance - 0.1, 1e-15);
}

TEST(SimballHandle, RefusesWhatHasNoAnswer) {
  const SimballHandle handle;
  EXPECT_FALSE(handle.inverse(Vector3::Zero(), 0.0));
  EXPECT_FALSE(handle.inverse(Vector3(0.1, 0.0, -0.1), 0.0));
  EXPECT_FALSE(handle.inverse(Vector3(NAN, 0.0, 0.1), 0.0));
  EXPECT_THROW(handle.check_limits(Vector4(0, 0, 0, 0.2)), KinematicsError);
  EXPECT_THROW(handle.check_limits(Vector4(NAN, 0, 0, 0)), KinematicsError);
  SimballHandleConfig config;
  config.handle_distance_m = 0.1;
  EXPECT_THROW(SimballHandle{config}, ConfigError);
}

}  // namespace
}  // namespace saras
