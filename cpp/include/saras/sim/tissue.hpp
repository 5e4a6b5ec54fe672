// Soft tissue that a tool tip presses on: Hunt-Crossley contact with a stiffness field.
#pragma once

#include "saras/sim/random.hpp"
#include "saras/spatial/law.hpp"

namespace saras {

struct TissueConfig {
  Pose base_T_surface;           ///< surface frame: origin on the surface, z = outward normal there, x and y along it
  double curvature_1_m = 0.0;    ///< 1 / radius of the sphere that the surface is; > 0 bulges outward, 0 plane [1/m]
  double stiffness_N_m = 300.0;  ///< K away from the inclusion [N/m^exponent]
  double inclusion_stiffness_N_m = 1500.0;  ///< K at the centre of the inclusion [N/m^exponent]
  double inclusion_x_m = 0.02;              ///< centre of the inclusion, surface frame [m]
  double inclusion_y_m = 0.0;               ///< [m]
  double inclusion_radius_m = 0.008;        ///< standard deviation of the Gaussian inclusion [m]
  double exponent = 1.0;                    ///< n of depth^n [-]
  double damping_N_s_m2 = 5000.0;           ///< lambda [N s/m^(1+n)], where K = stiffness_N_m; scales with K elsewhere
  double friction = 0.05;                   ///< Coulomb coefficient [-]
  double friction_speed_m_s = 1e-3;         ///< below it friction is viscous (regularisation) [m/s]
  double skin_stiffness_N_m = 300.0;        ///< of the abdominal wall around the trocar [N/m]
  double force_noise_N = 0.0;               ///< standard deviation of the sensor's noise, each axis [N]
  std::uint64_t seed = 1;                   ///< of the noise
  void validate() const;                    ///< throws ConfigError
};

struct TissueInput {
  Vector3 tip_position = Vector3::Zero();      ///< base frame [m]
  Vector3 tip_velocity = Vector3::Zero();      ///< base frame [m/s]
  Vector3 trocar_deviation = Vector3::Zero();  ///< of the shaft from the trocar, base frame [m]
};

struct TissueOutput {
  Wrench wrench;                         ///< that the tool exerts on the tissue, base frame [N, N m]
  Wrench measured_wrench;                ///< the same with the sensor's noise
  Vector3 skin_force = Vector3::Zero();  ///< that the shaft exerts on the trocar's skin [N]
  Vector3 normal = Vector3::Zero();      ///< outward, base frame; zero when the input was bad
  double depth = 0.0;                    ///< indentation [m]; negative: distance to the surface
  double stiffness = 0.0;                ///< K under the tip
  double stored_energy_J = 0.0;          ///< elastic energy of the dent [J]
  bool contact = false;
  Status status = Status::kOk;
};

struct TissueState {
  Random noise{1};
};

/// Elastic energy U = K(x, y) d^(n+1) / (n+1); force on the tool -grad U (1 + (lambda/K) e')_+ with e' = U' / (K d^n),
/// and friction against the sliding. On homogeneous tissue e' = d' and this is Hunt and Crossley (1975),
/// K d^n + lambda d^n d', never pulling. Taking the force from U keeps tissue with an inclusion passive: pressing in
/// where it is soft and coming out where it is stiff gains nothing.
class Tissue {
 public:
  explicit Tissue(TissueConfig config);
  /// dt only has to be valid: the contact itself has no memory.
  TissueOutput step(const TissueInput& input, Seconds dt) noexcept;
  void reset() { state_ = {Random(config_.seed)}; }
  void reset(const TissueState& state) { state_ = state; }
  const TissueState& state() const { return state_; }
  const TissueConfig& config() const { return config_; }

 private:
  TissueConfig config_;
  TissueState state_;
};

static_assert(has_law_shape<Tissue, TissueInput, TissueState>());

}  // namespace saras
