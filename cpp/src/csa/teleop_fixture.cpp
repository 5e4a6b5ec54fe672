#include "saras/csa/teleop_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::csa {
namespace {

FixtureSet make_set(const std::vector<TeleopFixture>& fixtures, bool hard_only) {
  std::vector<Fixture> chosen;
  for (const TeleopFixture& each : fixtures) {
    each.validate();
    if (!hard_only || !each.fixture.soft) {
      chosen.push_back(each.fixture);
    }
  }
  return FixtureSet(std::move(chosen));
}

class Writer {
 public:
  void number(double value) { numbers.push_back(value); }
  template <typename Matrix>
  void matrix(const Matrix& values) {
    for (Eigen::Index row = 0; row < values.rows(); ++row) {
      for (Eigen::Index column = 0; column < values.cols(); ++column) {
        number(static_cast<double>(values(row, column)));
      }
    }
  }
  std::vector<double> numbers;
};

class Reader {
 public:
  explicit Reader(const std::vector<double>& numbers) : numbers_(numbers) {}
  double number() {
    if (next_ == numbers_.size()) {
      refuse();
    }
    return numbers_[next_++];
  }
  Vector3 vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }
  /// A count of rows of so many numbers each, which must be there.
  Eigen::Index count(std::size_t numbers_a_row) {
    const double value = number();
    const std::size_t most = (numbers_.size() - next_) / numbers_a_row;
    if (!(value >= 0.0 && value <= static_cast<double>(most)) || value != std::floor(value)) {
      refuse();
    }
    return static_cast<Eigen::Index>(value);
  }
  template <typename Matrix>
  Matrix matrix(Eigen::Index rows) {
    Matrix values(rows, static_cast<Eigen::Index>(Matrix::ColsAtCompileTime));
    for (Eigen::Index row = 0; row < rows; ++row) {
      for (Eigen::Index column = 0; column < values.cols(); ++column) {
        const double value = number();
        if (std::is_integral_v<typename Matrix::Scalar> && !(std::abs(value) < 2147483648.0)) {
          refuse();
        }
        values(row, column) = static_cast<typename Matrix::Scalar>(value);
      }
    }
    return values;
  }
  void finish() const {
    if (next_ != numbers_.size()) {
      refuse();
    }
  }

 private:
  [[noreturn]] void refuse() const {
    throw ConfigError("fixture: numbers: count = " + std::to_string(numbers_.size()) +
                      ": must be as many as its kind has");
  }
  const std::vector<double>& numbers_;
  std::size_t next_ = 0;
};

struct Append {
  Writer& to;
  void operator()(const PlaneFixture& plane) const {
    to.matrix(plane.point);
    to.matrix(plane.normal);
    to.number(plane.margin_m);
  }
  void operator()(const LineFixture& line) const {
    to.matrix(line.point);
    to.matrix(line.direction);
    to.number(line.radius_m);
  }
  void operator()(const PathFixture& path) const {
    to.number(path.radius_m);
    for (const Vector3& point : path.points) {
      to.matrix(point);
    }
  }
  void operator()(const RemoteCentreFixture& centre) const {
    to.matrix(centre.centre);
    to.number(centre.tolerance_m);
  }
  void operator()(const HullFixture& hull) const {
    to.number(hull.keep_in ? 1.0 : 0.0);
    to.number(hull.margin_m);
    to.number(hull.switch_m);
    to.number(static_cast<double>(hull.faces.rows()));
    to.matrix(hull.faces);
  }
  void operator()(const MeshFixture& fixture) const {
    to.number(fixture.keep_in ? 1.0 : 0.0);
    to.number(fixture.margin_m);
    to.number(fixture.reach_m);
    const bool given = fixture.mesh != nullptr;
    to.number(given ? static_cast<double>(fixture.mesh->vertices()) : 0.0);
    if (given) {
      to.matrix(fixture.mesh->given_vertices());
      to.matrix(fixture.mesh->given_triangles());
    }
  }
};

FixtureGeometry read_geometry(int kind, Reader& from, std::size_t size) {
  switch (kind) {
    case 0: {
      PlaneFixture plane;
      plane.point = from.vector();
      plane.normal = from.vector();
      plane.margin_m = from.number();
      return plane;
    }
    case 1: {
      LineFixture line;
      line.point = from.vector();
      line.direction = from.vector();
      line.radius_m = from.number();
      return line;
    }
    case 2: {
      PathFixture path;
      path.radius_m = from.number();
      for (std::size_t i = 0; i < (size - 1) / 3; ++i) {
        path.points.push_back(from.vector());
      }
      return path;
    }
    case 3: {
      RemoteCentreFixture centre;
      centre.centre = from.vector();
      centre.tolerance_m = from.number();
      return centre;
    }
    case 4: {
      HullFixture hull;
      hull.keep_in = from.number() != 0.0;
      hull.margin_m = from.number();
      hull.switch_m = from.number();
      hull.faces = from.matrix<decltype(hull.faces)>(from.count(4));
      return hull;
    }
    case 5: {
      MeshFixture fixture;
      fixture.keep_in = from.number() != 0.0;
      fixture.margin_m = from.number();
      fixture.reach_m = from.number();
      const Eigen::Index vertices = from.count(3);
      const auto points = from.matrix<TriangleMesh::Vertices>(vertices);
      const auto rest = static_cast<Eigen::Index>(size) - 4 - 3 * vertices;
      if (vertices > 0) {
        fixture.mesh = std::make_shared<TriangleMesh>(points, from.matrix<TriangleMesh::Triangles>(rest / 3));
      }
      return fixture;
    }
    default:
      throw ConfigError("fixture: kind = " + std::to_string(kind) + ": must be in [0, 5]");
  }
}

}  // namespace

void TeleopFixture::validate() const {
  fixture.validate();
  if (std::holds_alternative<RemoteCentreFixture>(fixture.geometry)) {
    throw ConfigError(fixture.name + ": remote_centre: must be another kind: the arm's remote centre is its trocar");
  }
  validate::in_range((fixture.name + ".stiffness_N_m").c_str(), stiffness_N_m, 0.0, 2000.0);
  validate::in_range((fixture.name + ".start_m").c_str(), start_m, 0.0, 0.1);
}

FixtureSet fixture_set(const std::vector<TeleopFixture>& fixtures) { return make_set(fixtures, false); }
FixtureSet hard_fixture_set(const std::vector<TeleopFixture>& fixtures) { return make_set(fixtures, true); }

std::vector<double> to_numbers(const FixtureGeometry& geometry) {
  Writer writer;
  std::visit(Append{writer}, geometry);
  return std::move(writer.numbers);
}

FixtureGeometry to_geometry(int kind, const std::vector<double>& numbers) {
  Reader reader(numbers);
  FixtureGeometry geometry = read_geometry(kind, reader, numbers.size());
  reader.finish();
  return geometry;
}

}  // namespace saras::csa
