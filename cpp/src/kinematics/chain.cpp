#include "saras/kinematics/chain.hpp"

#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <set>
#include <sstream>

#include "saras/spatial/errors.hpp"

namespace saras {
namespace {

KDL::Vector to_kdl(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

KDL::Frame to_kdl(const Pose& pose) {
  const Quaternion& q = pose.rotation;
  return {KDL::Rotation::Quaternion(q.x(), q.y(), q.z(), q.w()), to_kdl(pose.translation)};
}

Pose to_pose(const KDL::Frame& frame) {
  Pose pose;
  frame.M.GetQuaternion(pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.rotation.w());
  pose.rotation.normalize();
  pose.translation = Vector3(frame.p.x(), frame.p.y(), frame.p.z());
  return pose;
}

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  message.precision(12);
  (message << ... << parts);
  throw KinematicsError(message.str());
}

/// As kdl_parser does: the joint's origin and axis in the parent frame, the child frame at the joint.
KDL::Segment to_segment(const Joint& joint) {
  const KDL::Frame origin = to_kdl(joint.parent_T_joint);
  if (joint.type == JointType::kFixed) {
    return KDL::Segment(joint.link, KDL::Joint(joint.name, KDL::Joint::None), origin);
  }
  const auto type = joint.type == JointType::kRevolute ? KDL::Joint::RotAxis : KDL::Joint::TransAxis;
  return KDL::Segment(joint.link, KDL::Joint(joint.name, origin.p, origin.M * to_kdl(joint.axis), type), origin);
}

void check(const std::vector<Joint>& joints) {
  if (joints.empty()) {
    refuse("joints: the chain has none");
  }
  std::set<std::string> names;
  for (const Joint& joint : joints) {
    if (!names.insert(joint.name).second) {
      refuse(joint.name, ": two joints have this name");
    }
    if (!is_valid(joint.parent_T_joint)) {
      refuse(joint.name, ": parent_T_joint is no rigid transform");
    }
    if (joint.type == JointType::kFixed) {
      continue;
    }
    if (!(std::abs(joint.axis.norm() - 1.0) <= 1e-9)) {
      refuse(joint.name, ": axis has norm ", joint.axis.norm(), ": must be 1 within 1e-9");
    }
    if (!(joint.lower <= joint.upper)) {
      refuse(joint.name, ": lower = ", joint.lower, ": must be <= upper = ", joint.upper);
    }
  }
}

}  // namespace

struct Chain::Impl {
  explicit Impl(std::vector<Joint> specification) : joints(std::move(specification)) {
    check(joints);
    for (const Joint& joint : joints) {
      chain.addSegment(to_segment(joint));
      if (joint.type != JointType::kFixed) {
        names.push_back(joint.name);
      }
    }
    const auto n = static_cast<Eigen::Index>(names.size());
    limits.resize(n, 2);
    Eigen::Index i = 0;
    for (const Joint& joint : joints) {
      if (joint.type != JointType::kFixed) {
        limits.row(i++) << joint.lower, joint.upper;
      }
    }
    q.resize(static_cast<unsigned>(n));
    jacobian.resize(static_cast<unsigned>(n));
    position = std::make_unique<KDL::ChainFkSolverPos_recursive>(chain);
    rates = std::make_unique<KDL::ChainJntToJacSolver>(chain);
  }

  void load(const Eigen::Ref<const Eigen::VectorXd>& values) {
    if (values.size() != static_cast<Eigen::Index>(names.size())) {
      refuse("q has ", values.size(), " values: the chain has ", names.size(), " joints");
    }
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) {
        refuse(names[static_cast<std::size_t>(i)], " = ", values[i], ": must be finite");
      }
    }
    q.data = values;
  }

  Pose forward(int segments) {
    KDL::Frame frame;
    position->JntToCart(q, frame, segments);
    return to_pose(frame);
  }

  std::vector<Joint> joints;
  std::vector<std::string> names;
  Eigen::MatrixX2d limits;
  KDL::Chain chain;
  KDL::JntArray q;
  KDL::Jacobian jacobian;
  // The solvers keep references to `chain`: an Impl never moves.
  std::unique_ptr<KDL::ChainFkSolverPos_recursive> position;
  std::unique_ptr<KDL::ChainJntToJacSolver> rates;
};

Chain::Chain(std::vector<Joint> joints) : impl_(std::make_unique<Impl>(std::move(joints))) {}
Chain::Chain(const Chain& other) : impl_(std::make_unique<Impl>(other.impl_->joints)) {}
Chain& Chain::operator=(const Chain& other) {
  if (this != &other) {
    impl_ = std::make_unique<Impl>(other.impl_->joints);
  }
  return *this;
}
Chain::Chain(Chain&&) noexcept = default;
Chain& Chain::operator=(Chain&&) noexcept = default;
Chain::~Chain() = default;

const std::vector<std::string>& Chain::joint_names() const { return impl_->names; }
const Eigen::MatrixX2d& Chain::limits() const { return impl_->limits; }

Pose Chain::forward(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  impl_->load(q);
  return impl_->forward(-1);
}

Pose Chain::forward(const Eigen::Ref<const Eigen::VectorXd>& q, const std::string& link) const {
  impl_->load(q);
  for (std::size_t i = 0; i < impl_->joints.size(); ++i) {
    if (impl_->joints[i].link == link) {
      return impl_->forward(static_cast<int>(i) + 1);
    }
  }
  refuse(link, ": the chain has no link of this name");
}

const Eigen::Matrix<double, 6, Eigen::Dynamic>& Chain::jacobian(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  impl_->load(q);
  impl_->rates->JntToJac(impl_->q, impl_->jacobian);
  return impl_->jacobian.data;
}

void Chain::check_limits(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  impl_->load(q);
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (q[i] < impl_->limits(i, 0) || q[i] > impl_->limits(i, 1)) {
      refuse(impl_->names[static_cast<std::size_t>(i)], " = ", q[i], ": must be in [", impl_->limits(i, 0), ", ",
             impl_->limits(i, 1), "]");
    }
  }
}

}  // namespace saras
