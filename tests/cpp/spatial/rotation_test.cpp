#include "saras/spatial/rotation.hpp"

#include <gtest/gtest.h>

#include <kdl/frames.hpp>
#include <random>

namespace saras {
namespace {

Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Pose pose;
  pose.rotation = Quaternion(normal(random), normal(random), normal(random), normal(random)).normalized();
  pose.translation = Vector3(normal(random), normal(random), normal(random));
  return pose;
}

KDL::Frame to_kdl(const Pose& pose) {
  return {KDL::Rotation::Quaternion(pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.rotation.w()),
          KDL::Vector(pose.translation.x(), pose.translation.y(), pose.translation.z())};
}

TEST(Rotation, ExpInvertsLogFromTinyToNearPi) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 5000; ++i) {
    const Vector3 axis = Vector3(normal(random), normal(random), normal(random)).normalized();
    const double angle = i % 3 == 0 ? std::pow(10.0, -12.0 + 11.0 * i / 5000.0) : (M_PI - 1e-9) * i / 5000.0;
    const Vector3 vector = axis * angle;
    EXPECT_LT((rotation_log(rotation_exp(vector)) - vector).norm(), 1e-12 + 1e-13 * angle);
  }
}

TEST(Rotation, LogTakesTheShortestArcForBothSignsOfAQuaternion) {
  const Quaternion q = rotation_exp(Vector3(0.1, -0.2, 0.3));
  const Quaternion minus_q(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_LT((rotation_log(q) - rotation_log(minus_q)).norm(), 1e-15);
}

TEST(Rotation, DisplacementAndAddDeltaAgreeWithKdl) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const Pose a = random_pose(random);
    const Pose b = random_pose(random);
    const Twist moved = displacement(a, b);
    const KDL::Twist expected = KDL::diff(to_kdl(a), to_kdl(b), 1.0);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(moved.linear[k], expected.vel[k], 1e-12);
      EXPECT_NEAR(moved.angular[k], expected.rot[k], 1e-7);  // KDL's own log is good to 1e-8 near pi
    }
    const Pose back = add_delta(a, moved, 1.0);
    EXPECT_LT(displacement(back, b).linear.norm() + displacement(back, b).angular.norm(), 1e-12);
  }
}

}  // namespace
}  // namespace saras
