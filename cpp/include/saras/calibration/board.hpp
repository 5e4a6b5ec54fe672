// The calibration board ("positioner"): dots on a circle for the arms to touch, ArUco markers for the endoscope.
//
// Frame of the board: origin in the circle's centre, x to the dot at 0 degrees, y to 90 degrees, z out of the print.
#pragma once

#include <array>
#include <vector>

#include "saras/spatial/types.hpp"

namespace saras {

struct BoardConfig {
  double dot_circle_radius_m = 0.100;  ///< circle of the dots' centres
  double dot_diameter_m = 0.005;
  std::vector<double> dot_angles_deg = {0.0, 40.0, 100.0, 170.0, 250.0, 320.0};  ///< uneven: a wrong order shows
  double marker_circle_radius_m = 0.060;                                         ///< circle of the markers' centres
  double marker_side_m = 0.025;                                                  ///< edge of the black square
  std::vector<double> marker_angles_deg = {45.0, 135.0, 225.0, 315.0};

  /// At least three dots, increasing angles whose order no turn or flip repeats; nothing overlaps. ConfigError.
  void validate() const;
};

/// Centres of the dots in the board's frame, z = 0 [m].
std::vector<Vector3> dot_centers(const BoardConfig& config);

/// Corners of each marker in the board's frame [m]: upper left, upper right, lower right, lower left of its print,
/// as ArUco detectors give them. The marker's upper edge is towards the board's +y.
std::vector<std::array<Vector3, 4>> marker_corners(const BoardConfig& config);

}  // namespace saras
