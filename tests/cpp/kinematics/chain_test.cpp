#include "saras/kinematics/chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"

namespace saras {
namespace {

std::vector<Joint> joints() {
  const auto at = [](double x, double y, double z) { return Pose{Quaternion::Identity(), Vector3(x, y, z)}; };
  return {
      {"turn", "arm", JointType::kRevolute, at(0, 0, 0.1), Vector3::UnitZ(), -2.0, 2.0},
      {"bracket", "plate", JointType::kFixed, at(0.3, 0, 0), Vector3::UnitZ(), 0.0, 0.0},
      {"slide", "tip", JointType::kPrismatic, at(0, 0, 0), Vector3::UnitX(), 0.0, 0.5},
  };
}

TEST(Chain, ForwardAndJacobianOfAnArmThatIsSolvedByHand) {
  const Chain chain(joints());
  const Eigen::Vector2d q(M_PI / 2.0, 0.2);
  EXPECT_LT((chain.forward(q).translation - Vector3(0.0, 0.5, 0.1)).norm(), 1e-12);
  EXPECT_LT((chain.forward(q, "plate").translation - Vector3(0.0, 0.3, 0.1)).norm(), 1e-12);
  Eigen::Matrix<double, 6, 2> expected;
  expected.col(0) << -0.5, 0, 0, 0, 0, 1;
  expected.col(1) << 0, 1, 0, 0, 0, 0;
  EXPECT_LT((chain.jacobian(q) - expected).norm(), 1e-12);
  EXPECT_EQ(chain.joint_names(), (std::vector<std::string>{"turn", "slide"}));
}

TEST(Chain, CopiesStandAlone) {
  auto first = std::make_unique<Chain>(joints());
  const Chain copy = *first;
  first.reset();
  EXPECT_NEAR(copy.forward(Eigen::Vector2d(0.0, 0.0)).translation.x(), 0.3, 1e-12);
}

TEST(Chain, RefusalsNameTheJoint) {
  const Chain chain(joints());
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const KinematicsError& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  EXPECT_EQ(message([&] { chain.forward(Eigen::Vector3d::Zero()); }), "q has 3 values: the chain has 2 joints");
  EXPECT_EQ(message([&] { chain.jacobian(Eigen::Vector2d(0.0, NAN)); }), "slide = nan: must be finite");
  EXPECT_EQ(message([&] { chain.check_limits(Eigen::Vector2d(0.0, 0.7)); }), "slide = 0.7: must be in [0, 0.5]");
  EXPECT_EQ(message([&] { chain.forward(Eigen::Vector2d::Zero(), "hand"); }),
            "hand: the chain has no link of this name");
  auto bad = joints();
  bad[0].axis = Vector3(1, 1, 0);
  EXPECT_NE(message([&] { Chain{bad}; }).find("turn: axis has norm"), std::string::npos);
  bad = joints();
  bad[2].name = "turn";
  EXPECT_NE(message([&] { Chain{bad}; }).find("two joints have this name"), std::string::npos);
}

}  // namespace
}  // namespace saras
