#include "camera_file.hpp"

#include <camera_calibration_parsers/parse.h>
#include <sensor_msgs/distortion_models.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

constexpr std::uint32_t kMaxSide_px = 16384;
constexpr double kRotationTolerance = 1e-6;

template <typename Numbers>
void finite(const std::string& path, const char* entry, const Numbers& numbers) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double value) { return std::isfinite(value); })) {
    throw saras::ConfigError(path + ": " + entry + ": must hold finite numbers");
  }
}

void side(const std::string& path, const char* entry, std::uint32_t size_px) {
  if (size_px < 1 || size_px > kMaxSide_px) {
    throw saras::ConfigError(path + ": " + entry + " = " + std::to_string(size_px) + ": must be in [1, " +
                             std::to_string(kMaxSide_px) + "]");
  }
}

}  // namespace

sensor_msgs::CameraInfo read_camera_file(const std::string& path) {
  if (!std::ifstream(path)) {
    throw saras::ConfigError(path + ": " + std::strerror(errno));
  }
  std::string name;
  sensor_msgs::CameraInfo info;
  if (!camera_calibration_parsers::readCalibration(path, name, info)) {
    throw saras::ConfigError(path + ": no camera_info in it: must be YAML as saras calibrate camera writes it");
  }
  side(path, "image_width", info.width);
  side(path, "image_height", info.height);
  if (info.distortion_model != sensor_msgs::distortion_models::PLUMB_BOB || info.D.size() != 5) {
    throw saras::ConfigError(path + ": distortion_model = '" + info.distortion_model + "' with " +
                             std::to_string(info.D.size()) + " coefficients: must be plumb_bob with 5");
  }
  finite(path, "distortion_coefficients", info.D);
  finite(path, "camera_matrix", info.K);
  finite(path, "rectification_matrix", info.R);
  finite(path, "projection_matrix", info.P);
  if (!(info.K[0] > 0.0 && info.K[4] > 0.0 && info.P[0] > 0.0)) {
    throw saras::ConfigError(path + ": camera_matrix, projection_matrix: focal lengths must be > 0: not calibrated");
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(info.R.data());
  const double off = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off < kRotationTolerance) || R.determinant() < 0.0) {
    throw saras::ConfigError(path + ": rectification_matrix: must be a rotation (off by " + std::to_string(off) + ")");
  }
  return info;
}

}  // namespace saras_ros1
