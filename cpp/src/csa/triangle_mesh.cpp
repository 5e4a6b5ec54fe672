#include "saras/csa/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <unordered_map>

#include "saras/spatial/errors.hpp"

namespace saras::csa {
namespace {

constexpr std::int32_t kLeafSize = 4;
constexpr std::size_t kMaxDepth = 64;  // halved at each level
constexpr double kSameNormal = 0.98;   // cosine

/// Rounding outward: a box in single precision must hold what it bounds.
float below(double value) { return std::nextafter(static_cast<float>(value), -std::numeric_limits<float>::infinity()); }
float above(double value) { return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity()); }

double squared_distance_to_box(const Vector3& point, const Eigen::Vector3f& low, const Eigen::Vector3f& high) noexcept {
  const Vector3 outside = (low.cast<double>() - point).cwiseMax(point - high.cast<double>()).cwiseMax(0.0);
  return outside.squaredNorm();
}

}  // namespace

TriangleMesh::TriangleMesh(const Vertices& vertices, const Triangles& triangles) : vertices_(vertices) {
  for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
    if (!vertices.row(i).allFinite()) {
      throw ConfigError("vertices[" + std::to_string(i) + "]: must be finite");
    }
  }
  const Eigen::Index count = triangles.rows();
  if (count < 1 || count > std::numeric_limits<std::int32_t>::max() / 4) {
    throw ConfigError("triangles: count = " + std::to_string(count) + ": must be in [1, 536870911]");
  }
  std::vector<Vector3> centres(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (triangles(i, k) < 0 || triangles(i, k) >= vertices.rows()) {
        throw ConfigError("triangles[" + std::to_string(i) + "] = " + std::to_string(triangles(i, k)) +
                          ": must be in [0, " + std::to_string(vertices.rows() - 1) + "]");
      }
    }
    const Vector3 a = vertices.row(triangles(i, 0));
    const Vector3 b = vertices.row(triangles(i, 1));
    const Vector3 c = vertices.row(triangles(i, 2));
    const double size = std::max((b - a).squaredNorm(), (c - a).squaredNorm());
    if (!((b - a).cross(c - a).norm() > 1e-12 * size) || size == 0.0) {
      throw ConfigError("triangles[" + std::to_string(i) + "]: must have an area");
    }
    centres[static_cast<std::size_t>(i)] = (a + b + c) / 3.0;
  }
  std::vector<std::int32_t> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  faces_.resize(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    faces_[static_cast<std::size_t>(i)] = {{triangles(i, 0), triangles(i, 1), triangles(i, 2)},
                                           static_cast<std::int32_t>(i)};
  }
  nodes_.reserve(static_cast<std::size_t>(count));
  build(centres, order, 0, static_cast<std::int32_t>(count));
  std::vector<Face> sorted;
  sorted.reserve(faces_.size());
  place_.resize(faces_.size());
  for (const std::int32_t index : order) {
    place_[static_cast<std::size_t>(index)] = static_cast<std::int32_t>(sorted.size());
    sorted.push_back(faces_[static_cast<std::size_t>(index)]);
  }
  faces_ = std::move(sorted);
  make_normals();
}

std::int32_t TriangleMesh::build(std::vector<Vector3>& centres, std::vector<std::int32_t>& order, std::int32_t begin,
                                 std::int32_t end) {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;
  Vector3 centre_low = low;
  Vector3 centre_high = high;
  for (std::int32_t i = begin; i < end; ++i) {
    const auto index = static_cast<std::size_t>(order[static_cast<std::size_t>(i)]);
    for (const std::int32_t vertex : faces_[index].vertex) {
      low = low.cwiseMin(vertices_.row(vertex).transpose());
      high = high.cwiseMax(vertices_.row(vertex).transpose());
    }
    centre_low = centre_low.cwiseMin(centres[index]);
    centre_high = centre_high.cwiseMax(centres[index]);
  }
  const auto place = static_cast<std::int32_t>(nodes_.size());
  nodes_.push_back({low.unaryExpr(&below), high.unaryExpr(&above), begin, end - begin});
  if (end - begin > kLeafSize) {
    int axis = 0;
    (centre_high - centre_low).maxCoeff(&axis);
    const std::int32_t middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](std::int32_t a, std::int32_t b) {
                       return centres[static_cast<std::size_t>(a)][axis] < centres[static_cast<std::size_t>(b)][axis];
                     });
    build(centres, order, begin, middle);
    const std::int32_t second = build(centres, order, middle, end);
    nodes_[static_cast<std::size_t>(place)].first = second;
    nodes_[static_cast<std::size_t>(place)].count = 0;
  }
  return place;
}

void TriangleMesh::make_normals() {
  std::vector<Vector3> at_vertex(static_cast<std::size_t>(vertices_.rows()), Vector3::Zero());
  std::unordered_map<std::uint64_t, Vector3> at_edge;
  at_edge.reserve(2 * faces_.size());
  const auto key = [](std::int32_t a, std::int32_t b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
  };
  for (const Face& face : faces_) {
    const std::array<Vector3, 3> corner = {vertices_.row(face.vertex[0]), vertices_.row(face.vertex[1]),
                                           vertices_.row(face.vertex[2])};
    const Vector3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 to_next = (corner[(k + 1) % 3] - corner[k]).normalized();
      const Vector3 to_last = (corner[(k + 2) % 3] - corner[k]).normalized();
      const double angle = std::acos(std::clamp(to_next.dot(to_last), -1.0, 1.0));
      at_vertex[static_cast<std::size_t>(face.vertex[k])] += angle * normal;
      at_edge.try_emplace(key(face.vertex[k], face.vertex[(k + 1) % 3]), Vector3::Zero()).first->second += normal;
    }
  }
  vertex_normals_.reserve(at_vertex.size());
  for (const Vector3& normal : at_vertex) {
    vertex_normals_.push_back(normal.normalized().cast<float>());
  }
  edge_normals_.reserve(faces_.size());
  for (const Face& face : faces_) {
    std::array<Eigen::Vector3f, 3> normals;
    for (std::size_t k = 0; k < 3; ++k) {
      normals.at(k) = at_edge.at(key(face.vertex.at(k), face.vertex.at((k + 1) % 3))).normalized().cast<float>();
    }
    edge_normals_.push_back(normals);
  }
}

/// After Ericson, "Real-Time Collision Detection", 5.1.5.
TriangleMesh::Candidate TriangleMesh::closest_on(std::int32_t place, const Vector3& p) const noexcept {
  const Face& face = faces_[static_cast<std::size_t>(place)];
  const Vector3 a = vertices_.row(face.vertex[0]);
  const Vector3 b = vertices_.row(face.vertex[1]);
  const Vector3 c = vertices_.row(face.vertex[2]);
  const auto made = [&p](const Vector3& point, Feature feature) {
    return Candidate{point, (p - point).squaredNorm(), feature};
  };
  const Vector3 ab = b - a;
  const Vector3 ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) {
    return made(a, Feature::kVertex0);
  }
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) {
    return made(b, Feature::kVertex1);
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    return made(a + d1 / (d1 - d3) * ab, Feature::kEdge01);
  }
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) {
    return made(c, Feature::kVertex2);
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    return made(a + d2 / (d2 - d6) * ac, Feature::kEdge20);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return made(b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), Feature::kEdge12);
  }
  const double scale = 1.0 / (va + vb + vc);
  return made(a + vb * scale * ab + vc * scale * ac, Feature::kFace);
}

Vector3 TriangleMesh::pseudo_normal(std::int32_t place, Feature feature) const noexcept {
  const auto index = static_cast<std::size_t>(place);
  const Face& face = faces_[index];
  const auto edge = [&](std::size_t k) { return Vector3(edge_normals_[index][k].cast<double>()); };
  const auto vertex = [&](std::size_t k) {
    return Vector3(vertex_normals_[static_cast<std::size_t>(face.vertex[k])].cast<double>());
  };
  switch (feature) {
    case Feature::kEdge01:
      return edge(0);
    case Feature::kEdge12:
      return edge(1);
    case Feature::kEdge20:
      return edge(2);
    case Feature::kVertex0:
      return vertex(0);
    case Feature::kVertex1:
      return vertex(1);
    case Feature::kVertex2:
      return vertex(2);
    case Feature::kFace:
      break;
  }
  const Vector3 a = vertices_.row(face.vertex[0]);
  const Vector3 b = vertices_.row(face.vertex[1]);
  const Vector3 c = vertices_.row(face.vertex[2]);
  return (b - a).cross(c - a).normalized();
}

MeshPoint TriangleMesh::finish(std::int32_t place, const Candidate& candidate, const Vector3& point) const noexcept {
  const Vector3 outward = pseudo_normal(place, candidate.feature);
  const Vector3 offset = point - candidate.point;
  const double distance = std::sqrt(candidate.squared);
  const double sign = offset.dot(outward) < 0.0 ? -1.0 : 1.0;
  MeshPoint result;
  result.distance_m = sign * distance;
  result.point = candidate.point;
  // On the surface the offset has no direction; a face's own normal is exact anyway.
  result.normal =
      candidate.feature == Feature::kFace || distance < 1e-9 ? outward.normalized() : Vector3(sign / distance * offset);
  result.triangle = faces_[static_cast<std::size_t>(place)].index;
  return result;
}

template <typename Visit>
void TriangleMesh::visit(const Vector3& point, double& squared_bound, Visit visit_face) const noexcept {
  struct Entry {
    std::int32_t node;
    double squared;
  };
  std::array<Entry, kMaxDepth> stack;
  std::size_t height = 0;
  const auto distance_to = [&](std::int32_t node) {
    const Node& box = nodes_[static_cast<std::size_t>(node)];
    return squared_distance_to_box(point, box.low, box.high);
  };
  stack[height++] = {0, distance_to(0)};
  while (height > 0) {
    const Entry entry = stack[--height];
    if (entry.squared > squared_bound) {
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.count > 0) {
      for (std::int32_t face = node.first; face < node.first + node.count; ++face) {
        visit_face(face);
      }
      continue;
    }
    Entry near{entry.node + 1, distance_to(entry.node + 1)};
    Entry far{node.first, distance_to(node.first)};
    if (far.squared < near.squared) {
      std::swap(near, far);
    }
    stack[height++] = far;
    stack[height++] = near;
  }
}

MeshPoint TriangleMesh::closest(const Vector3& point, double within_m, int hint) const noexcept {
  if (!point.allFinite() || !(within_m >= 0.0)) {
    return {};
  }
  std::int32_t best = -1;
  Candidate found{Vector3::Zero(), within_m * within_m, Feature::kFace};
  if (hint >= 0 && hint < triangles()) {
    // Its distance bounds the search; the search itself finds the answer, so that ties fall as without the hint.
    found.squared = std::min(found.squared, closest_on(place_[static_cast<std::size_t>(hint)], point).squared);
  }
  visit(point, found.squared, [&](std::int32_t face) {
    const Candidate candidate = closest_on(face, point);
    const bool nearer = candidate.squared < found.squared || (best < 0 && candidate.squared <= found.squared);
    const bool tie = best >= 0 && candidate.squared == found.squared && face < best;
    if (nearer || tie) {
      found = candidate;
      best = face;
    }
  });
  return best < 0 ? MeshPoint{} : finish(best, found, point);
}

int TriangleMesh::nearby(const Vector3& point, double within_m, MeshPoint* out, int capacity) const noexcept {
  if (!point.allFinite() || !(within_m >= 0.0) || capacity < 1) {
    return 0;
  }
  int count = 0;
  double bound = within_m * within_m;
  visit(point, bound, [&](std::int32_t face) {
    const Candidate candidate = closest_on(face, point);
    if (candidate.squared > bound) {
      return;
    }
    MeshPoint made = finish(face, candidate, point);
    for (int i = 0; i < count; ++i) {
      if (made.normal.dot(out[i].normal) > kSameNormal) {
        if (std::abs(made.distance_m) < std::abs(out[i].distance_m)) {
          out[i] = made;
        }
        return;
      }
    }
    if (count < capacity) {
      out[count++] = made;
      return;
    }
    MeshPoint* furthest = std::max_element(out, out + count, [](const MeshPoint& a, const MeshPoint& b) {
      return std::abs(a.distance_m) < std::abs(b.distance_m);
    });
    if (std::abs(made.distance_m) < std::abs(furthest->distance_m)) {
      *furthest = made;
    }
  });
  std::sort(out, out + count,
            [](const MeshPoint& a, const MeshPoint& b) { return std::abs(a.distance_m) < std::abs(b.distance_m); });
  return count;
}

TriangleMesh::Triangles TriangleMesh::given_triangles() const {
  Triangles given(triangles(), 3);
  for (const Face& face : faces_) {
    given.row(face.index) << face.vertex[0], face.vertex[1], face.vertex[2];
  }
  return given;
}

}  // namespace saras::csa
