// All laws of both arms, one control tick: what benchmarks/pipeline.py does through the bindings.
#pragma once

#include <array>

#include "saras/teleop/energy_tank.hpp"
#include "saras/teleop/frame_mapping.hpp"
#include "saras/teleop/transparency.hpp"
#include "saras/teleop/twist_estimator.hpp"
#include "saras/teleop/velocity_integrator.hpp"
#include "scenario.hpp"

namespace saras::benchmarks {

inline Vector6 halves(double linear, double angular) {
  return (Vector6() << Vector3::Constant(linear), Vector3::Constant(angular)).finished();
}

inline EnergyTankConfig master_tank_config() {
  EnergyTankConfig config;
  config.damping_min = config.damping_max = Vector6::Zero();
  config.conjugate_rate = halves(20, 200);
  config.applied_limit = halves(3.3, 0.1);
  config.hold_s = 0.012;
  config.dt_max_s = 0.1;
  return config;
}

inline EnergyTankConfig slave_tank_config() {
  EnergyTankConfig config;
  config.damping_min = halves(1e-3, 0);
  config.damping_max = halves(3e-3, 0);
  config.conjugate_rate = halves(400, 40);
  config.applied_limit = halves(0.1, 1.0);
  config.hold_s = 0.03;
  config.dt_max_s = 0.1;
  return config;
}

inline FrameMappingConfig mapping_config() {
  FrameMappingConfig config;
  config.base_T_console = kBaseTConsole;
  config.touch_T_console = kTouchTConsole;
  return config;
}

inline TransparencyConfig transparency_config() {
  TransparencyConfig config;
  config.scale = kScale;
  config.slave_lag_s = kLag;
  return config;
}

inline VelocityIntegratorConfig integrator_config() {
  VelocityIntegratorConfig config;
  config.shaft_through_rcm = true;
  config.dt_max_s = 0.1;
  return config;
}

class Pipeline {
 public:
  void step(const Tick& tick) {
    EnergyTankInput master;
    EnergyTankInput slave;
    for (ChannelArray* array :
         {&master.desired, &master.conjugate, &slave.desired, &slave.conjugate, &slave.measured}) {
      array->resize(6, 2);
    }
    master.has_work = slave.has_work = true;
    for (int i = 0; i < 2; ++i) {
      Side& side = sides_[i];
      const FrameMappingOutput mapped =
          side.mapping.step({tick.handles[i], false, side.wrench, std::nullopt, false}, kDt);
      const Twist moving = side.tip_twist.step({tick.tips[i]}, kDt).twist;
      TransparencyInput input;
      input.master_pose = mapped.tracked_pose;
      input.master_twist = mapped.tracked_twist;
      input.master_twist_filtered = mapped.tracked_twist_filtered;
      input.slave_pose = tick.tips[i];
      input.slave_twist = moving;
      input.tissue_wrench = tick.tissue[i];
      input.rcm = kRcm;
      const TransparencyOutput out = side.transparency.step(input, kDt);
      master.desired.col(i) = to_vector(out.desired_wrench);
      master.conjugate.col(i) = to_vector(mapped.handle_twist);
      slave.desired.col(i) = to_vector(out.desired_twist);
      slave.conjugate.col(i) = to_vector(tick.tissue[i]);
      slave.measured.col(i) = to_vector(moving);
      if (has_tips_) {
        slave.work_J += tick.tissue[i].force.dot(tick.tips[i].translation - side.tip);
      }
      side.tip = tick.tips[i].translation;
    }
    has_tips_ = true;
    const EnergyTankOutput wrench = tank_master_.step(master, kDt);
    const EnergyTankOutput twist = tank_slave_.step(slave, kDt);
    for (int i = 0; i < 2; ++i) {
      sides_[i].wrench = to_wrench(wrench.applied.col(i));
      VelocityIntegratorInput input;
      input.twist = to_twist(twist.applied.col(i));
      input.measured_pose = tick.tips[i];
      input.rcm = kRcm;
      sides_[i].set_point = sides_[i].integrator.step(input, kDt).set_point;
    }
  }

  const Pose& set_point(int side) const { return sides_[side].set_point; }
  double level(int tank) const { return (tank == 0 ? tank_master_ : tank_slave_).state().energy_J; }

 private:
  struct Side {
    FrameMapping mapping{mapping_config()};
    TwistEstimator tip_twist{TwistEstimatorConfig{}};
    Transparency transparency{transparency_config()};
    VelocityIntegrator integrator{integrator_config()};
    Wrench wrench;
    Pose set_point;
    Vector3 tip = Vector3::Zero();
  };

  std::array<Side, 2> sides_;
  EnergyTank tank_master_{master_tank_config(), 2};
  EnergyTank tank_slave_{slave_tank_config(), 2};
  bool has_tips_ = false;
};

}  // namespace saras::benchmarks
