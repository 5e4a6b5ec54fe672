// Virtual fixtures: where the tip may go, as rows on its motion. Plane, line, path, remote centre, convex hull, mesh.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "saras/csa/fixture_rows.hpp"
#include "saras/csa/triangle_mesh.hpp"
#include "saras/spatial/law.hpp"

namespace saras::csa {

/// The tip stays at least margin_m on the side of the normal.
struct PlaneFixture {
  Vector3 point = Vector3::Zero();    ///< on the plane [m]
  Vector3 normal = Vector3::UnitZ();  ///< unit, towards the side that is kept
  double margin_m = 0.0;
};
/// The tip stays within radius_m of a line (0: on it).
struct LineFixture {
  Vector3 point = Vector3::Zero();
  Vector3 direction = Vector3::UnitZ();  ///< unit
  double radius_m = 0.0;
};
/// The tip stays within radius_m of a polyline: guidance along a path. It may move along it freely.
struct PathFixture {
  std::vector<Vector3> points;  ///< at least two, no two in a row equal [m]
  double radius_m = 0.001;
};
/// The shaft passes a point within tolerance_m (0: exactly). The tool is rigid from there to the tip.
struct RemoteCentreFixture {
  Vector3 centre = Vector3::Zero();
  double tolerance_m = 0.0;
};
/// Faces (n, 4): outward unit normal and offset, inside is normal . x <= offset (scipy's ConvexHull.equations with the
/// last column negated). Kept in: one row a face. Kept out: one row, of the face that is furthest in front of the tip.
struct HullFixture {
  Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor> faces;
  bool keep_in = true;
  double margin_m = 0.0;
  double switch_m = 0.0005;  ///< kept out: another face takes over when it is further by this
};
/// The tip stays at least margin_m outside (keep_in: inside) of the mesh.
struct MeshFixture {
  std::shared_ptr<const TriangleMesh> mesh;
  bool keep_in = false;
  double margin_m = 0.0;
  double reach_m = 0.005;  ///< triangles further than the closest one by this give no row; none but
                           ///< the closest one does when it is further than this from its border
};

using FixtureGeometry =
    std::variant<PlaneFixture, LineFixture, PathFixture, RemoteCentreFixture, HullFixture, MeshFixture>;

struct Fixture {
  std::string name;
  FixtureGeometry geometry;
  bool soft = false;      ///< may be violated at a cost, where hard ones would leave no motion
  void validate() const;  ///< throws ConfigError naming the fixture, field, value, bound
};

inline constexpr int kMaxHullFaces = 64;

struct FixtureInput {
  Pose base_T_tip;
  Vector3 shaft = Vector3::UnitZ();  ///< unit, from the trocar to the tip, base axes; read by remote centres
  Pose base_T_fixtures;              ///< where the fixtures are, e.g. those registered to the anatomy
};

struct FixtureOutput {
  FixtureRows rows;
  std::array<double, kMaxFixtures> distance_m;  ///< of each fixture to its border; negative: violated by that much
  std::array<Vector3, kMaxFixtures> normals;    ///< of each: unit, towards what is allowed, base axes
  int nearest = -1;                             ///< fixture with the least distance
  Vector3 closest = Vector3::Zero();            ///< its closest point, base frame
  Vector3 normal = Vector3::Zero();             ///< its direction towards what is allowed, base axes
  Status status = Status::kOk;
};

struct FixtureState {
  std::array<int, kMaxFixtures> feature{};  ///< face of a hull, triangle of a mesh, segment of a path; plus 1
};

/// All fixtures of one tool.
class FixtureSet {
 public:
  /// Throws ConfigError; also for more than kMaxFixtures, names that repeat, more rows than fit.
  explicit FixtureSet(std::vector<Fixture> fixtures);
  FixtureOutput step(const FixtureInput& input, Seconds dt) noexcept;
  void reset(const FixtureState& state = {}) { state_ = state; }
  const FixtureState& state() const { return state_; }
  const std::vector<Fixture>& fixtures() const { return *fixtures_; }

 private:
  std::shared_ptr<const std::vector<Fixture>> fixtures_;
  FixtureState state_;
};

static_assert(has_law_shape<FixtureSet, FixtureInput, FixtureState>());

}  // namespace saras::csa
