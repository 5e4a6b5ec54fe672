#include "saras/model/hash_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "saras/spatial/errors.hpp"
#include "support/random_values.hpp"

namespace saras {
namespace {

using test::kInf;
using test::kNan;
using test::RandomValues;

TEST(HashGrid, FindsExactlyWhatABruteForceSearchFinds) {
  RandomValues random(1);
  HashGridConfig config;
  config.max_cells = 3000;
  HashGrid grid(config);
  for (int i = 0; i < 5000; ++i) {
    grid.insert(random.vector(0.01), random.vector(1.0));
  }
  std::vector<int> found(static_cast<std::size_t>(config.candidates_within(6e-3)));
  for (int i = 0; i < 200; ++i) {
    const Vector3 at = random.vector(0.012);
    const double radius_m = random.uniform(1e-4, 6e-3);
    const int count = grid.within(at, radius_m, found.data(), static_cast<int>(found.size()));
    std::vector<int> ours(found.begin(), found.begin() + count);
    std::sort(ours.begin(), ours.end());
    std::vector<int> expected;
    for (const int place : grid.used()) {
      if ((grid.place(place).position - at).norm() <= radius_m) {
        expected.push_back(place);
      }
    }
    EXPECT_EQ(ours, expected);
  }
}

TEST(HashGrid, MergingKeepsMeansOfPositionForceAndSpeed) {
  RandomValues random(2);
  HashGridConfig config;
  config.max_weight = 1e9;
  HashGrid grid(config);
  Vector3 position = Vector3::Zero();
  Vector3 force = Vector3::Zero();
  double speed = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3 x = random.vector(5e-3);
    const Vector3 f = random.vector(2.0);
    const double v = random.uniform(-1.0, 1.0);
    ASSERT_GE(grid.insert(x, f, v), 0);
    position += x;
    force += f;
    speed += v;
  }
  double weight = 0.0;
  for (const int place : grid.used()) {
    const TouchSample& sample = grid.place(place);
    position -= sample.weight * sample.position;
    force -= sample.weight * sample.force;
    speed -= sample.weight * sample.speed_m_s;
    weight += sample.weight;
  }
  EXPECT_NEAR(position.norm() + force.norm() + std::abs(speed), 0.0, 1e-8);
  EXPECT_EQ(weight, 20000.0);
  EXPECT_LE(grid.places(), grid.cells() * config.samples_per_cell);
}

TEST(HashGrid, FullItForgetsTheCellTouchedLongestAgo) {
  HashGridConfig config;
  config.max_cells = 10;
  HashGrid grid(config);
  const auto cell = [&](int i) { return Vector3((i + 0.5) * config.cell_m, 0.0, 0.0); };
  for (int i = 0; i < 10; ++i) {
    grid.insert(cell(i), Vector3::UnitZ());
  }
  grid.insert(cell(0), Vector3::UnitZ());  // cell 1 is the oldest now
  grid.insert(cell(10), Vector3::UnitZ());
  EXPECT_EQ(grid.cells(), 10);
  EXPECT_EQ(grid.evicted(), 1u);
  int found[4];
  EXPECT_EQ(grid.within(cell(1), 1e-4, found, 4), 0);
  EXPECT_EQ(grid.within(cell(0), 1e-4, found, 4), 1);
  for (int i = 0; i < 100000; ++i) {  // whatever comes: no more than it was given
    grid.insert(cell(i % 977), Vector3::UnitZ());
  }
  EXPECT_EQ(grid.cells(), 10);
  EXPECT_EQ(grid.used().size(), static_cast<std::size_t>(grid.places()));
}

TEST(HashGrid, RefusesWhatIsNoPlace) {
  HashGrid grid;
  EXPECT_EQ(grid.insert({kNan, 0.0, 0.0}, Vector3::UnitZ()), -1);
  EXPECT_EQ(grid.insert(Vector3::Zero(), {0.0, kInf, 0.0}), -1);
  EXPECT_EQ(grid.insert({1e9, 0.0, 0.0}, Vector3::UnitZ()), -1);
  EXPECT_EQ(grid.places(), 0);
  HashGridConfig config;
  config.cell_m = 0.0;
  EXPECT_THROW(HashGrid{config}, ConfigError);
}

TEST(HashGrid, ForgetsAroundAPointOnly) {
  RandomValues random(3);
  HashGrid grid;
  for (int i = 0; i < 3000; ++i) {
    grid.insert(random.vector(0.01), random.vector(1.0));
  }
  const int before = grid.places();
  grid.forget(Vector3::Zero(), 4e-3);
  EXPECT_LT(grid.places(), before);
  for (const int place : grid.used()) {
    EXPECT_GT(grid.place(place).position.norm(), 4e-3 - grid.config().cell_m);
  }
  grid.clear();
  EXPECT_EQ(grid.places() + grid.cells(), 0);
}

}  // namespace
}  // namespace saras
