// The operator: a hand around an intended motion, holding the mass of the handle, so that force moves the hand.
#pragma once

#include "saras/sim/second_order.hpp"
#include "saras/spatial/law.hpp"

namespace saras {

struct OperatorConfig {
  double stiffness_N_m = 200.0;          ///< of the hand around the intended position [N/m]
  double damping_N_s_m = 6.0;            ///< of the hand around the intended velocity [N s/m]; negative: an active hand
  double hand_mass_kg = 0.4;             ///< [kg]
  double handle_mass_kg = 0.2;           ///< [kg]
  double roll_stiffness_N_m_rad = 0.02;  ///< of the fingers around the intended roll [N m/rad]
  double roll_damping_N_m_s_rad = 1e-3;  ///< [N m s/rad]
  double roll_inertia_kg_m2 = 2e-5;      ///< fingers and handle [kg m^2]
  Vector3 workspace_centre_m = Vector3::Zero();  ///< of the handle's mechanical stops [m]
  double workspace_radius_m = 0.15;              ///< inelastic mechanical stop [m]
  double speed_max_m_s = 2.0;                    ///< no hand is faster; bounds what an active hand can do [m/s]
  Seconds dt_max_s = 0.5;                        ///< longest step [s]
  void validate() const;                         ///< throws ConfigError

  static OperatorConfig firm();
  static OperatorConfig normal() { return {}; }
  static OperatorConfig weak();
  /// A hand that feeds every motion (negative damping): for adversarial tests.
  static OperatorConfig active();
};

struct OperatorInput {
  Vector3 force = Vector3::Zero();              ///< that the handle exerts on the hand [N], console frame
  double roll_torque = 0.0;                     ///< that the handle exerts about its axis [N m]
  Vector3 intended_position = Vector3::Zero();  ///< [m], console frame
  Vector3 intended_velocity = Vector3::Zero();  ///< [m/s]
  double intended_roll = 0.0;                   ///< [rad]
};

struct OperatorOutput {
  Vector3 position = Vector3::Zero();  ///< of the handle [m], console frame
  Vector3 velocity = Vector3::Zero();  ///< [m/s]
  double roll = 0.0;                   ///< [rad]
  double roll_rate = 0.0;              ///< [rad/s]
  Status status = Status::kOk;         ///< LIMITED at a stop
};

struct OperatorState {
  Vector3 position = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();
  double roll = 0.0;
  double roll_rate = 0.0;
};

/// (hand + handle mass) x'' = stiffness (x_i - x) + damping (x_i' - x') + force, exact for inputs held over dt.
class Operator {
 public:
  explicit Operator(OperatorConfig config);
  OperatorOutput step(const OperatorInput& input, Seconds dt) noexcept;
  void reset(const OperatorState& state = {}) { state_ = state; }
  const OperatorState& state() const { return state_; }
  const OperatorConfig& config() const { return config_; }

 private:
  OperatorConfig config_;
  OperatorState state_;
  Seconds cached_dt_ = 0.0;  // the coefficients depend on config and dt only: no part of the state
  SecondOrderStep cached_translation_;
  SecondOrderStep cached_roll_;
};

static_assert(has_law_shape<Operator, OperatorInput, OperatorState>());

}  // namespace saras
