#include "saras/model/vertex_map.hpp"

#include <gtest/gtest.h>

#include <set>

#include "saras/spatial/errors.hpp"
#include "support/touched_plane.hpp"

namespace saras {
namespace {

using test::plate_mesh;
using test::press_plate;
using test::RandomValues;

constexpr Seconds kDt = 1e-3;

struct Session {
  explicit Session(std::uint64_t seed) : random(seed) {}
  /// Some more samples; where they were.
  std::vector<Vector3> go_on(int samples) {
    std::vector<Vector3> at;
    for (int i = 0; i < samples; ++i, t_s += kDt) {
      const StiffnessGpInput input = press_plate(t_s, random);
      law.step(input, kDt);
      at.push_back(input.tip_position);
    }
    return at;
  }
  RandomValues random;
  double t_s = 0.0;
  StiffnessGp law;
};

VertexMap map_of(const SurfaceMesh& mesh, const StiffnessGp& law) {
  return {mesh.vertices, mesh.vertex_normals(), law.config().local.radius_m};
}

/// What each vertex would be told with everything asked anew.
std::vector<VertexEstimate> all_anew(const SurfaceMesh& mesh, const StiffnessGp& law) {
  VertexMap map = map_of(mesh, law);
  LocalModel workspace(law.config().local, law.config().grid);
  map.touch_all();
  map.refresh(law.state().grid, workspace, {}, 0.0, map.patches());
  return map.estimates();
}

bool same(const VertexEstimate& a, const VertexEstimate& b) {
  return (a.stiffness_N_m == b.stiffness_N_m || (std::isnan(a.stiffness_N_m) && std::isnan(b.stiffness_N_m))) &&
         a.stiffness_std_N_m == b.stiffness_std_N_m;
}

TEST(VertexMap, AskingOnlyWhatIsOutOfDateTellsTheSameAsAskingEverything) {
  const SurfaceMesh mesh = plate_mesh(41);
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    Session session(seed);
    LocalModel workspace(session.law.config().local, session.law.config().grid);
    VertexMap map = map_of(mesh, session.law);
    std::size_t asked = 0;
    for (int round = 0; round < 15; ++round) {
      for (const Vector3& at : session.go_on(200)) {
        map.touch(at, session.law.config().grid.cell_m);
      }
      asked += map.refresh(session.law.state().grid, workspace, {}, 0.0, map.patches()).vertices.size();
      ASSERT_EQ(map.stale(), 0);
      const auto expected = all_anew(mesh, session.law);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_TRUE(same(map.estimates()[i], expected[i])) << "seed " << seed << " round " << round << " vertex " << i;
      }
    }
    EXPECT_LT(asked, 15 * mesh.vertices.size() / 2);
  }
}

TEST(VertexMap, SharingALocalModelTellsWhatOneOfItsOwnDoesWithinItsDeviation) {
  const SurfaceMesh mesh = plate_mesh(41);
  Session session(7);
  session.go_on(15000);
  const auto shared = all_anew(mesh, session.law);
  LocalModel own(session.law.config().local, session.law.config().grid);
  const Vector3 up = Vector3::UnitZ();
  int known = 0;
  for (std::size_t i = 0; i < shared.size(); ++i) {
    const bool usable = own.build(session.law.state().grid, mesh.vertices[i], &up);
    const SurfaceEstimate alone = usable ? own.estimate(mesh.vertices[i]) : SurfaceEstimate{};
    if (alone.status == EstimateStatus::kOk && std::isfinite(shared[i].stiffness_N_m)) {
      ++known;
      EXPECT_NEAR(shared[i].stiffness_N_m, alone.stiffness_N_m, shared[i].stiffness_std_N_m + alone.stiffness_std_N_m)
          << i;
    }
  }
  EXPECT_GT(known, 500);
}

TEST(VertexMap, NearTheTipFirstThenTheLongestWaitingAndNobodyForEver) {
  const SurfaceMesh mesh = plate_mesh(61);
  Session session(3);
  session.go_on(4000);
  LocalModel workspace(session.law.config().local, session.law.config().grid);
  VertexMap map = map_of(mesh, session.law);
  map.touch_all();
  const Vector3 tip(0.01, -0.01, 0.0);
  const auto& first = map.refresh(session.law.state().grid, workspace, {tip}, 4e-3, 5);
  ASSERT_GT(first.near, 0u);
  for (std::size_t k = 0; k < first.vertices.size(); ++k) {
    const double away = (mesh.vertices[static_cast<std::size_t>(first.vertices[k])] - tip).norm();
    EXPECT_TRUE(k >= first.near || away < 4e-3 + 3e-3) << away;
  }
  std::set<std::int32_t> asked(first.vertices.begin(), first.vertices.end());
  const int turns = (map.stale() + 4) / 5;
  for (int turn = 0; turn < turns; ++turn) {
    map.touch(tip, 1e-3);  // what is touched all the time does not push the others back
    const auto& next = map.refresh(session.law.state().grid, workspace, {tip}, 4e-3, 5);
    EXPECT_LE(next.longest_wait, turns + 1);
    asked.insert(next.vertices.begin(), next.vertices.end());
  }
  EXPECT_EQ(asked.size(), mesh.vertices.size());
}

TEST(VertexMap, AMeshThatHasMovedIsAskedWhereItMoved) {
  SurfaceMesh mesh = plate_mesh(41);
  Session session(4);
  session.go_on(20000);
  LocalModel workspace(session.law.config().local, session.law.config().grid);
  VertexMap map = map_of(mesh, session.law);
  map.touch_all();
  map.refresh(session.law.state().grid, workspace, {}, 0.0, map.patches());
  map.move(mesh.vertices, mesh.vertex_normals());
  EXPECT_EQ(map.stale(), 0);
  mesh.vertices[20 * 41 + 20].z() += 5e-4;
  map.move(mesh.vertices, mesh.vertex_normals());
  EXPECT_EQ(map.stale(), 1);
  EXPECT_THROW(map.move({}, {}), ConfigError);
}

TEST(VertexMap, TheTwoSidesOfAThinWallShareNothing) {
  std::vector<Vector3> vertices;
  std::vector<Vector3> normals;
  for (const double side : {1.0, -1.0}) {
    for (int i = 0; i < 10; ++i) {
      vertices.emplace_back(1e-4 * i, 0.0, 1e-3 + side * 1e-4);  // one cell
      normals.emplace_back(0.0, 0.0, side);
    }
  }
  VertexMapConfig config;
  config.patch_m = 5e-3;
  EXPECT_EQ(VertexMap(vertices, normals, 8e-3, config).patches(), 2);
}

}  // namespace
}  // namespace saras
