// Walls and guides for the tests of fixtures in teleoperation, around the origin.
#pragma once

#include <string>
#include <vector>

#include "saras/csa/teleop_fixture.hpp"
#include "support/random_values.hpp"

namespace saras::test {

inline csa::TeleopFixture teleop_fixture(const std::string& name, csa::FixtureGeometry geometry, bool soft = false) {
  csa::TeleopFixture made;
  made.fixture = {name, std::move(geometry), soft};
  return made;
}

inline csa::PlaneFixture plane(const Vector3& point, const Vector3& normal, double margin_m = 0.0) {
  return {point, normal.normalized(), margin_m};
}

/// Faces of a box of half the given sizes, turned.
inline csa::HullFixture box(const Pose& pose, const Vector3& half, bool keep_in) {
  csa::HullFixture hull;
  hull.faces.resize(6, 4);
  for (int i = 0; i < 6; ++i) {
    const Vector3 normal = pose.rotation * (i < 3 ? Vector3::Unit(i) : Vector3(-Vector3::Unit(i - 3)));
    hull.faces.row(i) << normal.transpose(), normal.dot(pose.translation) + half[i % 3];
  }
  hull.keep_in = keep_in;
  return hull;
}

/// A ball of triangles from an octahedron, each halved so often; outward.
inline std::shared_ptr<const csa::TriangleMesh> ball(double radius_m, int halvings) {
  std::vector<Vector3> points = {Vector3::UnitX(),  Vector3::UnitY(),  Vector3::UnitZ(),
                                 -Vector3::UnitX(), -Vector3::UnitY(), -Vector3::UnitZ()};
  std::vector<std::array<int, 3>> faces = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                                           {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  const auto middle = [&points](int a, int b) {
    points.push_back((points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]).normalized());
    return static_cast<int>(points.size()) - 1;
  };
  for (int i = 0; i < halvings; ++i) {
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const int ab = middle(a, b);
      const int bc = middle(b, c);
      const int ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = finer;
  }
  csa::TriangleMesh::Vertices vertices(static_cast<Eigen::Index>(points.size()), 3);
  csa::TriangleMesh::Triangles triangles(static_cast<Eigen::Index>(faces.size()), 3);
  for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
    vertices.row(i) = radius_m * points[static_cast<std::size_t>(i)].transpose();
  }
  for (Eigen::Index i = 0; i < triangles.rows(); ++i) {
    const auto& face = faces[static_cast<std::size_t>(i)];
    triangles.row(i) << face[0], face[1], face[2];
  }
  return std::make_shared<csa::TriangleMesh>(vertices, triangles);
}

/// Two to five planes that all allow the origin.
inline std::vector<csa::TeleopFixture> walls(RandomValues& random, double reach_m) {
  std::vector<csa::TeleopFixture> made;
  const int count = static_cast<int>(random.uniform(2.0, 6.0));
  for (int i = 0; i < count; ++i) {
    const Vector3 normal = random.rotation() * Vector3::UnitX();
    made.push_back(teleop_fixture("wall " + std::to_string(i), plane(-random.uniform(0.0, reach_m) * normal, normal)));
  }
  return made;
}

}  // namespace saras::test
