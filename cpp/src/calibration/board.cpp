#include "saras/calibration/board.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
/// Angles between neighbours must differ by this much from those after any turn or flip.
constexpr double kLeastUnevenness_deg = 5.0;

Vector3 on_circle(double radius_m, double angle_deg) {
  return {radius_m * std::cos(angle_deg * kDegree), radius_m * std::sin(angle_deg * kDegree), 0.0};
}

void check_angles(const char* field, const std::vector<double>& angles_deg) {
  for (std::size_t i = 0; i < angles_deg.size(); ++i) {
    const std::string name = std::string(field) + "[" + std::to_string(i) + "]";
    validate::in_range(name.c_str(), angles_deg[i], 0.0, 360.0 - 1e-9);
    if (i > 0) {
      validate::less((std::string(field) + "[" + std::to_string(i - 1) + "]").c_str(), angles_deg[i - 1], name.c_str(),
                     angles_deg[i]);
    }
  }
}

/// Least over all turns of the ring of gaps of the largest difference to the gaps themselves [deg].
double unevenness(const std::vector<double>& angles_deg) {
  const std::size_t n = angles_deg.size();
  std::vector<double> gaps(n);
  for (std::size_t i = 0; i < n; ++i) {
    gaps[i] = i + 1 < n ? angles_deg[i + 1] - angles_deg[i] : angles_deg[0] + 360.0 - angles_deg[i];
  }
  double least = 360.0;
  for (std::size_t turn = 0; turn < n; ++turn) {
    for (const bool flipped : {false, true}) {
      if (turn == 0 && !flipped) {
        continue;
      }
      double largest = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        const double other = flipped ? gaps[(turn + n - i) % n] : gaps[(turn + i) % n];
        largest = std::max(largest, std::abs(other - gaps[i]));
      }
      least = std::min(least, largest);
    }
  }
  return least;
}

}  // namespace

void BoardConfig::validate() const {
  validate::positive("dot_circle_radius_m", dot_circle_radius_m);
  validate::positive("dot_diameter_m", dot_diameter_m);
  validate::positive("marker_circle_radius_m", marker_circle_radius_m);
  validate::positive("marker_side_m", marker_side_m);
  check_angles("dot_angles_deg", dot_angles_deg);
  check_angles("marker_angles_deg", marker_angles_deg);
  validate::in_range("dot_angles_deg (count)", static_cast<double>(dot_angles_deg.size()), 3, 12);
  validate::in_range("marker_angles_deg (count)", static_cast<double>(marker_angles_deg.size()), 1, 8);
  const double uneven_deg = unevenness(dot_angles_deg);
  if (uneven_deg < kLeastUnevenness_deg) {
    std::ostringstream text;
    text << "dot_angles_deg: another order of the dots fits within " << uneven_deg << " degrees: must differ by "
         << kLeastUnevenness_deg << " at least";
    throw ConfigError(text.str());
  }
  const double half_diagonal_m = marker_side_m / std::sqrt(2.0);
  const double apart_m = std::abs(dot_circle_radius_m - marker_circle_radius_m);
  validate::less("dot_diameter_m / 2 + marker_side_m / sqrt(2)", 0.5 * dot_diameter_m + half_diagonal_m,
                 "distance of the circles", apart_m);
}

std::vector<Vector3> dot_centers(const BoardConfig& config) {
  std::vector<Vector3> centers;
  for (const double angle_deg : config.dot_angles_deg) {
    centers.push_back(on_circle(config.dot_circle_radius_m, angle_deg));
  }
  return centers;
}

std::vector<std::array<Vector3, 4>> marker_corners(const BoardConfig& config) {
  const double h = 0.5 * config.marker_side_m;
  std::vector<std::array<Vector3, 4>> markers;
  for (const double angle_deg : config.marker_angles_deg) {
    const Vector3 c = on_circle(config.marker_circle_radius_m, angle_deg);
    markers.push_back(
        {c + Vector3(-h, h, 0.0), c + Vector3(h, h, 0.0), c + Vector3(h, -h, 0.0), c + Vector3(-h, -h, 0.0)});
  }
  return markers;
}

}  // namespace saras
