// From points in space to pixels of one eye of a stereo endoscope, on rectified and on raw images.
//
// Points are given in the rectified *left* optical frame for both eyes; the last column of the right P holds the
// baseline. With P = [K' | p4] and t = K'^-1 p4, the point in the rectified frame of this eye is p + t. A rectified
// image is the pinhole K' of it. A raw image is K and the lens's distortion of R^T (p + t). P never goes on raw images.
#pragma once

#include <array>
#include <cstdint>

#include "saras/spatial/types.hpp"

namespace saras {

using Pixel = Eigen::Vector2d;  ///< column, row; (0, 0) is the centre of the first pixel
using Matrix3 = Eigen::Matrix3d;
using Matrix34 = Eigen::Matrix<double, 3, 4>;

/// What sensor_msgs/CameraInfo and OpenCV call a calibrated camera.
struct CameraConfig {
  int width_px = 0;
  int height_px = 0;
  Matrix3 K = Matrix3::Identity();    ///< of the raw image [px], without skew
  Matrix3 R = Matrix3::Identity();    ///< rectified_R_raw
  Matrix34 P = Matrix34::Identity();  ///< of the rectified image; p4 of the right eye = -f' baseline [px m]
  /// k1 k2 p1 p2 k3 (plumb_bob), then k4 k5 k6 (rational_polynomial); zeros: none.
  std::array<double, 8> distortion = {};
  bool rectified = false;  ///< what is drawn on: the rectified image, or the raw one
  double near_m = 0.005;   ///< nothing is drawn that is closer to the eye than this, > 0
  void validate() const;   ///< throws ConfigError
};

/// A visible stretch of a line, straight within `kStraightTolerance_px`. Between its ends the inverse depth is linear.
struct LinePiece {
  Pixel a = Pixel::Zero();
  Pixel b = Pixel::Zero();
  double depth_a_m = 0.0;  ///< along the eye's optical axis
  double depth_b_m = 0.0;
};
inline constexpr double kStraightTolerance_px = 0.1;
inline constexpr int kMaxLinePieces = 64;

struct ProjectedLine {
  std::array<LinePiece, kMaxLinePieces> pieces;
  int count = 0;
};

/// One eye. Immutable; nothing allocates or throws but the constructor.
class PinholeEye {
 public:
  /// Throws ConfigError.
  explicit PinholeEye(const CameraConfig& config);

  /// False, and pixel as it was: not finite, nearer than near_m, behind, or where the lens model no longer holds. The
  /// pixel may lie outside of the image.
  bool project(const Vector3& point, Pixel& pixel) const noexcept;
  /// Along this eye's optical axis [m]; negative: behind.
  double depth(const Vector3& point) const noexcept { return to_eye(point).z(); }
  /// What is seen of the segment a - b: beyond the near plane, where the lens model holds, and not further outside of
  /// the image than margin_px. Nothing for ends that are not finite.
  ProjectedLine project_line(const Vector3& a, const Vector3& b, double margin_px = 0.0) const noexcept;

  const CameraConfig& config() const { return config_; }
  /// Pixels per metre at a depth of one metre, the mean of both directions.
  double focal_px() const { return 0.5 * (fx_ + fy_); }

 private:
  using Normalised = Eigen::Vector2d;  // x/z, y/z

  Vector3 to_eye(const Vector3& point) const noexcept { return eye_R_left_ * (point + shift_); }
  Normalised distorted(const Normalised& straight) const noexcept;
  Pixel pixel(const Normalised& straight) const noexcept;
  double radial(double r2) const noexcept;
  void find_field();
  void bend(const Vector3& a, const Vector3& b, double margin_px, ProjectedLine& line) const noexcept;
  void clip_and_add(LinePiece piece, double margin_px, ProjectedLine& line) const noexcept;

  CameraConfig config_;
  Matrix3 eye_R_left_ = Matrix3::Identity();
  Vector3 shift_ = Vector3::Zero();
  double fx_ = 1.0, fy_ = 1.0, cx_ = 0.0, cy_ = 0.0;
  bool bends_ = false;         // the image is raw and the lens distorts
  double field_radius_ = 0.0;  // greatest x/z, y/z radius that the lens model is asked about
};

/// Shortens the segment a - b in the plane to the rectangle; false: nothing of it is inside (Liang and Barsky 1984).
/// from and to: the shares of a - b where what is left begins and ends.
bool clip_to_rectangle(const Pixel& a, const Pixel& b, const Pixel& low, const Pixel& high, double& from,
                       double& to) noexcept;

}  // namespace saras
