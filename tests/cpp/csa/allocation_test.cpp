// Nothing of the room that runs each tick allocates, whatever the input.
#include <gtest/gtest.h>

#include "csa/fixture_rig.hpp"
#include "saras/csa/border_wrench.hpp"
#include "saras/csa/compliance.hpp"
#include "saras/csa/fixture_force.hpp"
#include "saras/csa/fixture_integrator.hpp"
#include "saras/csa/master_mlc.hpp"
#include "saras/csa/slave_mlc.hpp"
#include "saras/csa/teleop_states.hpp"
#include "saras/csa/virtual_fixture.hpp"
#include "saras/kinematics/dvrk_psm.hpp"
#include "support/no_allocation.hpp"
#include "support/random_values.hpp"

namespace saras::csa {
namespace {

const Vector6 kJoints = (Vector6() << 0.1, -0.1, 0.15, 0.2, 0.1, -0.1).finished();

ConstrainedMotionConfig motion_config() {
  const dvrk::PsmConfig psm;
  ConstrainedMotionConfig config;
  config.lower = psm.lower;
  config.upper = psm.upper;
  config.speed = JointVector::Constant(6, 1.0);
  config.lead = JointVector::Constant(6, 0.1);
  return config;
}

std::shared_ptr<const TriangleMesh> square() {
  TriangleMesh::Vertices vertices(4, 3);
  vertices << -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0;
  TriangleMesh::Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 2, 3;
  return std::make_shared<TriangleMesh>(vertices, triangles);
}

FixtureSet all_kinds() {
  HullFixture hull;
  hull.faces.resize(2, 4);
  hull.faces << 0, 0, 1, 0.5, 0, 0, -1, 0.5;
  HullFixture out = hull;
  out.keep_in = false;
  return FixtureSet({{"plane", PlaneFixture{}, false},
                     {"line", LineFixture{Vector3::Zero(), Vector3::UnitX(), 0.1}, true},
                     {"path", PathFixture{{Vector3::Zero(), Vector3::UnitX(), Vector3::UnitY()}, 0.01}, true},
                     {"trocar", RemoteCentreFixture{}, false},
                     {"in", hull, false},
                     {"out", out, true},
                     {"mesh", MeshFixture{square(), false, 0.0, 0.01}, true}});
}

TEST(CsaAllocation, ComplianceWrench) {
  ComplianceInput in;
  test::expect_no_allocation(ComplianceWrench({}), in, {&in.handle_pose.translation.x(), &in.handle_twist.linear.z()});
}
TEST(CsaAllocation, FixtureSet) {
  FixtureInput in;
  test::expect_no_allocation(all_kinds(), in, {&in.base_T_tip.translation.x(), &in.base_T_fixtures.translation.z()});
}
std::vector<TeleopFixture> teleop_fixtures() {
  return {test::teleop_fixture("plane", PlaneFixture{}),
          test::teleop_fixture("slope", test::plane(Vector3::Zero(), Vector3(1, 0, 1))),
          test::teleop_fixture("path", PathFixture{{Vector3::Zero(), Vector3::UnitX(), Vector3::UnitY()}, 0.01}),
          test::teleop_fixture("in", test::box(Pose{}, Vector3(1, 1, 1), true)),
          test::teleop_fixture("mesh", MeshFixture{square(), false, 0.0, 0.01}, true)};
}

TEST(CsaAllocation, FixtureForce) {
  FixtureForceInput in;
  test::expect_no_allocation(FixtureForce({}, teleop_fixtures()), in,
                             {&in.base_T_tip.translation.x(), &in.hand_ahead.z()});
}
TEST(CsaAllocation, FixtureIntegrator) {
  VelocityIntegratorConfig config;
  config.measured_jump_m = 100.0;
  FixtureIntegratorInput in;
  in.motion.rcm = Vector3(0, 0, 0.1);
  in.motion.twist.linear = Vector3(0.1, 0.1, -0.1);
  test::expect_no_allocation(FixtureIntegrator(config, teleop_fixtures()), in,
                             {&in.motion.measured_pose.translation.x(), &in.motion.twist.linear.z()});
}
TEST(CsaAllocation, BorderWrench) {
  FixtureSet fixtures({{"plane", PlaneFixture{}, false},
                       {"line", LineFixture{Vector3::Zero(), Vector3::UnitX(), 0.001}, false},
                       {"trocar", RemoteCentreFixture{}, false}});
  const FixtureOutput found =
      fixtures.step({{Quaternion::Identity(), Vector3(0.0, 0.01, -0.01)}, Vector3::UnitZ(), Pose{}}, 0.001);
  BorderWrenchInput in;
  in.rows = &found.rows;
  test::expect_no_allocation(BorderWrench({}), in, {&in.velocity.x(), &in.velocity.z()});
}
TEST(CsaAllocation, SlaveMlc) {
  const dvrk::Psm psm;
  FixtureSet fixtures = all_kinds();
  const FixtureOutput found = fixtures.step({psm.forward(kJoints), Vector3::UnitZ(), Pose{}}, 0.001);
  SlaveMlcConfig config;
  config.motion = motion_config();
  for (const SlaveMode mode : {SlaveMode::kPosition, SlaveMode::kHybrid, SlaveMode::kAdmittance}) {
    SlaveMlcInput in;
    in.q = in.q_measured = kJoints;
    in.jacobian = psm.jacobian(kJoints);
    in.pose = in.desired = psm.forward(kJoints);
    in.mode = mode;
    in.force_known = true;
    in.normal = Vector3::UnitZ();
    in.palpation = {PalpationKind::kForce, 0.5, 1.0};
    in.rows = &found.rows;
    test::expect_no_allocation(SlaveMlc(config), in,
                               {&in.desired.translation.x(), &in.tissue_wrench.force.z(), &in.desired_force_N});
  }
}
TEST(CsaAllocation, CsaTeleop) {
  CsaTeleopInput in;
  in.enabled = in.force_known = in.model_known = true;
  test::expect_no_allocation(CsaTeleop({}), in,
                             {&in.master_pose.translation.x(), &in.slave_force_N, &in.compliance_wrench.force.y(),
                              &in.fixture_wrench.force.x()});
}
TEST(CsaAllocation, MasterMlc) {
  const std::vector<Joint> joints = {
      {"a", "la", JointType::kRevolute, Pose{}, Vector3::UnitY(), -3.0, 3.0},
      {"b", "lb", JointType::kRevolute, Pose{Quaternion::Identity(), Vector3::UnitX()}, Vector3::UnitY(), -3.0, 3.0}};
  const auto gravity =
      std::make_shared<GravityModel>(joints, std::vector<LinkMass>{{1.0, Vector3::UnitX()}, {0.5, Vector3::UnitX()}});
  MasterMlcConfig config;
  config.torque_limit = JointVector::Constant(2, 5.0);
  MasterMlcInput in;
  in.q = JointVector::Constant(2, 0.3);
  in.jacobian = TipJacobian::Random(6, 2);
  test::expect_no_allocation(MasterMlc(config, gravity), in, {&in.wrench.force.x()});
}
TEST(CsaAllocation, QpSolver) {
  if (!test::can_count) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  test::RandomValues random(3);
  QpSolver solver(7, 40);
  for (int draw = 0; draw < 500; ++draw) {
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(7, 7, [&] { return random.uniform(-1.0, 1.0); });
    solver.hessian = root.transpose() * root;
    solver.hessian.diagonal().array() += 1e-3;
    const int count = draw % 41;
    for (int i = 0; i < 7; ++i) {
      solver.gradient[i] = random.uniform(-1.0, 1.0);
      solver.lower[i] = draw % 5 == 0 ? solver.upper[i] = 0.1 * i : -random.uniform(0.1, 1.0);
      solver.upper[i] = draw % 5 == 0 ? solver.upper[i] : random.uniform(0.1, 1.0);
    }
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < 7; ++k) {
        solver.rows(i, k) = draw % 7 == 0 ? 0.0 : random.uniform(-1.0, 1.0);
      }
      solver.row_upper[i] = random.uniform(draw % 3 == 0 ? -1.0 : 0.0, 1.0);
      solver.soft[i] = draw % 4 == 0 ? 1 : 0;
    }
    const test::MallocCounter counter;
    const QpResult result = solver.solve(count);
    const std::size_t allocations = counter.count();
    EXPECT_EQ(allocations, 0u) << "draw " << draw << ": " << to_string(result.status);
  }
}

}  // namespace
}  // namespace saras::csa
