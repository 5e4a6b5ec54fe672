#include "hand_eye_visp.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <visp3/core/vpException.h>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vision/vpHandEyeCalibration.h>

#include <cstdio>
#include <iostream>
#include <sstream>
#include <stdexcept>

namespace saras {
namespace {

/// ViSP prints its residuals to standard output, past std::cout too; a library must not.
class QuietOutput {
 public:
  QuietOutput() : cout_(std::cout.rdbuf(swallowed_.rdbuf())) {
    std::fflush(stdout);
    before_ = ::dup(STDOUT_FILENO);
    const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nothing >= 0) {
      ::dup2(nothing, STDOUT_FILENO);
      ::close(nothing);
    }
  }
  ~QuietOutput() {
    std::fflush(stdout);
    if (before_ >= 0) {
      ::dup2(before_, STDOUT_FILENO);
      ::close(before_);
    }
    std::cout.rdbuf(cout_);
  }
  QuietOutput(const QuietOutput&) = delete;
  QuietOutput& operator=(const QuietOutput&) = delete;

 private:
  std::ostringstream swallowed_;
  std::streambuf* cout_;
  int before_ = -1;
};

vpHomogeneousMatrix to_visp(const Eigen::Matrix4d& pose) {
  vpHomogeneousMatrix matrix;
  for (unsigned int row = 0; row < 4; ++row) {
    for (unsigned int column = 0; column < 4; ++column) {
      matrix[row][column] = pose(row, column);
    }
  }
  return matrix;
}

}  // namespace

Eigen::Matrix4d hand_eye_visp(const std::vector<Eigen::Matrix4d>& base_T_gripper,
                              const std::vector<Eigen::Matrix4d>& camera_T_target) {
  std::vector<vpHomogeneousMatrix> gripper;
  std::vector<vpHomogeneousMatrix> target;
  for (const auto& pose : base_T_gripper) {
    gripper.push_back(to_visp(pose));
  }
  for (const auto& pose : camera_T_target) {
    target.push_back(to_visp(pose));
  }
  vpHomogeneousMatrix solution;
  try {
    const QuietOutput quiet;
    // 0: good. 1: its last step, the non-linear one, did not converge; the solution is the linear one then.
    vpHandEyeCalibration::calibrate(target, gripper, solution);
  } catch (const vpException& error) {
    throw std::invalid_argument(std::string("ViSP: ") + error.getMessage());
  }
  Eigen::Matrix4d pose;
  for (unsigned int row = 0; row < 4; ++row) {
    for (unsigned int column = 0; column < 4; ++column) {
      pose(row, column) = solution[row][column];
    }
  }
  return pose;
}

}  // namespace saras
