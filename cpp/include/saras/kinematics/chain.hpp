// A serial chain of fixed, revolute and prismatic joints: Orocos KDL behind our types.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "saras/spatial/types.hpp"

namespace saras {

enum class JointType { kFixed, kRevolute, kPrismatic };

/// One joint and the link behind it, as in URDF.
struct Joint {
  std::string name;
  std::string link;  ///< name of the link that the joint moves
  JointType type = JointType::kFixed;
  Pose parent_T_joint;              ///< in the frame of the link before it
  Vector3 axis = Vector3::UnitZ();  ///< unit vector in the joint's frame; unused when fixed
  double lower = 0.0;               ///< [rad] or [m]
  double upper = 0.0;               ///< [rad] or [m]
};

/// Joint vectors hold the moving joints only, in chain order. Scratch memory is shared by the calls of one
/// object: use one Chain a thread (copies are independent).
class Chain {
 public:
  /// Throws KinematicsError for an empty chain, a repeated name, an axis that is not unit, lower > upper.
  explicit Chain(std::vector<Joint> joints);
  Chain(const Chain& other);
  Chain& operator=(const Chain& other);
  Chain(Chain&&) noexcept;
  Chain& operator=(Chain&&) noexcept;
  ~Chain();

  const std::vector<std::string>& joint_names() const;
  /// (n, 2): lower and upper bound of each moving joint [rad or m].
  const Eigen::MatrixX2d& limits() const;
  Eigen::Index size() const { return limits().rows(); }

  /// base_T_link of the last link. Throws KinematicsError naming a wrong length or the joint that is not
  /// finite; limits are not checked. Allocates nothing.
  Pose forward(const Eigen::Ref<const Eigen::VectorXd>& q) const;
  /// base_T_link of a named link. Allocates nothing.
  Pose forward(const Eigen::Ref<const Eigen::VectorXd>& q, const std::string& link) const;
  /// 6 x n: twist of the last link's origin in the base frame, linear first, from joint rates. Allocates nothing;
  /// the reference holds until the next call.
  const Eigen::Matrix<double, 6, Eigen::Dynamic>& jacobian(const Eigen::Ref<const Eigen::VectorXd>& q) const;
  /// Throws KinematicsError naming the first joint beyond its limits, its value and the bounds.
  void check_limits(const Eigen::Ref<const Eigen::VectorXd>& q) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saras
