#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <numeric>

#include "saras/model/surface_mesh.hpp"

namespace saras {
namespace {

constexpr std::int32_t kLeafSize = 4;
/// Triangles are halved at each level, so 2^31 of them would need 31.
constexpr std::size_t kMaxDepth = 64;

/// Barycentric weights of the triangle's point nearest to the origin (Ericson, Real-Time Collision Detection, 5.1.5).
Vector3 nearest_to_origin(const Vector3& a, const Vector3& b, const Vector3& c) noexcept {
  const Vector3 ab = b - a;
  const Vector3 ac = c - a;
  const double d1 = -ab.dot(a);
  const double d2 = -ac.dot(a);
  if (d1 <= 0.0 && d2 <= 0.0) {
    return {1.0, 0.0, 0.0};
  }
  const double d3 = -ab.dot(b);
  const double d4 = -ac.dot(b);
  if (d3 >= 0.0 && d4 <= d3) {
    return {0.0, 1.0, 0.0};
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double v = d1 / (d1 - d3);
    return {1.0 - v, v, 0.0};
  }
  const double d5 = -ab.dot(c);
  const double d6 = -ac.dot(c);
  if (d6 >= 0.0 && d5 <= d6) {
    return {0.0, 0.0, 1.0};
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double w = d2 / (d2 - d6);
    return {1.0 - w, 0.0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0.0, 1.0 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

MeshTree::MeshTree(const SurfaceMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vector3> centres;
  centres.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    Vector3 sum = Vector3::Zero();
    for (const std::int32_t vertex : triangle) {
      sum += mesh.vertices[static_cast<std::size_t>(vertex)];
    }
    centres.push_back(sum / 3.0);
  }
  nodes_.reserve(mesh.triangles.size());
  if (!order_.empty()) {
    build(0, static_cast<std::int32_t>(order_.size()), centres);
  }
  refit();
}

std::int32_t MeshTree::build(std::int32_t begin, std::int32_t end, const std::vector<Vector3>& centres) {
  const auto place = static_cast<std::int32_t>(nodes_.size());
  nodes_.push_back({Vector3::Zero(), Vector3::Zero(), begin, end - begin});
  if (end - begin > kLeafSize) {
    const auto centre = [&](std::int32_t i) { return centres[static_cast<std::size_t>(i)]; };
    Vector3 low = centre(order_[static_cast<std::size_t>(begin)]);
    Vector3 high = low;
    for (std::int32_t i = begin; i < end; ++i) {
      low = low.cwiseMin(centre(order_[static_cast<std::size_t>(i)]));
      high = high.cwiseMax(centre(order_[static_cast<std::size_t>(i)]));
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const std::int32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::int32_t a, std::int32_t b) { return centre(a)[axis] < centre(b)[axis]; });
    build(begin, middle, centres);
    const std::int32_t second = build(middle, end, centres);
    nodes_[static_cast<std::size_t>(place)].first = second;
    nodes_[static_cast<std::size_t>(place)].count = 0;
  }
  return place;
}

void MeshTree::bound(Node& node) const {
  node.low.setConstant(std::numeric_limits<double>::infinity());
  node.high = -node.low;
  for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
    for (const std::int32_t vertex : mesh_.triangles[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])]) {
      node.low = node.low.cwiseMin(mesh_.vertices[static_cast<std::size_t>(vertex)]);
      node.high = node.high.cwiseMax(mesh_.vertices[static_cast<std::size_t>(vertex)]);
    }
  }
}

void MeshTree::refit() {
  for (std::size_t i = nodes_.size(); i-- > 0;) {  // children stand behind their parents
    Node& node = nodes_[i];
    if (node.count > 0) {
      bound(node);
    } else {
      const Node& first = nodes_[i + 1];
      const Node& second = nodes_[static_cast<std::size_t>(node.first)];
      node.low = first.low.cwiseMin(second.low);
      node.high = first.high.cwiseMax(second.high);
    }
  }
}

Vector3 MeshTree::normal(std::int32_t triangle) const {
  const auto& corners = mesh_.triangles[static_cast<std::size_t>(triangle)];
  const Vector3& a = mesh_.vertices[static_cast<std::size_t>(corners[0])];
  return (mesh_.vertices[static_cast<std::size_t>(corners[1])] - a)
      .cross(mesh_.vertices[static_cast<std::size_t>(corners[2])] - a)
      .normalized();
}

MeshMatch MeshTree::likely(const Vector3& point, const Eigen::Matrix3d& information, std::int32_t hint) const noexcept {
  MeshMatch best;
  if (nodes_.empty() || !point.allFinite() || !information.allFinite()) {
    return best;
  }
  // Where the metric is Euclidean: y -> whitening (y - x). Boxes are bounded by its least stretch.
  const Eigen::Matrix3d whitening = information.llt().matrixU();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spectrum;
  spectrum.computeDirect(information, Eigen::EigenvaluesOnly);
  const double least = std::max(0.0, spectrum.eigenvalues()[0] * (1.0 - 1e-9));
  const auto visit = [&](std::int32_t number) {
    std::array<Vector3, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t vertex = mesh_.triangles[static_cast<std::size_t>(number)][i];
      corner[i] = whitening * (mesh_.vertices[static_cast<std::size_t>(vertex)] - point);
    }
    const Vector3 weights = nearest_to_origin(corner[0], corner[1], corner[2]);
    const double squared = (weights[0] * corner[0] + weights[1] * corner[1] + weights[2] * corner[2]).squaredNorm();
    if (squared < best.squared) {
      best.squared = squared;
      best.barycentric = weights;
      best.triangle = number;
    }
  };
  const auto bound_of = [&](std::int32_t number) {
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    return least * (point - point.cwiseMax(node.low).cwiseMin(node.high)).squaredNorm();
  };
  if (hint >= 0 && static_cast<std::size_t>(hint) < mesh_.triangles.size()) {
    visit(hint);
  }
  struct Entry {
    std::int32_t node;
    double bound;
  };
  std::array<Entry, kMaxDepth> stack;
  std::size_t height = 0;
  stack[height++] = {0, bound_of(0)};
  while (height > 0) {
    const Entry entry = stack[--height];
    if (!(entry.bound < best.squared)) {
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.count > 0) {
      for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
        visit(order_[static_cast<std::size_t>(i)]);
      }
      continue;
    }
    Entry near{entry.node + 1, bound_of(entry.node + 1)};
    Entry far{node.first, bound_of(node.first)};
    if (far.bound < near.bound) {
      std::swap(near, far);
    }
    stack[height++] = far;
    stack[height++] = near;
  }
  const auto& triangle = mesh_.triangles[static_cast<std::size_t>(best.triangle)];
  for (std::size_t i = 0; i < 3; ++i) {
    best.point +=
        best.barycentric[static_cast<Eigen::Index>(i)] * mesh_.vertices[static_cast<std::size_t>(triangle[i])];
  }
  return best;
}

IndexedMesh::IndexedMesh(SurfaceMesh given)
    : mesh((given.validate(), std::move(given))), tree(mesh), normals(mesh.vertex_normals()) {}

}  // namespace saras
