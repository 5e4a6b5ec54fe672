#include "saras/calibration/hand_eye.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>

#include "hand_eye_parts.hpp"
#include "saras/calibration/calibration_error.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

using hand_eye_parts::Estimate;
using hand_eye_parts::Jacobian;
using hand_eye_parts::kParameters;
using hand_eye_parts::Levels;
using hand_eye_parts::NoiseParts;

constexpr double kDegree = 0.017453292519943295;
/// Whitened squares of six normal values: one good pair in ten thousand lies beyond the gate.
constexpr double kGate = 27.86;
constexpr double kMedianOfSix = 5.348;
constexpr double kLeastGroups = 4;
constexpr int kRounds = 8;
/// Fewer pairs than this cannot tell which of them is wrong.
constexpr std::size_t kFewestToLeaveOut = 5;

[[noreturn]] void refuse(const std::string& text) { throw CalibrationError(text); }

std::string number(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value;
  return out.str();
}

std::string degrees(double angle_rad) { return number(angle_rad / kDegree) + " deg"; }

void check_pair(const HandEyePair& pair, std::size_t i, double max_distance_m) {
  const std::string where = "pair " + std::to_string(i + 1) + ": ";
  if (!is_valid(pair.base_T_gripper) || !is_valid(pair.camera_T_target) || !is_finite(pair.gripper_twist)) {
    refuse(where + "base_T_gripper and camera_T_target must be finite rigid transforms");
  }
  const double robot_m = pair.base_T_gripper.translation.norm();
  const double camera_m = pair.camera_T_target.translation.norm();
  if (robot_m > max_distance_m || camera_m > max_distance_m) {
    refuse(where + (robot_m > max_distance_m ? "|base_T_gripper|" : "|camera_T_target|") + " = " +
           number(std::max(robot_m, camera_m)) + " m: must be <= " + number(max_distance_m) +
           " (are these millimetres?)");
  }
}

void check_repeats(const std::vector<HandEyePair>& pairs, const HandEyeNoise& noise) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Twist apart = displacement(pairs[j].base_T_gripper, pairs[i].base_T_gripper);
      if (apart.linear.norm() < 3.0 * noise.robot_translation_m &&
          apart.angular.norm() < 3.0 * noise.robot_rotation_rad) {
        refuse("pairs " + std::to_string(j + 1) + " and " + std::to_string(i + 1) + ": the same robot pose twice (" +
               number(1e3 * apart.linear.norm()) + " mm, " + degrees(apart.angular.norm()) +
               " apart): must differ; rotation spread = " + degrees(rotation_spread(pairs)[1]));
      }
    }
  }
}

void check_spread(const std::vector<HandEyePair>& pairs, double min_spread_rad) {
  const Vector3 spread = rotation_spread(pairs);
  if (spread[0] < min_spread_rad) {
    refuse("rotation spread = " + degrees(spread[0]) + ": must be >= " + degrees(min_spread_rad) +
           " about two different axes: turn the gripper between the poses");
  }
  if (spread[1] < min_spread_rad) {
    refuse("rotation spread = " + degrees(spread[0]) + " about one axis, " + degrees(spread[1]) +
           " about others: must be >= " + degrees(min_spread_rad) + " (parallel axes: turn about another one as well)");
  }
}

void check(const std::vector<HandEyePair>& pairs, const HandEyeOptions& options) {
  if (pairs.size() < 3) {
    refuse("pairs = " + std::to_string(pairs.size()) +
           ": must be >= 3; rotation spread = " + degrees(pairs.empty() ? 0.0 : rotation_spread(pairs)[1]));
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    check_pair(pairs[i], i, options.max_distance_m);
  }
  if (!options.allow_repeats) {
    check_repeats(pairs, options.noise);
  }
  check_spread(pairs, options.min_spread_rad);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// All that follows from an estimate and levels of noise.
class Fit {
 public:
  Fit(const std::vector<HandEyePair>& pairs, const HandEyeOptions& options, const Estimate& first)
      : pairs_(pairs), options_(options), estimate_(first), used_(pairs.size(), true) {}

  void run() {
    linearise();
    if (options_.robust && pairs_.size() >= kFewestToLeaveOut) {
      for (int round = 0; round < 3; ++round) {  // start and Cauchy's loss: scale by the median, which outliers leave
        const double scale = std::max(1e-6, median(squares()) / kMedianOfSix);
        levels_ = {levels_.rotation * scale, levels_.translation * scale};
        estimate_ = hand_eye_parts::solve(pairs_, used_, estimate_, covariances(), options_, true);
        linearise();
      }
      levels_ = scaled_by_median();
      gate();
    }
    for (int round = 0; round < kRounds; ++round) {
      const Levels before = levels_;
      estimate_ = hand_eye_parts::solve(pairs_, used_, estimate_, covariances(), options_, false);
      linearise();
      levels_ = hand_eye_parts::next_levels(residuals_, jacobians_, parts_, used_, levels_, options_.time_offset);
      const bool same = options_.robust && pairs_.size() >= kFewestToLeaveOut ? gate() : true;
      const double change = std::abs(std::log(levels_.rotation / before.rotation)) +
                            std::abs(std::log(levels_.translation / before.translation));
      if (same && change < 1e-3) {
        break;
      }
    }
  }

  HandEye result() const {
    HandEye out;
    out.gripper_T_camera = estimate_.gripper_T_camera;
    out.base_T_target = estimate_.base_T_target;
    out.time_offset_s = estimate_.time_offset_s;
    out.residuals = residuals_;
    out.used = used_;
    out.rotation_noise = std::sqrt(levels_.rotation);
    out.translation_noise = std::sqrt(levels_.translation);
    double squares_m = 0.0;
    double squares_rad = 0.0;
    for (std::size_t i = 0; i < used_.size(); ++i) {
      squares_m += used_[i] ? residuals_[i].head<3>().squaredNorm() : 0.0;
      squares_rad += used_[i] ? residuals_[i].tail<3>().squaredNorm() : 0.0;
    }
    const auto count = static_cast<double>(std::count(used_.begin(), used_.end(), true));
    out.rms_m = std::sqrt(squares_m / count);
    out.rms_rad = std::sqrt(squares_rad / count);
    const auto covariance =
        hand_eye_parts::parameter_covariance(pairs_, residuals_, jacobians_, covariances(), used_, options_);
    out.covariance = covariance.topLeftCorner<6, 6>();
    out.target_covariance = covariance.block<6, 6>(6, 6);
    out.time_offset_std_s =
        options_.time_offset ? std::sqrt(std::max(0.0, covariance(kParameters - 1, kParameters - 1))) : 0.0;
    return out;
  }

 private:
  void linearise() {
    residuals_.clear();
    jacobians_.clear();
    parts_.clear();
    for (const auto& pair : pairs_) {
      residuals_.push_back(hand_eye_parts::residual_of(pair, estimate_, options_.eye_to_hand));
      jacobians_.push_back(hand_eye_parts::jacobian_of(pair, estimate_, options_));
      parts_.push_back(hand_eye_parts::noise_parts(pair, estimate_, options_));
    }
  }

  std::vector<Matrix6> covariances() const {
    std::vector<Matrix6> all;
    for (const auto& part : parts_) {
      all.emplace_back(levels_.rotation * part.rotation + levels_.translation * part.translation);
    }
    return all;
  }

  std::vector<double> squares() const {
    std::vector<double> all;
    const auto v = covariances();
    for (std::size_t i = 0; i < v.size(); ++i) {
      all.push_back(residuals_[i].dot(v[i].ldlt().solve(residuals_[i])));
    }
    return all;
  }

  Levels scaled_by_median() const {
    const double scale = std::max(1e-6, median(squares()) / kMedianOfSix);
    return {levels_.rotation * scale, levels_.translation * scale};
  }

  /// Marks gross errors anew; true when nothing changed.
  bool gate() {
    const auto all = squares();
    bool same = true;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool good = all[i] <= kGate;
      same = same && good == used_[i];
      used_[i] = good;
    }
    std::vector<HandEyePair> rest;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (used_[i]) {
        rest.push_back(pairs_[i]);
      }
    }
    if (rest.size() < 3 || 2 * rest.size() <= pairs_.size()) {
      refuse("pairs that agree on one mounting = " + std::to_string(rest.size()) + " of " +
             std::to_string(pairs_.size()) + ": must be >= 3 and more than half");
    }
    check_spread(rest, options_.min_spread_rad);
    return same;
  }

  const std::vector<HandEyePair>& pairs_;
  const HandEyeOptions& options_;
  Estimate estimate_;
  Levels levels_;
  std::vector<bool> used_;
  std::vector<Vector6> residuals_;
  std::vector<Jacobian> jacobians_;
  std::vector<NoiseParts> parts_;
};

void check_groups(const std::vector<HandEyePair>& pairs) {
  std::set<int> groups;
  for (const auto& pair : pairs) {
    groups.insert(pair.group);
  }
  if (static_cast<double>(groups.size()) < kLeastGroups) {
    throw ConfigError("groups = " + std::to_string(groups.size()) + ": must be >= " + number(kLeastGroups));
  }
}

}  // namespace

void HandEyeOptions::validate() const {
  validate::positive("noise.robot_rotation_rad", noise.robot_rotation_rad);
  validate::positive("noise.robot_translation_m", noise.robot_translation_m);
  validate::positive("noise.camera_rotation_rad", noise.camera_rotation_rad);
  validate::positive("noise.camera_translation_m", noise.camera_translation_m);
  validate::positive("min_spread_rad", min_spread_rad);
  validate::positive("max_distance_m", max_distance_m);
  validate::positive("max_rms_m", max_rms_m);
  validate::positive("max_rms_rad", max_rms_rad);
}

Vector3 rotation_spread(const std::vector<HandEyePair>& pairs) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  double motions = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3 turn =
          rotation_log(pairs[j].base_T_gripper.rotation.conjugate() * pairs[i].base_T_gripper.rotation);
      scatter += turn * turn.transpose();
      motions += 1.0;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter / std::max(1.0, motions));
  return axes.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
}

HandEye hand_eye(const std::vector<HandEyePair>& pairs, const HandEyeOptions& options,
                 const std::optional<Pose>& initial) {
  options.validate();
  check(pairs, options);
  if (options.grouped) {
    check_groups(pairs);
  }
  if (initial) {
    validate::pose("initial", *initial);
  }
  Fit fit(pairs, options, hand_eye_parts::start(pairs, options, initial));
  fit.run();
  HandEye result = fit.result();
  result.spread_rad = rotation_spread(pairs)[1];
  if (!(result.rms_m <= options.max_rms_m) || !(result.rms_rad <= options.max_rms_rad)) {
    refuse("the pairs fit no rigid mounting: they disagree about the target by " + number(1e3 * result.rms_m) +
           " mm (must be <= " + number(1e3 * options.max_rms_m) + ") and " + degrees(result.rms_rad) +
           " (must be <= " + degrees(options.max_rms_rad) +
           ") rms: wrong pairing, a transform given the wrong way round, another unit, or a target that moved");
  }
  return result;
}

}  // namespace saras
