#include "saras/csa/virtual_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::csa {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMeshRows = 6;
/// A tube is bounded by a regular octagon inside its circle.
constexpr int kTubeDirections = 4;
const double kOctagon = std::cos(M_PI / 8.0);

/// What one fixture says, in its own frame.
struct Finding {
  double distance_m = kInfinity;
  Vector3 closest = Vector3::Zero();
  Vector3 normal = Vector3::Zero();
};

/// The tip in the fixtures' frame, and where the rows go.
struct Query {
  Vector3 tip;
  Vector3 shaft;
  int fixture;
  bool soft;
  FixtureRows& rows;

  void row(const Vector3& direction, double lower_m, double upper_m, const Vector3& tip_to_point = Vector3::Zero()) {
    rows.add({point_axis(direction, tip_to_point), lower_m, upper_m, fixture, soft});
  }
};

/// Keeps offset, the part of a point's position perpendicular to an axis, within a radius.
Finding tube(Query& query, const Vector3& axis, const Vector3& offset, double radius_m, const Vector3& tip_to_point) {
  const Vector3 first = axis.unitOrthogonal();
  const Vector3 second = axis.cross(first);
  const int step = radius_m > 0.0 ? 1 : 2;  // on the line: two equations, not four that say the same
  for (int k = 0; k < kTubeDirections; k += step) {
    const double angle = M_PI / kTubeDirections * k;
    const Vector3 direction = std::cos(angle) * first + std::sin(angle) * second;
    const double at = direction.dot(offset);
    const double reach = radius_m * kOctagon;
    query.row(direction, -reach - at, reach - at, tip_to_point);
  }
  const double distance = offset.norm();
  return {radius_m - distance, Vector3::Zero(), distance > 0.0 ? Vector3(-offset / distance) : Vector3(first)};
}

Finding evaluate(const PlaneFixture& plane, Query& query, int&) {
  const double distance = plane.normal.dot(query.tip - plane.point) - plane.margin_m;
  query.row(plane.normal, -distance, kInfinity);
  return {distance, query.tip - distance * plane.normal, plane.normal};
}

Finding evaluate(const LineFixture& line, Query& query, int&) {
  const Vector3 from_point = query.tip - line.point;
  const Vector3 offset = from_point - line.direction.dot(from_point) * line.direction;
  Finding finding = tube(query, line.direction, offset, line.radius_m, Vector3::Zero());
  finding.closest = query.tip - offset;
  return finding;
}

Finding evaluate(const PathFixture& path, Query& query, int& feature) {
  double least = kInfinity;
  Vector3 closest = path.points.front();
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const Vector3 along = path.points[i + 1] - path.points[i];
    const double t = std::clamp(along.dot(query.tip - path.points[i]) / along.squaredNorm(), 0.0, 1.0);
    const Vector3 point = path.points[i] + t * along;
    if ((query.tip - point).squaredNorm() < least) {
      least = (query.tip - point).squaredNorm();
      closest = point;
      feature = static_cast<int>(i) + 1;
    }
  }
  const auto segment = static_cast<std::size_t>(feature - 1);
  const Vector3 along = (path.points[segment + 1] - path.points[segment]).normalized();
  const Vector3 offset = query.tip - closest;
  const double distance = offset.norm();
  Finding finding;
  if (std::abs(along.dot(offset)) > 1e-9) {
    // Nearest to a corner or an end: inside a ball there. The tube of one segment would let the tip run on past it.
    finding.normal = -offset / distance;
    query.row(finding.normal, distance - path.radius_m, kInfinity);
  } else {
    finding = tube(query, along, offset, path.radius_m, Vector3::Zero());
  }
  finding.distance_m = path.radius_m - distance;
  finding.closest = closest;
  return finding;
}

Finding evaluate(const RemoteCentreFixture& centre, Query& query, int&) {
  const Vector3 to_centre = centre.centre - query.tip;
  const Vector3 tip_to_point = query.shaft.dot(to_centre) * query.shaft;  // the shaft's point nearest to the centre
  const Vector3 offset = tip_to_point - to_centre;
  Finding finding = tube(query, query.shaft, offset, centre.tolerance_m, tip_to_point);
  finding.closest = centre.centre;
  return finding;
}

Finding evaluate(const HullFixture& hull, Query& query, int& feature) {
  int best = 0;
  double furthest = -kInfinity;
  for (Eigen::Index f = 0; f < hull.faces.rows(); ++f) {
    const Vector3 normal = hull.faces.row(f).head<3>();
    const double in_front = normal.dot(query.tip) - hull.faces(f, 3);
    if (hull.keep_in) {
      query.row(-normal, in_front + hull.margin_m, kInfinity);
    }
    if (in_front > furthest) {
      furthest = in_front;
      best = static_cast<int>(f);
    }
  }
  if (!hull.keep_in && feature > 0 && feature <= hull.faces.rows()) {
    const double kept = hull.faces.row(feature - 1).head<3>().dot(query.tip) - hull.faces(feature - 1, 3);
    if (furthest < kept + hull.switch_m) {
      best = feature - 1;
      furthest = kept;
    }
  }
  feature = best + 1;
  const Vector3 normal = hull.faces.row(best).head<3>();
  const Vector3 closest = query.tip - furthest * normal;
  if (hull.keep_in) {
    return {-furthest - hull.margin_m, closest, -normal};
  }
  query.row(normal, hull.margin_m - furthest, kInfinity);
  return {furthest - hull.margin_m, closest, normal};
}

Finding evaluate(const MeshFixture& fixture, Query& query, int& feature) {
  const double side = fixture.keep_in ? -1.0 : 1.0;
  const MeshPoint nearest = fixture.mesh->closest(query.tip, kInfinity, feature - 1);
  if (nearest.triangle < 0) {
    return {-kInfinity, query.tip, Vector3::Zero()};
  }
  feature = nearest.triangle + 1;
  std::array<MeshPoint, kMeshRows> others;
  // Far away no other face can be met in this tick, and too many would have to be looked at.
  const double away = std::abs(nearest.distance_m);
  int count = 0;
  if (away <= fixture.reach_m + std::abs(fixture.margin_m)) {
    count = fixture.mesh->nearby(query.tip, away + fixture.reach_m, others.data(), static_cast<int>(others.size()));
  }
  const double distance = side * nearest.distance_m - fixture.margin_m;
  query.row(side * nearest.normal, -distance, kInfinity);
  for (int i = 0; i < count; ++i) {
    const MeshPoint& other = others[static_cast<std::size_t>(i)];
    const double slack = side * other.distance_m - fixture.margin_m;
    // Behind a face that is not the nearest one: the sign of another part of the surface, not of this place.
    if (other.triangle != nearest.triangle && slack >= 0.0 && other.normal.dot(nearest.normal) < 0.98) {
      query.row(side * other.normal, -slack, kInfinity);
    }
  }
  return {distance, nearest.point, side * nearest.normal};
}

int rows_of(const FixtureGeometry& geometry) {
  if (const auto* hull = std::get_if<HullFixture>(&geometry)) {
    return hull->keep_in ? static_cast<int>(hull->faces.rows()) : 1;
  }
  if (std::holds_alternative<MeshFixture>(geometry)) {
    return kMeshRows + 1;
  }
  return std::holds_alternative<PlaneFixture>(geometry) ? 1 : kTubeDirections + 2;
}

// Not std::visit, which throws for a variant without a value: a tick does not throw.
template <class... Geometries>
Finding evaluate_any(const std::variant<Geometries...>& geometry, Query& query, int& feature) noexcept {
  Finding finding;
  const auto evaluate_if = [&](const auto* held) {
    if (held != nullptr) {
      finding = evaluate(*held, query, feature);
    }
  };
  (evaluate_if(std::get_if<Geometries>(&geometry)), ...);
  return finding;
}

struct Check {
  const std::string& fixture;
  std::string field(const char* name) const { return fixture + "." + name; }

  void operator()(const PlaneFixture& plane) const {
    validate::finite(field("point").c_str(), plane.point);
    validate::unit(field("normal").c_str(), plane.normal);
    validate::finite(field("margin_m").c_str(), plane.margin_m);
  }
  void operator()(const LineFixture& line) const {
    validate::finite(field("point").c_str(), line.point);
    validate::unit(field("direction").c_str(), line.direction);
    validate::not_negative(field("radius_m").c_str(), line.radius_m);
  }
  void operator()(const PathFixture& path) const {
    if (path.points.size() < 2) {
      throw ConfigError(field("points") + ": count = " + std::to_string(path.points.size()) + ": must be at least 2");
    }
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      const std::string name = field("points") + "[" + std::to_string(i) + "]";
      validate::finite(name.c_str(), path.points[i]);
      if (i > 0 && (path.points[i] - path.points[i - 1]).norm() < 1e-9) {
        throw ConfigError(name + ": must differ from the point before it");
      }
    }
    validate::positive(field("radius_m").c_str(), path.radius_m);
  }
  void operator()(const RemoteCentreFixture& centre) const {
    validate::finite(field("centre").c_str(), centre.centre);
    validate::not_negative(field("tolerance_m").c_str(), centre.tolerance_m);
  }
  void operator()(const HullFixture& hull) const {
    if (hull.faces.rows() < 1 || hull.faces.rows() > kMaxHullFaces) {
      throw ConfigError(field("faces") + ": count = " + std::to_string(hull.faces.rows()) + ": must be in [1, " +
                        std::to_string(kMaxHullFaces) + "]");
    }
    for (Eigen::Index i = 0; i < hull.faces.rows(); ++i) {
      const std::string name = field("faces") + "[" + std::to_string(i) + "]";
      validate::unit(name.c_str(), Vector3(hull.faces.row(i).head<3>()));
      validate::finite(name.c_str(), hull.faces(i, 3));
    }
    validate::finite(field("margin_m").c_str(), hull.margin_m);
    validate::not_negative(field("switch_m").c_str(), hull.switch_m);
  }
  void operator()(const MeshFixture& fixture_mesh) const {
    if (!fixture_mesh.mesh) {
      throw ConfigError(field("mesh") + ": must be given");
    }
    validate::finite(field("margin_m").c_str(), fixture_mesh.margin_m);
    validate::in_range(field("reach_m").c_str(), fixture_mesh.reach_m, 0.0, 0.1);
  }
};

}  // namespace

void Fixture::validate() const {
  if (name.empty()) {
    throw ConfigError("name: must not be empty");
  }
  std::visit(Check{name}, geometry);
}

FixtureSet::FixtureSet(std::vector<Fixture> fixtures) {
  if (fixtures.size() > static_cast<std::size_t>(kMaxFixtures)) {
    throw ConfigError("fixtures: count = " + std::to_string(fixtures.size()) + ": must be at most " +
                      std::to_string(kMaxFixtures));
  }
  std::set<std::string> names;
  int rows = 0;
  for (const Fixture& fixture : fixtures) {
    fixture.validate();
    if (!names.insert(fixture.name).second) {
      throw ConfigError("fixtures: the name " + fixture.name + " repeats");
    }
    rows += rows_of(fixture.geometry);
  }
  if (rows > kMaxFixtureRows) {
    throw ConfigError("fixtures: rows = " + std::to_string(rows) + ": must be at most " +
                      std::to_string(kMaxFixtureRows));
  }
  fixtures_ = std::make_shared<const std::vector<Fixture>>(std::move(fixtures));
}

FixtureOutput FixtureSet::step(const FixtureInput& input, Seconds dt) noexcept {
  FixtureOutput output;
  output.distance_m.fill(std::numeric_limits<double>::quiet_NaN());
  output.normals.fill(Vector3::Zero());
  if (!is_valid_time_step(dt, kInfinity)) {
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  const bool shaft_valid = input.shaft.allFinite() && std::abs(input.shaft.norm() - 1.0) <= 1e-6;
  if (!is_valid(input.base_T_tip) || !is_valid(input.base_T_fixtures) || !shaft_valid) {
    output.status = Status::kInvalidInput;
    return output;
  }
  const Quaternion base_R_fixtures = input.base_T_fixtures.rotation;
  const Vector3 tip = input.base_T_fixtures.inverse() * input.base_T_tip.translation;
  const Vector3 shaft = (base_R_fixtures.conjugate() * input.shaft).normalized();
  double least = kInfinity;
  for (std::size_t i = 0; i < fixtures_->size(); ++i) {
    const Fixture& fixture = (*fixtures_)[i];
    Query query{tip, shaft, static_cast<int>(i), fixture.soft, output.rows};
    int& feature = state_.feature[i];
    const Finding finding = evaluate_any(fixture.geometry, query, feature);
    output.distance_m[i] = finding.distance_m;
    output.normals[i] = base_R_fixtures * finding.normal;
    if (finding.distance_m < least) {
      least = finding.distance_m;
      output.nearest = static_cast<int>(i);
      output.closest = input.base_T_fixtures * finding.closest;
      output.normal = output.normals[i];
    }
  }
  for (int i = 0; i < output.rows.count; ++i) {
    Vector6& axis = output.rows.rows[static_cast<std::size_t>(i)].axis;
    axis.head<3>() = base_R_fixtures * axis.head<3>();
    axis.tail<3>() = base_R_fixtures * axis.tail<3>();
  }
  output.status = output.rows.overflow ? Status::kInvalidInput : least < 0.0 ? Status::kLimited : Status::kOk;
  return output;
}

}  // namespace saras::csa
