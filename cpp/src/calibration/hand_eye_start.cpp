// A linear solution to start from: rotation by Kabsch on rotation vectors (Park and Martin 1994), then translation.
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <limits>

#include "hand_eye_parts.hpp"
#include "saras/spatial/rotation.hpp"

namespace saras::hand_eye_parts {
namespace {

constexpr std::size_t kTriples = 80;

/// gripper_T_camera from the relative motions of the pairs with these indices.
Pose linear_solution(const std::vector<Pose>& moving, const std::vector<Pose>& camera,
                     const std::vector<std::size_t>& indices) {
  const std::size_t motions = indices.size() * (indices.size() - 1) / 2;
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  std::vector<Pose> gripper_motion;
  std::vector<Pose> camera_motion;
  gripper_motion.reserve(motions);
  camera_motion.reserve(motions);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::size_t a = indices[i];
      const std::size_t b = indices[j];
      gripper_motion.push_back(moving[b].inverse() * moving[a]);
      camera_motion.push_back(camera[b] * camera[a].inverse());
      correlation +=
          rotation_log(gripper_motion.back().rotation) * rotation_log(camera_motion.back().rotation).transpose();
    }
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  sign(2, 2) = svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
  Pose solution;
  solution.rotation = Quaternion(svd.matrixU() * sign * svd.matrixV().transpose()).normalized();
  Eigen::MatrixXd left(3 * gripper_motion.size(), 3);
  Eigen::VectorXd right(3 * gripper_motion.size());
  for (std::size_t i = 0; i < gripper_motion.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    left.middleRows<3>(row) = gripper_motion[i].rotation.toRotationMatrix() - Eigen::Matrix3d::Identity();
    right.segment<3>(row) = solution.rotation * camera_motion[i].translation - gripper_motion[i].translation;
  }
  solution.translation = left.colPivHouseholderQr().solve(right);
  return solution;
}

/// The target's pose among those that the pairs say which leaves the least median of squares; gives that median.
double best_target(const std::vector<HandEyePair>& pairs, const std::vector<std::size_t>& candidates,
                   const HandEyeOptions& options, Estimate& estimate) {
  double best = std::numeric_limits<double>::infinity();
  Pose found;
  std::vector<double> squares(pairs.size());
  for (const std::size_t i : candidates) {
    estimate.base_T_target = target_of(pairs[i], estimate, options.eye_to_hand);
    const NoiseParts parts = noise_parts(pairs[i], estimate, options);
    const Matrix6 weight = (parts.rotation + parts.translation).inverse();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Vector6 residual = residual_of(pairs[k], estimate, options.eye_to_hand);
      squares[k] = residual.dot(weight * residual);
    }
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::nth_element(squares.begin(), middle, squares.end());
    if (*middle < best) {
      best = *middle;
      found = estimate.base_T_target;
    }
  }
  estimate.base_T_target = found;
  return best;
}

/// Repeatable draws without a global: the numerical recipes' 64-bit generator.
class Draws {
 public:
  std::size_t below(std::size_t n) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state_ >> 33U) % n);
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace

Estimate start(const std::vector<HandEyePair>& pairs, const HandEyeOptions& options,
               const std::optional<Pose>& initial) {
  std::vector<Pose> moving;
  std::vector<Pose> camera;
  for (const auto& pair : pairs) {
    moving.push_back(moving_pose(pair, 0.0, options.eye_to_hand));
    camera.push_back(pair.camera_T_target);
  }
  // Streams have hundreds of pairs: the relative motions of a few dozen are start enough.
  std::vector<std::size_t> all;
  const std::size_t step = 1 + pairs.size() / 40;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    all.push_back(i);
  }
  Estimate best;
  best.gripper_T_camera = initial ? *initial : linear_solution(moving, camera, all);
  double least = best_target(pairs, all, options, best);
  if (initial || !options.robust || pairs.size() < 5) {
    return best;
  }
  Draws draws;
  for (std::size_t trial = 0; trial < kTriples; ++trial) {
    std::vector<std::size_t> triple;
    while (triple.size() < 3) {
      const std::size_t i = draws.below(pairs.size());
      if (std::find(triple.begin(), triple.end(), i) == triple.end()) {
        triple.push_back(i);
      }
    }
    Estimate candidate;
    candidate.gripper_T_camera = linear_solution(moving, camera, triple);
    if (!is_valid(candidate.gripper_T_camera)) {
      continue;
    }
    const double median = best_target(pairs, triple, options, candidate);
    if (median < least) {
      least = median;
      best = candidate;
    }
  }
  return best;
}

}  // namespace saras::hand_eye_parts
