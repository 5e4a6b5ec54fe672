#include "saras/csa/master_mlc.hpp"

#include <algorithm>
#include <cmath>
#include <kdl/chaindynparam.hpp>
#include <string>

#include "saras/spatial/errors.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::csa {
namespace {

KDL::Vector to_kdl(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

KDL::Frame to_kdl(const Pose& pose) {
  const Quaternion& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x(), r.y(), r.z(), r.w()), to_kdl(pose.translation)};
}

KDL::Segment segment(const Joint& joint, const LinkMass& mass) {
  const KDL::RigidBodyInertia inertia(mass.mass_kg, to_kdl(mass.centre_m));
  const KDL::Frame frame = to_kdl(joint.parent_T_joint);
  if (joint.type == JointType::kFixed) {
    return KDL::Segment(joint.link, KDL::Joint(joint.name, KDL::Joint::None), frame, inertia);
  }
  const auto type = joint.type == JointType::kRevolute ? KDL::Joint::RotAxis : KDL::Joint::TransAxis;
  return KDL::Segment(joint.link, KDL::Joint(joint.name, frame.p, frame.M * to_kdl(joint.axis), type), frame, inertia);
}

}  // namespace

struct GravityModel::Impl {
  KDL::Chain chain;
  Vector3 gravity;
  KDL::ChainDynParam dynamics;
  KDL::JntArray q;
  KDL::JntArray torque;

  Impl(const KDL::Chain& segments, const Vector3& acceleration)
      : chain(segments),
        gravity(acceleration),
        dynamics(chain, to_kdl(acceleration)),
        q(chain.getNrOfJoints()),
        torque(chain.getNrOfJoints()) {}
};

GravityModel::GravityModel(const std::vector<Joint>& joints, const std::vector<LinkMass>& masses,
                           const Vector3& gravity) {
  const Chain checked(joints);  // refuses what is no chain
  if (masses.size() != joints.size()) {
    throw ConfigError("masses: count = " + std::to_string(masses.size()) + ": must be " +
                      std::to_string(joints.size()) + ", one a joint");
  }
  if (checked.size() > kMaxJoints) {
    throw ConfigError("joints: count = " + std::to_string(checked.size()) + ": must be at most " +
                      std::to_string(kMaxJoints));
  }
  validate::finite("gravity", gravity);
  KDL::Chain chain;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::string name = "masses[" + std::to_string(i) + "]";
    validate::not_negative((name + ".mass_kg").c_str(), masses[i].mass_kg);
    validate::finite((name + ".centre_m").c_str(), masses[i].centre_m);
    chain.addSegment(segment(joints[i], masses[i]));
  }
  impl_ = std::make_unique<Impl>(chain, gravity);
}
GravityModel::GravityModel(const GravityModel& other)
    : impl_(std::make_unique<Impl>(other.impl_->chain, other.impl_->gravity)) {}
GravityModel::GravityModel(GravityModel&&) noexcept = default;
GravityModel::~GravityModel() = default;

int GravityModel::joints() const noexcept { return static_cast<int>(impl_->q.rows()); }

JointVector GravityModel::torque(const JointVector& q) const noexcept {
  if (q.size() != joints() || !q.allFinite()) {
    return JointVector::Zero(joints());
  }
  impl_->q.data = q;
  impl_->dynamics.JntToGravity(impl_->q, impl_->torque);
  return impl_->torque.data;
}

void MasterMlcConfig::validate() const {
  validate::in_range("joints", static_cast<double>(torque_limit.size()), 1, kMaxJoints);
  for (Eigen::Index i = 0; i < torque_limit.size(); ++i) {
    validate::positive(("torque_limit[" + std::to_string(i) + "]").c_str(), torque_limit[i]);
  }
  validate::positive("dt_max_s", dt_max_s);
}

MasterMlc::MasterMlc(MasterMlcConfig config, std::shared_ptr<const GravityModel> gravity)
    : config_(std::move(config)), gravity_(std::move(gravity)) {
  config_.validate();
  if (gravity_ && gravity_->joints() != config_.torque_limit.size()) {
    throw ConfigError("torque_limit: length = " + std::to_string(config_.torque_limit.size()) + ": must be " +
                      std::to_string(gravity_->joints()) + ", as the gravity model has joints");
  }
}

MasterMlcOutput MasterMlc::step(const MasterMlcInput& input, Seconds dt) noexcept {
  const Eigen::Index n = config_.torque_limit.size();
  MasterMlcOutput output;
  output.torque = output.compliance_torque = output.gravity_torque = JointVector::Zero(n);
  const bool sized = input.q.size() == n && input.jacobian.cols() == n &&
                     (input.external_torque.size() == 0 || input.external_torque.size() == n);
  if (!sized || !input.q.allFinite()) {
    output.status = Status::kInvalidInput;  // not even gravity is known: the motors must let go
    return output;
  }
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  if (config_.gravity && gravity_) {
    output.gravity_torque = gravity_->torque(input.q).cwiseMax(-config_.torque_limit).cwiseMin(config_.torque_limit);
  }
  JointVector added = JointVector::Zero(n);
  if (input.wrench_stale) {
    output.status = Status::kStale;
  } else if (input.jacobian.allFinite() && is_finite(input.wrench)) {
    const Vector6 wrench = to_vector(input.wrench);
    output.compliance_torque = input.jacobian.transpose().lazyProduct(wrench);
    added = output.compliance_torque;
  } else {
    output.status = Status::kInvalidInput;
  }
  if (input.external_torque.size() > 0) {
    if (input.external_torque.allFinite()) {
      added += input.external_torque;
    } else {
      output.status = Status::kInvalidInput;
    }
  }
  double scale = 1.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double room =
        config_.torque_limit[i] - (added[i] > 0.0 ? output.gravity_torque[i] : -output.gravity_torque[i]);
    if (std::abs(added[i]) > room) {
      scale = std::min(scale, room / std::abs(added[i]));
    }
  }
  if (scale < 1.0 && output.status == Status::kOk) {
    output.status = Status::kLimited;
  }
  output.torque = output.gravity_torque + scale * added;
  return output;
}

}  // namespace saras::csa
