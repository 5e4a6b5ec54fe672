// Where a mesh lies, from points measured on it, each with its own covariance: iterative most likely point.
//
// Billings, Boctor, Taylor: Iterative Most-Likely Point Registration (IMLP), PLoS ONE 10(3), 2015. Each point is
// matched to the place on the mesh that it most likely came from, points that no place is likely for are left out by a
// chi-squared gate, and the pose is the weighted least-squares one (Gauss-Newton). As long as the pose is far off, the
// misalignment itself is noise: the mean squared distance of the matches is added to every covariance.
#pragma once

#include <limits>
#include <vector>

#include "saras/model/surface_mesh.hpp"
#include "saras/spatial/types.hpp"

namespace saras {

/// A point on the surface, as measured in the base frame.
struct SurfacePoint {
  Vector3 position = Vector3::Zero();                               ///< [m]
  Eigen::Matrix3d covariance = 1e-6 * Eigen::Matrix3d::Identity();  ///< of its error, base frame [m^2]
};

/// What is believed of a pose before anything is measured; infinite deviations: nothing.
struct PosePrior {
  Pose base_T_mesh;
  double shift_m =
      std::numeric_limits<double>::infinity();  ///< standard deviation at the points' middle, each axis [m]
  double turn_rad = std::numeric_limits<double>::infinity();  ///< of its rotation, each axis [rad]
};

struct RegistrationOptions {
  double gate = 7.81;         ///< squared deviation above which a point is left out (95 % of three normal values)
  double mesh_noise_m = 0.0;  ///< standard deviation of the mesh's own error, each axis [m]
  int max_iterations = 100;   ///< until it has settled; where points were left out, at most 30 more weigh them
  double tolerance_m = 1e-6;  ///< settled: the mesh's points move less than this
  PosePrior prior;            ///< holds what the points leave open: a mesh slides along a smooth patch unseen
  bool most_likely = true;    ///< false: closest points, all weights equal: ICP (Besl and McKay 1992), for comparison
  void validate() const;      ///< throws ConfigError
};

struct Registration {
  Pose base_T_mesh;
  Eigen::Matrix<double, 6, 6> covariance =
      Eigen::Matrix<double, 6, 6>::Zero();  ///< of displacement(estimate, truth), at the points' middle: [m, rad]
  std::vector<MeshMatch> matches;           ///< of each point, in the mesh's frame
  std::vector<bool> used;                   ///< false: more probably a gross error than noise
  double rms_m = 0.0;                       ///< distance of the used points from the mesh
  int iterations = 0;
  bool converged = false;
};

/// Throws ModelError: see register_rigid.
void check_surface_points(const SurfaceMesh& mesh, const std::vector<SurfacePoint>& points, const Pose& base_T_mesh);

/// base_T_mesh: where to start. Throws ModelError: fewer than 3 points, a point or covariance that is not finite or not
/// positive definite, points of another unit than the mesh.
Registration register_rigid(const SurfaceMesh& mesh, const MeshTree& tree, const std::vector<SurfacePoint>& points,
                            const Pose& base_T_mesh, const RegistrationOptions& options = {});

}  // namespace saras
