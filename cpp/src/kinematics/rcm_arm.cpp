#include "saras/kinematics/rcm_arm.hpp"

#include <cmath>

#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

/// Sines and cosines that the arm's frames are made of.
struct Frames {
  explicit Frames(const Vector6& q) noexcept
      : phi(q[0] + q[1]),
        elbow_R(Eigen::AngleAxisd(phi, Vector3::UnitZ())),
        fork_R(elbow_R * Eigen::AngleAxisd(q[2], Vector3::UnitX())),
        shaft(-(fork_R * Eigen::AngleAxisd(q[3], Vector3::UnitY())).toRotationMatrix().col(2)) {}
  double phi;
  Quaternion elbow_R;  ///< base to second SCARA link
  Quaternion fork_R;   ///< base to the link behind universal_1
  Vector3 shaft;       ///< unit vector from the universal joint to the tip
};

constexpr double kSingular = 1e-3;  // sine below which a mechanism counts as stretched or folded

}  // namespace

void RcmArmConfig::validate() const {
  validate::positive("scara_link_1_m", scara_link_1_m);
  validate::positive("scara_link_2_m", scara_link_2_m);
  validate::positive("tip_offset_m", tip_offset_m);
  validate::positive("instrument_m", instrument_m);
  validate::positive("minimum_depth_m", minimum_depth_m);
  validate::finite("lower", lower);
  validate::finite("upper", upper);
  validate::not_above("lower", lower, "upper", upper);
  for (int i = 0; i < mesa::kJoints; ++i) {
    validate::positive(("speed[" + std::to_string(i) + "]").c_str(), speed[i]);
  }
}

RcmArm::RcmArm(RcmArmConfig config) : config_(std::move(config)) { config_.validate(); }

Vector3 RcmArm::universal_position(const Vector6& q) const noexcept {
  const double phi = q[0] + q[1];
  return {config_.scara_link_1_m * std::cos(q[0]) + config_.scara_link_2_m * std::cos(phi),
          config_.scara_link_1_m * std::sin(q[0]) + config_.scara_link_2_m * std::sin(phi), 0.0};
}

Pose RcmArm::forward(const Vector6& q) const noexcept {
  const Frames frames(q);
  Pose base_T_tip;
  // Ry(u2) Rx(pi) Rz(roll); Rx(pi) is the quaternion (0; 1, 0, 0).
  base_T_tip.rotation = frames.fork_R * Quaternion(Eigen::AngleAxisd(q[3], Vector3::UnitY())) *
                        Quaternion(0.0, 1.0, 0.0, 0.0) * Quaternion(Eigen::AngleAxisd(q[5], Vector3::UnitZ()));
  base_T_tip.rotation.normalize();
  base_T_tip.translation = universal_position(q) + (config_.tip_offset_m + q[4]) * frames.shaft;
  return base_T_tip;
}

Matrix6 RcmArm::jacobian(const Vector6& q) const noexcept {
  const Frames frames(q);
  const Vector3 universal = universal_position(q);
  const Vector3 elbow = config_.scara_link_1_m * Vector3(std::cos(q[0]), std::sin(q[0]), 0.0);
  const Vector3 lever = (config_.tip_offset_m + q[4]) * frames.shaft;
  const Vector3 tip = universal + lever;
  const Vector3 z = Vector3::UnitZ();
  const Vector3 universal_1 = frames.elbow_R * Vector3::UnitX();
  const Vector3 universal_2 = frames.fork_R * Vector3::UnitY();
  Matrix6 jacobian;
  jacobian.col(0) << z.cross(tip), z;
  jacobian.col(1) << z.cross(tip - elbow), z;
  jacobian.col(2) << universal_1.cross(lever), universal_1;
  jacobian.col(3) << universal_2.cross(lever), universal_2;
  jacobian.col(4) << frames.shaft, Vector3::Zero();
  jacobian.col(5) << Vector3::Zero(), frames.shaft;
  return jacobian;
}

double RcmArm::rcm_deviation(const Vector6& q, const Vector3& rcm) const noexcept {
  return Frames(q).shaft.cross(rcm - universal_position(q)).norm();
}

std::optional<Pose> RcmArm::pivot_pose(const Pose& base_T_tip, const Vector3& rcm) const noexcept {
  const Vector3 shaft = base_T_tip.translation - rcm;
  const double depth = shaft.norm();
  if (!is_valid(base_T_tip) || !std::isfinite(depth) || depth < config_.minimum_depth_m) {
    return std::nullopt;
  }
  const Vector3 shaft_now = base_T_tip.rotation * Vector3::UnitZ();
  const Quaternion turn = Quaternion::FromTwoVectors(shaft_now, shaft);
  return Pose{(turn * base_T_tip.rotation).normalized(), base_T_tip.translation};
}

std::optional<Matrix64> RcmArm::pivot_jacobian(const Vector6& q, const Vector3& rcm) const noexcept {
  const Frames frames(q);
  const Vector3 tip = universal_position(q) + (config_.tip_offset_m + q[4]) * frames.shaft;
  const double depth = frames.shaft.dot(tip - rcm);
  if (!q.allFinite() || !rcm.allFinite() || depth < config_.minimum_depth_m || std::abs(std::sin(q[1])) < kSingular ||
      std::abs(std::cos(q[3])) < kSingular || std::abs(frames.shaft.z()) < kSingular) {
    return std::nullopt;
  }
  // A shaft that turns about the trocar: omega = n x v / depth + n omega_n.
  Matrix64 tip_twist = Matrix64::Zero();
  tip_twist.topLeftCorner<3, 3>().setIdentity();
  for (int i = 0; i < 3; ++i) {
    tip_twist.block<3, 1>(3, i) = frames.shaft.cross(Vector3(Vector3::Unit(i))) / depth;
  }
  tip_twist.bottomRightCorner<3, 1>() = frames.shaft;
  return Matrix64(jacobian(q).partialPivLu().solve(tip_twist));
}

Chain RcmArm::chain() const {
  const auto moving = [this](int i, const char* link, JointType type, const Pose& origin, const Vector3& axis) {
    return Joint{mesa::kJointNames.at(static_cast<std::size_t>(i)),
                 link,
                 type,
                 origin,
                 axis,
                 config_.lower[i],
                 config_.upper[i]};
  };
  const auto along = [](double x, double z) { return Pose{Quaternion::Identity(), Vector3(x, 0.0, z)}; };
  const auto turn = JointType::kRevolute;
  return Chain({
      moving(0, "scara_link_1", turn, along(0.0, 0.0), Vector3::UnitZ()),
      moving(1, "scara_link_2", turn, along(config_.scara_link_1_m, 0.0), Vector3::UnitZ()),
      moving(2, "universal_fork", turn, along(config_.scara_link_2_m, 0.0), Vector3::UnitX()),
      moving(3, "linear_axis", turn, along(0.0, 0.0), Vector3::UnitY()),
      moving(4, "carriage", JointType::kPrismatic, {Quaternion(0.0, 1.0, 0.0, 0.0), Vector3::Zero()}, Vector3::UnitZ()),
      moving(5, "instrument", turn, along(0.0, config_.tip_offset_m - config_.instrument_m), Vector3::UnitZ()),
      Joint{"tip", "tool_tip", JointType::kFixed, along(0.0, config_.instrument_m)},
  });
}

}  // namespace saras
