#include "saras/model/surface_mesh.hpp"

#include <gtest/gtest.h>

#include "saras/model/model_error.hpp"
#include "saras/model/registration.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using test::RandomValues;

/// A closed box with its corners moved: sides 40, 60 and 80 mm.
SurfaceMesh box(RandomValues& random) {
  SurfaceMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vector3 corner(i & 1 ? 0.04 : 0.0, i & 2 ? 0.06 : 0.0, i & 4 ? 0.08 : 0.0);
    mesh.vertices.push_back(corner + random.vector(4e-3));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(SurfaceMesh, AValidClosedMeshHasOutwardNormals) {
  RandomValues random(1);
  const SurfaceMesh mesh = box(random);
  EXPECT_NO_THROW(mesh.validate());
  EXPECT_TRUE(mesh.closed());
  const auto normals = mesh.vertex_normals();
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR(normals[i].norm(), 1.0, 1e-12);
    EXPECT_GT(normals[i].dot(mesh.vertices[i] - Vector3(0.02, 0.03, 0.04)), 0.0);
  }
  SurfaceMesh torn = mesh;
  torn.triangles.pop_back();
  EXPECT_NO_THROW(torn.validate());
  EXPECT_FALSE(torn.closed());
  torn.triangles.push_back({1, 1, 2});
  EXPECT_THROW(torn.validate(), ModelError);
}

TEST(MeshTree, RefittedItAnswersAsOneBuiltAnewAndAHintChangesNothing) {
  RandomValues random(2);
  SurfaceMesh mesh = box(random);
  MeshTree tree(mesh);
  for (int round = 0; round < 20; ++round) {
    for (Vector3& vertex : mesh.vertices) {
      vertex += random.vector(3e-3);
    }
    tree.refit();
    const MeshTree anew(mesh);
    for (int i = 0; i < 50; ++i) {
      const Vector3 at = random.vector(0.1);
      Eigen::Matrix3d half = Eigen::Matrix3d::Identity();
      half.col(0) += 3.0 * random.vector(1.0);
      const Eigen::Matrix3d information = half * half.transpose();
      const MeshMatch ours = tree.likely(at, information, static_cast<int>(random.uniform(-2.0, 14.0)));
      const MeshMatch expected = anew.likely(at, information);
      EXPECT_NEAR(ours.squared, expected.squared, 1e-15);
      EXPECT_NEAR((ours.point - at).dot(information * (ours.point - at)), ours.squared, 1e-12);
    }
  }
}

TEST(Registration, WithoutNoiseItFindsTheBox) {
  RandomValues random(3);
  const SurfaceMesh mesh = box(random);
  const MeshTree tree(mesh);
  for (int round = 0; round < 10; ++round) {
    const Pose truth{random.rotation(), random.vector(0.2)};
    std::vector<SurfacePoint> points;
    for (int i = 0; i < 60; ++i) {
      points.push_back({});
      points.back().position = truth * tree.closest(random.vector(0.1) + Vector3(0.02, 0.03, 0.04)).point;
    }
    const Pose start{
        (truth.rotation * Quaternion(Eigen::AngleAxisd(0.1, random.vector(1.0).normalized()))).normalized(),
        truth.translation + random.vector(3e-3)};
    RegistrationOptions options;
    options.tolerance_m = 1e-10;
    options.max_iterations = 1000;
    const Registration found = register_rigid(mesh, tree, points, start, options);
    EXPECT_LT(found.rms_m, 1e-6);
    for (const Vector3& vertex : mesh.vertices) {
      EXPECT_LT((found.base_T_mesh * vertex - truth * vertex).norm(), 1e-5);
    }
  }
}

}  // namespace
}  // namespace saras
