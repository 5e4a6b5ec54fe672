// Where a board lies in an arm's base frame, from dots that the arm's tip has touched.
#pragma once

#include <optional>
#include <vector>

#include "saras/spatial/types.hpp"

namespace saras {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct FrameFromPointsOptions {
  double touch_noise_m = 0.5e-3;  ///< expected error of a touch, per axis; enters the covariance of few touches
  double max_rms_m = 2e-3;        ///< refused above: root mean square distance of touches and fitted dots
  double min_spread_m = 0.02;     ///< refused below: RMS extent across the line that fits the dots best
  std::optional<Vector3> above;   ///< a point on the printed side, in the base's frame: the trocar

  void validate() const;
};

struct FrameFromPoints {
  Pose base_T_board;
  std::vector<Vector3> residuals;            ///< touched - fitted, in the base's frame [m]
  double rms_m = 0.0;                        ///< of the residuals' lengths
  double spread_m = 0.0;                     ///< conditioning: RMS extent across the best line
  Matrix6 covariance = Matrix6::Identity();  ///< of displacement(estimate, truth): [m, rad], in the base's axes
};

/// Rigid least squares (Kabsch) from points known on the board. touched[i] belongs to board_points[i]; a dot may be
/// touched more than once. CalibrationError: fewer than 3 different dots, collinear, another unit, dots in another
/// order (names the order that fits), a touch that does not fit (names it), the board seen from behind.
FrameFromPoints frame_from_points(const std::vector<Vector3>& touched, const std::vector<Vector3>& board_points,
                                  const FrameFromPointsOptions& options = {});

/// The source document's construction, for comparison: origin in the circumcentre of three touched dots, x to the
/// first, z along (second - first) x (third - first). Uses no known positions. CalibrationError when collinear.
Pose frame_from_three_points(const Vector3& first, const Vector3& second, const Vector3& third);

}  // namespace saras
