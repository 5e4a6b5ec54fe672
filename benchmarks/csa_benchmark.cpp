// saras_csa_benchmark DRAWS FILE: quadratic programmes, the slave controller's tick, closest points on 10^6 triangles.
// Prints {"rows": [{name, unit, p50, p99}], "failed": n} and writes each programme with our answer to FILE as doubles,
// for the peers (csa_peers.py): n, m, then H, g, lower, upper, A, row_lower, row_upper, x.
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "saras/csa/slave_mlc.hpp"
#include "saras/csa/virtual_fixture.hpp"
#include "saras/kinematics/dvrk_psm.hpp"
#include "saras/sim/random.hpp"
#include "timing.hpp"

namespace {

using namespace saras;
using namespace saras::csa;
using saras::benchmarks::Clock;
using saras::benchmarks::keep;
using saras::benchmarks::nanoseconds;
using saras::benchmarks::percentile;

constexpr int kJoints = 7;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Generator {
  Random random{1};
  double uniform(double low, double high) { return low + (high - low) * random.uniform(); }
  Vector3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
};

/// What a slave controller with seven joints asks: a Jacobian, speed limits, rows of fixtures.
void draw(Generator& generator, QpSolver& solver, int rows) {
  const Eigen::MatrixXd jacobian = Eigen::MatrixXd::NullaryExpr(6, kJoints, [&] { return generator.random.normal(); });
  const Eigen::VectorXd twist = Eigen::VectorXd::NullaryExpr(6, [&] { return generator.random.normal(); });
  solver.hessian = jacobian.transpose() * jacobian;
  solver.hessian.diagonal().array() += 1e-3;
  solver.gradient = -jacobian.transpose() * twist;
  solver.lower.setConstant(-0.5);
  solver.upper.setConstant(0.5);
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < kJoints; ++k) {
      solver.rows(i, k) = generator.random.normal();
    }
    solver.row_lower[i] = -kInfinity;
    solver.row_upper[i] = generator.uniform(0.0, 1.0);
  }
}

template <typename Matrix>
void put(std::ofstream& file, const Matrix& matrix) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      const double number = matrix(row, column);
      file.write(reinterpret_cast<const char*>(&number), sizeof number);
    }
  }
}

void print(const char* name, const char* unit, std::vector<double>& samples, bool last = false) {
  std::printf("{\"name\": \"%s\", \"unit\": \"%s\", \"p50\": %.1f, \"p99\": %.1f}%s", name, unit,
              percentile(samples, 0.5), percentile(samples, 0.99), last ? "" : ",\n");
}

int time_programmes(int rows, int draws, std::ofstream& file) {
  Generator generator;
  QpSolver solver(kJoints, rows);
  std::vector<double> samples;
  int failed = 0;
  for (int i = 0; i < draws + 200; ++i) {
    draw(generator, solver, rows);
    const auto start = Clock::now();
    const QpResult result = solver.solve(rows);
    const double took = nanoseconds(Clock::now() - start);
    failed += result.status != QpStatus::kSolved;
    if (i < 200) {
      continue;
    }
    samples.push_back(took);
    put(file, Eigen::Vector2d(kJoints, rows));
    put(file, solver.hessian);
    put(file, solver.gradient);
    put(file, solver.lower);
    put(file, solver.upper);
    put(file, solver.rows);
    put(file, solver.row_lower);
    put(file, solver.row_upper);
    put(file, solver.solution());
  }
  print(("qp_" + std::to_string(rows)).c_str(), "ns", samples);
  return failed;
}

/// A rolling sheet of 2 * side * side triangles, 0.2 m wide.
std::shared_ptr<const TriangleMesh> sheet(int side) {
  TriangleMesh::Vertices vertices((side + 1) * (side + 1), 3);
  TriangleMesh::Triangles triangles(2 * side * side, 3);
  for (int i = 0; i <= side; ++i) {
    for (int k = 0; k <= side; ++k) {
      const double x = 0.2 * i / side - 0.1;
      const double y = 0.2 * k / side - 0.1;
      vertices.row(i * (side + 1) + k) << x, y, 0.004 * std::sin(80.0 * x) * std::cos(60.0 * y);
    }
  }
  for (int i = 0; i < side; ++i) {
    for (int k = 0; k < side; ++k) {
      const int corner = i * (side + 1) + k;
      triangles.row(2 * (i * side + k)) << corner, corner + side + 1, corner + side + 2;
      triangles.row(2 * (i * side + k) + 1) << corner, corner + side + 2, corner + 1;
    }
  }
  return std::make_shared<TriangleMesh>(vertices, triangles);
}

/// The tip is drawn over the sheet and pressed into it; the whole tick: fixtures, controller. Worst penetration [m].
double time_tick(const std::shared_ptr<const TriangleMesh>& mesh, int ticks) {
  const dvrk::Psm psm;
  Vector6 q = (Vector6() << 0.0, 0.0, 0.12, 0.0, 0.1, 0.0).finished();
  SlaveMlcConfig config;
  config.motion.lower = psm.config().lower;
  config.motion.upper = psm.config().upper;
  config.motion.speed = JointVector::Constant(6, 1.0);
  config.motion.lead = JointVector::Constant(6, 0.1);
  SlaveMlc slave(config);
  FixtureSet fixtures({{"surface", MeshFixture{mesh, false, 0.0, 0.002}, false}});
  const Pose base_T_sheet{Quaternion::Identity(), psm.forward(q).translation - Vector3(0.0, 0.0, 0.01)};
  std::vector<double> tick, query;
  double worst = 0.0;
  for (int i = 0; i < ticks; ++i) {
    const Pose pose = psm.forward(q);
    SlaveMlcInput input;
    input.q = q;
    input.pose = pose;
    input.desired = pose;
    const double angle = 2e-4 * i;
    input.desired.translation =
        base_T_sheet.translation + Vector3(0.02 * std::cos(angle), 0.02 * std::sin(2.0 * angle), -0.005);
    const auto start = Clock::now();
    const FixtureOutput found = fixtures.step({pose, psm.shaft(q), base_T_sheet}, 0.001);
    const auto between = Clock::now();
    input.jacobian = psm.jacobian(q);
    input.rows = &found.rows;
    const SlaveMlcOutput output = slave.step(input, 0.001);
    const auto end = Clock::now();
    keep(output.motion.q[0]);
    query.push_back(nanoseconds(between - start));
    tick.push_back(nanoseconds(end - between));
    q = output.motion.q;
    worst = std::max(worst, -found.distance_m[0]);
  }
  print("slave_tick", "ns", tick);
  print("mesh_fixture_1e6", "ns", query);
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: saras_csa_benchmark DRAWS FILE\n");
    return 2;
  }
  const int draws = std::atoi(argv[1]);
  std::ofstream file(argv[2], std::ios::binary);
  std::printf("{\"rows\": [");
  int failed = 0;
  for (const int rows : {6, 24, 100}) {
    failed += time_programmes(rows, draws, file);
  }
  const auto mesh = sheet(708);  // 1 002 528 triangles
  const double worst_m = time_tick(mesh, 20000);
  std::vector<double> far;
  Generator generator;
  for (int i = 0; i < draws; ++i) {
    const Vector3 point = generator.vector(0.1);
    const auto start = Clock::now();
    keep(mesh->closest(point).distance_m);
    far.push_back(nanoseconds(Clock::now() - start));
  }
  print("mesh_closest_1e6_random", "ns", far, true);
  std::printf("],\n\"failed\": %d, \"triangles\": %d, \"penetration_m\": %.3g}\n", failed, mesh->triangles(), worst_m);
  return file.good() ? 0 : 1;
}
