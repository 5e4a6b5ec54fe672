// Nothing that a control loop calls allocates: the simulator runs these at 1 kHz.
#include <gtest/gtest.h>

#include "saras/kinematics/dvrk_ecm.hpp"
#include "saras/kinematics/dvrk_psm.hpp"
#include "saras/kinematics/rcm_arm.hpp"
#include "saras/kinematics/simball_handle.hpp"
#include "support/malloc_counter.hpp"

namespace saras {
namespace {

TEST(KinematicsAllocation, NothingInTheLoopAllocates) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  const RcmArm arm;
  const Chain chain = arm.chain();
  const SimballHandle handle;
  const std::string link = "instrument";
  const Vector3 rcm(mesa::kNominalRcm.data());
  Vector6 near = Vector6::Zero();
  near[1] = 1.0;
  Eigen::VectorXd chain_q = Eigen::VectorXd::Zero(chain.size());
  double sum = 0.0;
  bool all_found = true;
  const test::MallocCounter counter;
  for (const double depth : {0.1, 0.005, 0.4, std::numeric_limits<double>::quiet_NaN()}) {  // good and refused
    const RcmSolution solution = arm.inverse_pivot(rcm - Vector3(0.0, 0.0, depth), 0.1, rcm, near);
    const Vector6 q = solution.ok() ? solution.q : near;
    const Pose pose = arm.forward(q);
    sum += arm.jacobian(q).sum() + arm.rcm_deviation(q, rcm) + arm.inverse(pose, q).q.sum();
    sum += arm.inverse_parallel(pose.translation, 0.0, q).q.sum();
    all_found = all_found && arm.pivot_pose(pose, rcm).has_value();
    all_found = all_found && (!solution.ok() || arm.pivot_jacobian(q, rcm).has_value());
    sum += arm.check_limits(q) ? 1.0 : 0.0;
    sum += arm.reachable(pose.translation, rcm) ? 1.0 : 0.0;
    chain_q = q;
    sum += chain.forward(chain_q).translation.sum() + chain.forward(chain_q, link).translation.sum();
    sum += chain.jacobian(chain_q).sum();
    const Pose hand = handle.forward(Vector4(0.1, 0.2, 0.3, 0.05));
    sum += handle.jacobian(Vector4::Zero()).sum() + handle.inverse(hand)->sum();
  }
  const std::size_t allocations = counter.count();
  EXPECT_EQ(allocations, 0u);
  EXPECT_TRUE(std::isfinite(sum));
  EXPECT_TRUE(all_found);
}

TEST(KinematicsAllocation, NothingInTheDaVinciAllocates) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  const dvrk::Psm psm;
  const dvrk::Ecm ecm;
  const Vector6 q = (Vector6() << 0.1, 0.2, 0.1, 0.5, 0.3, -0.2).finished();
  const Vector4 e(0.1, 0.2, 0.1, 0.3);
  const Pose unreachable = {Quaternion::Identity(), Vector3(1.0, 0.0, 0.0)};
  const test::MallocCounter counter;
  double sum = psm.jacobian(q).sum() + ecm.jacobian(e).sum();
  sum += psm.inverse(psm.forward(q), q).q.sum() + ecm.inverse(ecm.forward(e), e, 1e-6).q.sum();
  sum += psm.inverse(unreachable, q).q.sum() + psm.wrist_position(q).sum() + (psm.check_limits(q) ? 1.0 : 0.0);
  const std::size_t allocations = counter.count();
  EXPECT_EQ(allocations, 0u);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace saras
