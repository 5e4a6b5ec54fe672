#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "saras/model/deformation.hpp"
#include "saras/model/model_error.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr std::size_t kMaxCorners = 200'000;
using Index = std::array<std::int32_t, 3>;

}  // namespace

DeformationGrid::DeformationGrid(const SurfaceMesh& mesh, double spacing_m) {
  validate::positive("spacing_m", spacing_m);
  std::map<Index, std::int32_t> numbers;
  vertices_.reserve(mesh.vertices.size());
  for (const Vector3& vertex : mesh.vertices) {
    const Vector3 scaled = vertex / spacing_m;
    const Vector3 low = scaled.array().floor();
    const Vector3 share = scaled - low;
    Place place{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      Index index{};
      double weight = 1.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool upper = (corner >> axis & 1U) != 0;
        const auto k = static_cast<Eigen::Index>(axis);
        index[axis] = static_cast<std::int32_t>(low[k]) + (upper ? 1 : 0);
        weight *= upper ? share[k] : 1.0 - share[k];
      }
      const auto [entry, added] = numbers.try_emplace(index, static_cast<std::int32_t>(positions_.size()));
      if (added) {
        positions_.emplace_back(Vector3(index[0], index[1], index[2]) * spacing_m);
      }
      place.corners[corner] = entry->second;
      place.weights[corner] = weight;
    }
    vertices_.push_back(place);
    if (positions_.size() > kMaxCorners) {
      throw ModelError("spacing_m = " + std::to_string(spacing_m) + ": makes more than " + std::to_string(kMaxCorners) +
                       " corners");
    }
  }
  for (const auto& [index, number] : numbers) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Index next = index;
      ++next[axis];
      const auto other = numbers.find(next);
      if (other != numbers.end()) {
        neighbours_.push_back({number, other->second});
      }
    }
  }
  couple(mesh);
}

void DeformationGrid::couple(const SurfaceMesh& mesh) {
  coupled_.resize(positions_.size());
  // A point anywhere on a triangle couples all corners of its vertices' cubes. Most triangles lie in one cube or two.
  std::set<std::array<std::int32_t, 3>> seen;
  const auto cube = [&](std::int32_t vertex) { return vertices_[static_cast<std::size_t>(vertex)].corners[0]; };
  const auto corners_of = [&](std::int32_t vertex) { return vertices_[static_cast<std::size_t>(vertex)].corners; };
  for (const auto& triangle : mesh.triangles) {
    std::array<std::int32_t, 3> cubes{cube(triangle[0]), cube(triangle[1]), cube(triangle[2])};
    std::sort(cubes.begin(), cubes.end());
    if (!seen.insert(cubes).second) {
      continue;
    }
    std::vector<std::int32_t> all;
    for (const std::int32_t vertex : triangle) {
      const auto corners = corners_of(vertex);
      all.insert(all.end(), corners.begin(), corners.end());
    }
    for (const std::int32_t a : all) {
      for (const std::int32_t b : all) {
        if (b >= a) {
          coupled_[static_cast<std::size_t>(a)].push_back(b);
        }
      }
    }
  }
  for (const auto& [a, b] : neighbours_) {
    coupled_[static_cast<std::size_t>(std::min(a, b))].push_back(std::max(a, b));
  }
  for (std::size_t corner = 0; corner < coupled_.size(); ++corner) {
    auto& mine = coupled_[corner];
    mine.push_back(static_cast<std::int32_t>(corner));
    std::sort(mine.begin(), mine.end());
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
  }
}

std::vector<std::pair<std::int32_t, double>> DeformationGrid::weights(const std::array<std::int32_t, 3>& triangle,
                                                                      const Vector3& barycentric) const {
  std::map<std::int32_t, double> sums;
  for (std::size_t i = 0; i < 3; ++i) {
    const Place& place = vertices_[static_cast<std::size_t>(triangle[i])];
    for (std::size_t corner = 0; corner < 8; ++corner) {
      sums[place.corners[corner]] += barycentric[static_cast<Eigen::Index>(i)] * place.weights[corner];
    }
  }
  return {sums.begin(), sums.end()};
}

void DeformationGrid::apply(const SurfaceMesh& mesh, const std::vector<Vector3>& displacements,
                            std::vector<Vector3>& moved) const {
  moved.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    moved[i] = mesh.vertices[i];
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const auto number = static_cast<std::size_t>(vertices_[i].corners[corner]);
      moved[i] += vertices_[i].weights[corner] * displacements[number];
    }
  }
}

}  // namespace saras
