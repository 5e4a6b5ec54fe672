// ViSP's hand-eye solver behind Eigen's types. GPL-2.0-or-later, as ViSP is.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace saras {

/// gripper_T_camera from base_T_gripper and camera_T_target. std::invalid_argument when ViSP refuses the poses.
Eigen::Matrix4d hand_eye_visp(const std::vector<Eigen::Matrix4d>& base_T_gripper,
                              const std::vector<Eigen::Matrix4d>& camera_T_target);

}  // namespace saras
