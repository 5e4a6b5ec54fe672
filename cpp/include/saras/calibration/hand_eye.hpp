// Where a camera sits on a robot's gripper (or in its base), from poses of both: A X = X B, by maximum likelihood.
//
// Model: base_T_gripper * gripper_T_camera * camera_T_target = base_T_target, for each pair. Robot and camera poses
// both have isotropic errors, each about the origin of its own body; a rotation error of the gripper moves the target
// by its lever, so rotation and translation are weighted together. Gross errors are found by a robust loss and a
// chi-squared gate, and left out; the levels of noise of rotation and translation are estimated from what remains
// (restricted maximum likelihood), so the covariance does not depend on knowing them.
#pragma once

#include <optional>
#include <vector>

#include "saras/spatial/types.hpp"

namespace saras {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// One station. Eye-to-hand too: the camera then stands in the base and the target is on the gripper.
struct HandEyePair {
  Pose base_T_gripper;
  Pose camera_T_target;
  Twist gripper_twist;  ///< of the gripper in the base's axes; only for the time offset of recorded streams
  int group = 0;        ///< stations whose errors belong together (neighbours in a stream), see HandEyeOptions::grouped
};

/// Expected errors per axis. Their ratios weigh; two common factors (rotation, translation) are estimated.
struct HandEyeNoise {
  double robot_rotation_rad = 0.05 * 0.017453292519943295;
  double robot_translation_m = 0.1e-3;
  double camera_rotation_rad = 0.1 * 0.017453292519943295;
  double camera_translation_m = 0.3e-3;
};

struct HandEyeOptions {
  HandEyeNoise noise;
  bool eye_to_hand = false;       ///< the result is base_T_camera and gripper_T_target
  bool robust = true;             ///< leave out gross errors; false: every pair counts
  bool allow_repeats = false;     ///< streams rest sometimes; stations must differ
  bool time_offset = false;       ///< also: gripper poses are those of `camera stamp + offset`, from gripper_twist
  bool grouped = false;           ///< covariance from the spread between groups instead of from independent errors
  double min_spread_rad = 0.035;  ///< refused below: second largest RMS extent of the relative rotation vectors
  double max_distance_m = 5.0;    ///< refused above: any translation (millimetres for metres)
  double max_rms_m = 0.02;        ///< refused above: disagreement of the pairs about the target's place
  double max_rms_rad = 0.1;

  void validate() const;
};

struct HandEye {
  Pose gripper_T_camera;  ///< base_T_camera for eye-to-hand
  Pose base_T_target;     ///< gripper_T_target for eye-to-hand
  /// Of displacement(estimate, truth) of gripper_T_camera: [m, rad], in the gripper's (base's) axes.
  Matrix6 covariance = Matrix6::Zero();
  Matrix6 target_covariance = Matrix6::Zero();  ///< the same of base_T_target
  std::vector<Vector6> residuals;  ///< displacement(base_T_target, what each pair says): [m, rad], all pairs
  std::vector<bool> used;          ///< false: gross error, left out
  double rms_m = 0.0;              ///< of the used residuals' lengths
  double rms_rad = 0.0;
  double rotation_noise = 1.0;  ///< estimated noise, times what was expected
  double translation_noise = 1.0;
  double spread_rad = 0.0;     ///< conditioning, see min_spread_rad
  double time_offset_s = 0.0;  ///< correction to the offset that the given gripper poses already have
  double time_offset_std_s = 0.0;
};

/// CalibrationError: fewer than 3 pairs, repeats, too little or parallel rotation (with the spread), implausible
/// units, pairs that fit no rigid mounting.
HandEye hand_eye(const std::vector<HandEyePair>& pairs, const HandEyeOptions& options = {},
                 const std::optional<Pose>& initial = std::nullopt);

/// Root mean square extents [rad] along the principal axes of all relative rotation vectors, largest first.
Vector3 rotation_spread(const std::vector<HandEyePair>& pairs);

}  // namespace saras
