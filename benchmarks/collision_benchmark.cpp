// saras_collision_benchmark [PAIRS]: distances beside Coal 3 and FCL 0.7 in one binary, and whether they agree.
// Prints {"rows": [{group, name, p50, p99, peers: {coal: {…}, fcl: {…}}}], "check": {…}}. script/bench runs it.
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/distance.h>
#include <coal/shape/geometric_shapes.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/distance.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

#include "saras/collision/scene.hpp"
#include "timing.hpp"

namespace {

using saras::Capsule;
using saras::Parallelepiped;
using saras::Pose;
using saras::Quaternion;
using saras::Vector3;
using saras::benchmarks::Clock;
using saras::benchmarks::keep;
using saras::benchmarks::percentile;

constexpr std::size_t kPairs = 4096;  // power of two: i & (kPairs - 1)
constexpr int kSamples = 20000;
/// Calls a sample: a query takes as long as asking the clock.
constexpr int kBatch = 16;

class Random {
 public:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Vector3 unit() {
    std::normal_distribution<double> normal;
    return Vector3(normal(engine_), normal(engine_), normal(engine_)).normalized();
  }
  Quaternion rotation() {
    std::normal_distribution<double> normal;
    return Quaternion(normal(engine_), normal(engine_), normal(engine_), normal(engine_)).normalized();
  }

 private:
  std::mt19937 engine_{1};
};

/// A tool in the three libraries' terms.
struct Tool {
  explicit Tool(const Capsule& shape)
      : ours(shape),
        coal(shape.radius_m, (shape.b - shape.a).norm()),
        fcl(std::make_shared<fcl::Capsuled>(shape.radius_m, (shape.b - shape.a).norm())) {
    const Quaternion rotation = Quaternion::FromTwoVectors(Vector3::UnitZ(), shape.b - shape.a);
    const Vector3 middle = 0.5 * (shape.a + shape.b);
    coal_pose = coal::Transform3s(rotation.toRotationMatrix(), middle);
    fcl_pose.linear() = rotation.toRotationMatrix();
    fcl_pose.translation() = middle;
  }
  Capsule ours;
  coal::Capsule coal;
  coal::Transform3s coal_pose;
  std::shared_ptr<fcl::Capsuled> fcl;
  fcl::Transform3d fcl_pose = fcl::Transform3d::Identity();
};

struct Region {
  Region(const Vector3& center, const Quaternion& rotation, const Vector3& size)
      : ours(center - 0.5 * (rotation * size), rotation * Vector3(size.x(), 0, 0), rotation * Vector3(0, size.y(), 0),
             rotation * Vector3(0, 0, size.z())),
        coal(size.x(), size.y(), size.z()),
        coal_pose(rotation.toRotationMatrix(), center),
        fcl(std::make_shared<fcl::Boxd>(size.x(), size.y(), size.z())) {
    fcl_pose.linear() = rotation.toRotationMatrix();
    fcl_pose.translation() = center;
  }
  Parallelepiped ours;
  coal::Box coal;
  coal::Transform3s coal_pose;
  std::shared_ptr<fcl::Boxd> fcl;
  fcl::Transform3d fcl_pose = fcl::Transform3d::Identity();
};

Tool random_tool(Random& random, double spread) {
  const Vector3 tip = random.vector(spread);
  return Tool({tip, tip + random.uniform(0.1, 0.3) * random.unit(), random.uniform(0.0025, 0.0042)});
}
Region random_region(Random& random, double spread) {
  const Vector3 size(random.uniform(0.01, 0.1), random.uniform(0.01, 0.1), random.uniform(0.01, 0.1));
  return {random.vector(spread), random.rotation(), size};
}

const coal::DistanceRequest coal_request(true, true);
const fcl::DistanceRequestd fcl_request(true, true);

template <typename Shape>
double coal_distance(const Tool& a, const Shape& b) {
  coal::DistanceResult result;
  coal::distance(&a.coal, a.coal_pose, &b.coal, b.coal_pose, coal_request, result);
  keep(result.nearest_points[0]);
  return result.min_distance;
}
template <typename Shape>
double fcl_distance(const Tool& a, const Shape& b) {
  fcl::DistanceResultd result;
  fcl::distance(a.fcl.get(), a.fcl_pose, b.fcl.get(), b.fcl_pose, fcl_request, result);
  keep(result.nearest_points[0]);
  return result.min_distance;
}

struct Times {
  double p50_ns;
  double p99_ns;
};

/// Per call, of samples of `batch` calls.
template <typename Call>
Times measure(int samples, int batch, Call&& call) {
  static const double overhead_ns = saras::benchmarks::clock_overhead_ns();
  std::vector<double> times(static_cast<std::size_t>(samples));
  std::size_t i = 0;
  for (int sample = -samples / 10; sample < samples; ++sample) {  // the first tenth warms up
    const auto start = Clock::now();
    for (int k = 0; k < batch; ++k) {
      call(i++);
    }
    const double ns = (saras::benchmarks::nanoseconds(Clock::now() - start) - overhead_ns) / batch;
    if (sample >= 0) {
      times[static_cast<std::size_t>(sample)] = std::max(0.0, ns);
    }
  }
  return {percentile(times, 0.5), percentile(times, 0.99)};
}

bool first_row = true;
void print_row(const char* name, const Times& ours, const Times& coal, const Times& fcl) {
  std::printf(
      "%s\n  {\"group\": \"collision\", \"name\": \"%s\", \"p50\": %.1f, \"p99\": %.1f, \"peers\": {"
      "\"coal\": {\"p50\": %.1f, \"p99\": %.1f}, \"fcl\": {\"p50\": %.1f, \"p99\": %.1f}}}",
      first_row ? "" : ",", name, ours.p50_ns, ours.p99_ns, coal.p50_ns, coal.p99_ns, fcl.p50_ns, fcl.p99_ns);
  first_row = false;
}

template <typename Other>
void pair_row(const char* name, const std::vector<Tool>& tools, const std::vector<Other>& others, double* worst,
              double* worst_fcl, int* missed, std::size_t count) {
  const auto at = [](std::size_t i) { return i & (kPairs - 1); };
  const auto ours = [&](std::size_t i) { return saras::distance(tools[at(i)].ours, others[at(i)].ours).distance_m; };
  // Pairs that only the check sees: each tool against shifted partners.
  for (std::size_t i = 0; i < count; ++i) {
    const Tool& a = tools[at(i)];
    const Other& b = others[at(i + i / kPairs)];
    const double mine = saras::distance(a.ours, b.ours).distance_m;
    const double theirs = coal_distance(a, b);
    if (mine > 0.0) {
      *worst = std::max(*worst, std::abs(mine - theirs));
      *worst_fcl = std::max(*worst_fcl, std::abs(mine - fcl_distance(a, b)));
    }
    *missed += (mine > 1e-6 && theirs < -1e-6) || (mine < -1e-6 && theirs > 1e-6) ? 1 : 0;
  }
  print_row(name, measure(kSamples, kBatch, [&](std::size_t i) { keep(ours(i)); }),
            measure(kSamples, kBatch, [&](std::size_t i) { keep(coal_distance(tools[at(i)], others[at(i)])); }),
            measure(kSamples / 4, kBatch, [&](std::size_t i) { keep(fcl_distance(tools[at(i)], others[at(i)])); }));
}

/// For the managers of Coal and FCL: least distance of one object from all, as their own default callbacks do it.
struct CoalNearest : coal::DistanceCallBackBase {
  coal::DistanceResult result;
  void init() override { result.clear(); }
  bool distance(coal::CollisionObject* a, coal::CollisionObject* b, coal::CoalScalar& least) override {
    coal::distance(a, b, coal_request, result);
    least = result.min_distance;
    return false;
  }
};
bool fcl_nearest(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data, double& least) {
  auto* result = static_cast<fcl::DistanceResultd*>(data);
  fcl::distance(a, b, fcl_request, *result);
  least = result->min_distance;
  return false;
}

/// 4 tools among `count` boxes that fill space equally densely, whatever their count.
void scene_row(Random& random, int count, double* worst) {
  const double spread = 0.05 * std::cbrt(static_cast<double>(count));
  std::vector<Region> regions;
  std::vector<Parallelepiped> shapes;
  for (int i = 0; i < count; ++i) {
    const Vector3 size(random.uniform(0.01, 0.03), random.uniform(0.01, 0.03), random.uniform(0.01, 0.03));
    regions.emplace_back(random.vector(spread), random.rotation(), size);
    shapes.push_back(regions.back().ours);
  }
  saras::Scene scene(4, shapes);
  coal::DynamicAABBTreeCollisionManager coal_manager;
  fcl::DynamicAABBTreeCollisionManagerd fcl_manager;
  std::vector<std::unique_ptr<coal::CollisionObject>> coal_objects;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> fcl_objects;
  for (const Region& region : regions) {
    coal_objects.push_back(
        std::make_unique<coal::CollisionObject>(std::make_shared<coal::Box>(region.coal), region.coal_pose));
    coal_manager.registerObject(coal_objects.back().get());
    fcl_objects.push_back(std::make_unique<fcl::CollisionObjectd>(region.fcl, region.fcl_pose));
    fcl_manager.registerObject(fcl_objects.back().get());
  }
  coal_manager.setup();
  fcl_manager.setup();
  // 64 places of four tools near the middle.
  std::vector<std::array<Tool, 4>> places;
  std::vector<std::vector<saras::SceneTool>> inputs;
  for (int i = 0; i < 64; ++i) {
    places.push_back(
        {random_tool(random, 0.1), random_tool(random, 0.1), random_tool(random, 0.1), random_tool(random, 0.1)});
    inputs.emplace_back();
    for (const Tool& tool : places.back()) {
      inputs.back().push_back({tool.ours, true});
    }
  }
  const auto coal_least = [&](const Tool& tool) {
    CoalNearest nearest;
    coal::CollisionObject object(std::make_shared<coal::Capsule>(tool.coal), tool.coal_pose);
    object.computeAABB();
    coal_manager.distance(&object, &nearest);
    return nearest.result.min_distance;
  };
  const auto fcl_least = [&](const Tool& tool) {
    fcl::DistanceResultd result;
    fcl::CollisionObjectd object(tool.fcl, tool.fcl_pose);
    object.computeAABB();
    fcl_manager.distance(&object, &result, fcl_nearest);
    return result.min_distance;
  };
  const auto pairs = [](const std::array<Tool, 4>& tools, auto&& distance) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        keep(distance(tools[a], tools[b]));
      }
    }
  };
  const saras::RegionTree tree(shapes);
  for (const auto& place : places) {
    for (const Tool& tool : place) {
      const double mine = tree.nearest(tool.ours).distance.distance_m;
      if (mine > 0.0) {
        *worst = std::max(*worst, std::abs(mine - coal_least(tool)));
      }
    }
  }
  const auto at = [&](std::size_t i) { return i % places.size(); };
  const std::string name = "scene_4_tools_" + std::to_string(count) + "_boxes";
  print_row(name.c_str(), measure(4000, 1, [&](std::size_t i) { keep(scene.distances(inputs[at(i)])[0]); }),
            measure(1000, 1,
                    [&](std::size_t i) {
                      for (const Tool& tool : places[at(i)]) {
                        keep(coal_least(tool));
                      }
                      pairs(places[at(i)], coal_distance<Tool>);
                    }),
            measure(300, 1, [&](std::size_t i) {
              for (const Tool& tool : places[at(i)]) {
                keep(fcl_least(tool));
              }
              pairs(places[at(i)], fcl_distance<Tool>);
            }));
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100000;
  Random random;
  std::vector<Tool> tools;
  std::vector<Tool> others;
  std::vector<Region> regions;
  for (std::size_t i = 0; i < kPairs; ++i) {
    tools.push_back(random_tool(random, 0.2));
    others.push_back(random_tool(random, 0.2));
    regions.push_back(random_region(random, 0.2));
  }
  double worst_capsules = 0.0;
  double worst_boxes = 0.0;
  double worst_capsules_fcl = 0.0;
  double worst_boxes_fcl = 0.0;
  double worst_scenes = 0.0;
  int disagreements = 0;
  std::printf("{\"rows\": [");
  pair_row("capsule_capsule", tools, others, &worst_capsules, &worst_capsules_fcl, &disagreements, count);
  pair_row("capsule_box", tools, regions, &worst_boxes, &worst_boxes_fcl, &disagreements, count);
  for (const int boxes : {10, 100, 1000, 10000, 100000}) {
    scene_row(random, boxes, &worst_scenes);
  }
  std::printf(
      "],\n \"check\": {\"pairs\": %zu, \"collisions_disagreed\": %d, \"coal_capsules_m\": %.3g, \"coal_boxes_m\": "
      "%.3g, "
      "\"fcl_capsules_m\": %.3g, \"fcl_boxes_m\": %.3g, \"coal_scenes_m\": %.3g}}\n",
      2 * count, disagreements, worst_capsules, worst_boxes, worst_capsules_fcl, worst_boxes_fcl, worst_scenes);
  // Coal and FCL each bring an octomap of their own; the two free the same table when static objects are destroyed.
  std::fflush(stdout);
  std::_Exit(0);
}
