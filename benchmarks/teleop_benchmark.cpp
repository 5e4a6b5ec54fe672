#include "groups.hpp"
#include "pipeline.hpp"

namespace saras::benchmarks {
namespace {

constexpr int kCount = 50000;

EnergyTankInput tank_input(const Tick& tick) {
  EnergyTankInput input;
  input.desired = ChannelArray::Constant(6, 2, 0.05);
  input.conjugate.resize(6, 2);
  input.conjugate << to_vector(tick.tissue[0]), to_vector(tick.tissue[1]);
  input.has_work = true;
  return input;
}

}  // namespace

std::vector<Row> teleop_rows() {
  const std::vector<Tick> scenario = ticks();
  const auto at = [&](int i) -> const Tick& { return scenario[static_cast<std::size_t>(i % kTicks)]; };
  std::vector<Row> rows;

  Pipeline pipeline;
  rows.push_back(measure("teleop", "pipeline_both_arms", kCount, [&](int i) { pipeline.step(at(i)); }));
  keep(pipeline.set_point(0));

  FrameMapping mapping(mapping_config());
  rows.push_back(measure("teleop", "frame_mapping", kCount, [&](int i) {
    keep(mapping.step({at(i).handles[0], false, at(i).tissue[0], std::nullopt, false}, kDt));
  }));

  TwistEstimator twist_estimator{TwistEstimatorConfig{}};
  rows.push_back(
      measure("teleop", "twist_estimator", kCount, [&](int i) { keep(twist_estimator.step({at(i).tips[0]}, kDt)); }));

  Transparency transparency(transparency_config());
  rows.push_back(measure("teleop", "transparency", kCount, [&](int i) {
    TransparencyInput input;
    input.master_pose = at(i).handles[0];
    input.slave_pose = at(i).tips[0];
    input.tissue_wrench = at(i).tissue[0];
    input.rcm = kRcm;
    keep(transparency.step(input, kDt));
  }));

  EnergyTank full(slave_tank_config(), 2);
  rows.push_back(
      measure("teleop", "energy_tank_full", kCount, [&](int i) { keep(full.step(tank_input(at(i)), kDt)); }));

  // A hair above the floor: the budget binds, so every step searches for the largest command that fits.
  EnergyTankConfig config = slave_tank_config();
  config.initial_J = config.minimum_J + 1e-4;
  EnergyTank low(config, 2);
  rows.push_back(measure("teleop", "energy_tank_near_floor", kCount,
                         [&](int i) { keep(low.step(tank_input(at(kTicks / 6 + i % 10)), kDt)); }));

  VelocityIntegrator integrator(integrator_config());
  rows.push_back(measure("teleop", "velocity_integrator", kCount, [&](int i) {
    VelocityIntegratorInput input;
    input.twist.linear = Vector3(0.01, 0.0, 0.01);
    input.measured_pose = at(i).tips[0];
    input.rcm = kRcm;
    keep(integrator.step(input, kDt));
  }));
  return rows;
}

std::vector<double> teleop_check() {
  Pipeline pipeline;
  for (const Tick& tick : ticks()) {
    pipeline.step(tick);
  }
  std::vector<double> numbers{pipeline.level(0), pipeline.level(1)};
  for (int side = 0; side < 2; ++side) {
    const Vector3& position = pipeline.set_point(side).translation;
    numbers.insert(numbers.end(), position.data(), position.data() + 3);
  }
  return numbers;
}

}  // namespace saras::benchmarks
