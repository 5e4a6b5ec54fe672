// A plate z = 0 of one stiffness that is pressed to and fro while the tip wanders, and a mesh of it.
#pragma once

#include <cmath>

#include "saras/model/stiffness_gp.hpp"
#include "saras/model/surface_mesh.hpp"
#include "support/random_values.hpp"

namespace saras::test {

constexpr double kPlateStiffness_N_m = 400.0;

/// At 10 mm/s over 30 x 30 mm.
inline StiffnessGpInput press_plate(double t_s, RandomValues& random) {
  StiffnessGpInput input;
  const double depth = 2e-3 + 1e-3 * std::sin(6.0 * t_s);
  input.tip_position = {0.015 * std::sin(0.7 * t_s), 0.015 * std::sin(0.31 * t_s), -depth};
  input.force = Vector3(0.0, 0.0, -kPlateStiffness_N_m * depth) + random.vector(0.02);
  return input;
}

/// count x count vertices over 40 x 40 mm, a sheet facing +z.
inline SurfaceMesh plate_mesh(int count) {
  SurfaceMesh mesh;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      mesh.vertices.emplace_back(0.04 * i / (count - 1) - 0.02, 0.04 * j / (count - 1) - 0.02, 0.0);
    }
  }
  for (int i = 0; i + 1 < count; ++i) {
    for (int j = 0; j + 1 < count; ++j) {
      const int a = i * count + j;
      mesh.triangles.push_back({a, a + count, a + count + 1});
      mesh.triangles.push_back({a, a + count + 1, a + 1});
    }
  }
  return mesh;
}

}  // namespace saras::test
