// What the samples around a point say of the tissue there: surface point, stiffness, and how well both are known.
//
// The normal force f = -F . n of the samples near the point is a Gaussian process (local_gp.hpp). The undisturbed
// surface is where its mean falls to surface_force_N along the outward normal n; the stiffness is |n . grad f| there.
// After Chalasani et al. (ICRA 2016), made incremental and local. The normal is the mean direction of the reaction,
// unless it is given: friction tilts it by a few degrees, which cancels in palpation that goes to and fro.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "saras/model/hash_grid.hpp"
#include "saras/model/local_gp.hpp"

namespace saras {

struct LocalModelConfig {
  GpHyperparameters hyperparameters;
  int neighbours = 64;           ///< places in one Gaussian process: its cost is cubic in this
  int min_samples = 6;           ///< fewer places: unknown
  double radius_m = 8e-3;        ///< places further away are left out [m]
  double surface_force_N = 0.0;  ///< the surface is where the mean force falls to this [N]
  double search_m = 6e-3;        ///< farthest from the samples that a surface is looked for along the normal [m]
  double model_error_share =
      0.02;               ///< tissue is no Gaussian process: of stiffness and of extrapolated depth, always added
  void validate() const;  ///< throws ConfigError
};

enum class EstimateStatus : std::uint8_t {
  kOk = 0,
  kTooFewSamples,  ///< nothing is known here
  kNoSurface,      ///< the force is known at the point, but where it would vanish is not
};

/// NaN with an infinite deviation: not known.
struct SurfaceEstimate {
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector3 surface_point = Vector3::Constant(kNan);  ///< on the line through the point along the normal, base frame [m]
  double surface_std_m = kInfinity;                 ///< along the normal [m]
  double stiffness_N_m = kNan;
  double stiffness_std_N_m = kInfinity;
  double force_N = kNan;  ///< normal force at the point itself
  double force_std_N = kInfinity;
  Vector3 normal = Vector3::Constant(kNan);  ///< outward, base frame
  int samples = 0;                           ///< places in the Gaussian process
  EstimateStatus status = EstimateStatus::kTooFewSamples;
};

/// 1 + damping * speed of pressing, by Hunt and Crossley (1975): what tissue at rest would answer is force / share.
double damping_share(double damping_s_m, double speed_m_s) noexcept;

class LocalModel {
 public:
  /// Allocates all it will ever use. Throws ConfigError.
  explicit LocalModel(LocalModelConfig config = {}, const HashGridConfig& grid = {});

  /// Takes the places around the point, those nearest across the surface first. normal: outward unit vector, or null
  /// for the mean reaction. False: fewer than min_samples, or a reaction without direction; then nothing is known.
  bool build(const HashGrid& grid, const Vector3& around, const Vector3* normal = nullptr) noexcept;
  /// Takes over what HashGrid::insert has just made of one place, in O(neighbours^2).
  void learn(const HashGrid& grid, int place) noexcept;
  void clear() noexcept;
  /// Other hyper-parameters; knows nothing until the next build(). Throws ConfigError.
  void adopt(const GpHyperparameters& hyperparameters);

  /// The sample as the process takes it: normal force of tissue at rest, as far as its damping is known.
  GpSample process_sample(const TouchSample& sample) const noexcept;
  bool usable() const { return process_.size() >= config_.min_samples; }
  /// Of the last build(): places further than this across the surface would not have been taken [m].
  double reach_m() const { return reach_m_; }
  const Vector3& center() const { return center_; }
  const Vector3& normal() const { return process_.normal(); }
  const LocalGp& process() const { return process_; }
  /// Places in the process, in its order.
  const std::vector<int>& members() const { return members_; }
  SurfaceEstimate estimate(const Vector3& at) const noexcept;
  const LocalModelConfig& config() const { return config_; }

 private:
  bool take(const HashGrid& grid, int place) noexcept;

  LocalModelConfig config_;
  LocalGp process_;
  Vector3 center_ = Vector3::Zero();
  double reach_m_ = 0.0;
  std::vector<int> members_;  ///< places, in the order of the process
  struct Candidate {
    double distance;
    int place;
  };
  std::vector<int> found_;
  std::vector<Candidate> candidates_;
};

/// What is known at each of `count` points. normals: as many outward unit vectors, or null.
void estimate_surfaces(const HashGrid& grid, LocalModel& workspace, const Vector3* points, const Vector3* normals,
                       std::size_t count, SurfaceEstimate* estimates) noexcept;

}  // namespace saras
