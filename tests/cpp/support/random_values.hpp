// Seeded random poses, twists and wrenches for tests.
#pragma once

#include <limits>
#include <random>

#include "saras/spatial/types.hpp"

namespace saras::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInf = std::numeric_limits<double>::infinity();

class RandomValues {
 public:
  explicit RandomValues(unsigned seed) : engine_(seed) {}

  double uniform(double lowest, double highest) {
    return std::uniform_real_distribution<double>(lowest, highest)(engine_);
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  Vector3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Quaternion rotation() {
    std::normal_distribution<double> normal;
    return Quaternion(normal(engine_), normal(engine_), normal(engine_), normal(engine_)).normalized();
  }
  Pose pose(double size) { return {rotation(), vector(size)}; }
  Twist twist(double linear, double angular) { return {vector(linear), vector(angular)}; }
  Wrench wrench(double force, double torque) { return {vector(force), vector(torque)}; }

 private:
  std::mt19937 engine_;
};

}  // namespace saras::test
