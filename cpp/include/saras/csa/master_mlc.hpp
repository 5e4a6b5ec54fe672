// Master mid-level controller: joint torques from a wrench on the hand, gravity and what others add.
#pragma once

#include <memory>
#include <vector>

#include "saras/csa/constrained_motion.hpp"
#include "saras/kinematics/chain.hpp"

namespace saras::csa {

/// What gravity acts on: one a joint of the chain, fixed ones too.
struct LinkMass {
  double mass_kg = 0.0;
  Vector3 centre_m = Vector3::Zero();  ///< in the link's frame
};

/// Joint torques that hold a chain against gravity (KDL's ChainDynParam).
class GravityModel {
 public:
  /// gravity: acceleration in the base frame [m/s^2]. Throws ConfigError, KinematicsError.
  GravityModel(const std::vector<Joint>& joints, const std::vector<LinkMass>& masses,
               const Vector3& gravity = {0.0, 0.0, -9.81});
  GravityModel(const GravityModel& other);
  GravityModel& operator=(const GravityModel&) = delete;
  GravityModel(GravityModel&&) noexcept;
  ~GravityModel();
  /// Torques [N m, N] that the motors must give at q; zero for a q of the wrong size. Allocates nothing.
  JointVector torque(const JointVector& q) const noexcept;
  int joints() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct MasterMlcConfig {
  JointVector torque_limit;  ///< largest |torque| of each joint [N m, N]
  bool gravity = true;       ///< add the gravity model's torques, where there is one
  Seconds dt_max_s = 0.1;
  void validate() const;  ///< throws ConfigError
};

struct MasterMlcInput {
  JointVector q;                ///< measured [rad, m]
  TipJacobian jacobian;         ///< at q, base axes
  Wrench wrench;                ///< on the hand, base axes: computed by ComplianceWrench, or given from outside
  JointVector external_torque;  ///< sum of what others add [N m, N]; empty: nothing
  bool wrench_stale = false;    ///< older than its limit: gravity and external torques only
};

struct MasterMlcOutput {
  JointVector torque;             ///< for the low-level controller
  JointVector compliance_torque;  ///< J' wrench
  JointVector gravity_torque;
  Status status = Status::kOk;  ///< LIMITED: a joint at its limit; STALE: no wrench
};

struct MasterMlcState {};

/// torque = J' wrench + gravity + external, each joint limited. The wrench is what the handle exerts on the hand. At a
/// limit the gravity part is kept and the rest is scaled down together, so that its direction stays.
class MasterMlc {
 public:
  MasterMlc(MasterMlcConfig config, std::shared_ptr<const GravityModel> gravity);
  MasterMlcOutput step(const MasterMlcInput& input, Seconds dt) noexcept;
  void reset(const MasterMlcState& state = {}) { state_ = state; }
  const MasterMlcState& state() const { return state_; }
  const MasterMlcConfig& config() const { return config_; }

 private:
  MasterMlcConfig config_;
  std::shared_ptr<const GravityModel> gravity_;
  MasterMlcState state_;
};

static_assert(has_law_shape<MasterMlc, MasterMlcInput, MasterMlcState>());

}  // namespace saras::csa
