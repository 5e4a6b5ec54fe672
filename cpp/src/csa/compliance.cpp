#include "saras/csa/compliance.hpp"

#include <algorithm>
#include <cmath>

#include "saras/spatial/clamp_norm.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/validate.hpp"

namespace saras::csa {
namespace {

double beyond_deadband(double value, double band) {
  return value > band ? value - band : value < -band ? value + band : 0.0;
}

struct Axis {
  double bias, stiffness, damping;
};

/// Of one axis; sign is +1 for gains as printed, -1 for positive stiffness.
double axis_force(const Axis& gain, double deviation, double rate, double sign, bool wall) {
  const double spring = sign * gain.stiffness * deviation;
  const double force = gain.bias + spring + sign * gain.damping * rate;
  if (!wall || gain.stiffness == 0.0 || gain.bias != 0.0) {
    return force;
  }
  // Inside a wall: its damper may weaken the spring, but not turn it into a pull.
  return spring >= 0.0 ? std::max(force, 0.0) : std::min(force, 0.0);
}

void check_gains(const char* side, const ComplianceGains& gains, ComplianceConvention convention) {
  const auto name = [side](const char* field) { return std::string(side) + "." + field; };
  const auto check = [&](const char* field, const Vector3& value) {
    validate::finite(name(field).c_str(), value);
    if (convention == ComplianceConvention::kPositive) {
      validate::not_negative(name(field).c_str(), value);
    }
  };
  check("stiffness_N_m", gains.stiffness_N_m);
  check("damping_N_s_m", gains.damping_N_s_m);
  check("rotation_stiffness_Nm_rad", gains.rotation_stiffness_Nm_rad);
  validate::finite(name("force_bias_N").c_str(), gains.force_bias_N);
  validate::finite(name("torque_bias_Nm").c_str(), gains.torque_bias_Nm);
}

}  // namespace

void ComplianceConfig::validate() const {
  check_gains("negative", negative, convention);
  check_gains("positive", positive, convention);
  validate::finite("rotation_damping_Nm_s_rad", rotation_damping_Nm_s_rad);
  if (convention == ComplianceConvention::kPositive) {
    validate::not_negative("rotation_damping_Nm_s_rad", rotation_damping_Nm_s_rad);
  }
  validate::not_negative("deadband_m", deadband_m);
  validate::in_range("rotation_deadband_rad", rotation_deadband_rad, 0.0, M_PI);
  validate::positive("force_limit_N", force_limit_N);
  validate::not_negative("torque_limit_Nm", torque_limit_Nm);
  validate::positive("dt_max_s", dt_max_s);
}

ComplianceWrench::ComplianceWrench(ComplianceConfig config) : config_(config) { config_.validate(); }

ComplianceOutput ComplianceWrench::step(const ComplianceInput& input, Seconds dt) noexcept {
  ComplianceOutput output;
  if (!is_valid_time_step(dt, config_.dt_max_s)) {
    output.status = Status::kInvalidTimeStep;
    return output;
  }
  Pose torque_frame = input.frame;
  if (input.separate_torque_frame) {
    torque_frame.rotation = input.torque_rotation;
  }
  if (!is_valid(input.handle_pose) || !is_finite(input.handle_twist) || !is_valid(input.frame) ||
      !is_valid(torque_frame)) {
    output.status = Status::kInvalidInput;
    return output;
  }
  const double sign = config_.convention == ComplianceConvention::kAsPrinted ? 1.0 : -1.0;
  const Quaternion c_R_base = input.frame.rotation.conjugate();
  const Vector3 deviation = c_R_base * (input.handle_pose.translation - input.frame.translation);
  const Vector3 velocity = c_R_base * input.handle_twist.linear;
  const Quaternion t_R_base = torque_frame.rotation.conjugate();
  const Vector3 rotation = rotation_log((t_R_base * input.handle_pose.rotation).normalized());
  const Vector3 rate = t_R_base * input.handle_twist.angular;
  Vector3 force;
  Vector3 torque;
  for (int i = 0; i < 3; ++i) {
    const ComplianceGains& side = deviation[i] <= 0.0 ? config_.negative : config_.positive;
    force[i] =
        axis_force({side.force_bias_N[i], side.stiffness_N_m[i], side.damping_N_s_m[i]},
                   beyond_deadband(deviation[i], config_.deadband_m), velocity[i], sign, config_.walls_never_pull);
    const ComplianceGains& turned = rotation[i] <= 0.0 ? config_.negative : config_.positive;
    torque[i] =
        turned.torque_bias_Nm[i] +
        sign * turned.rotation_stiffness_Nm_rad[i] * beyond_deadband(rotation[i], config_.rotation_deadband_rad) +
        sign * config_.rotation_damping_Nm_s_rad[i] * rate[i];
  }
  if (!std::isfinite(force.squaredNorm() + torque.squaredNorm())) {  // finite inputs of absurd size
    output.status = Status::kInvalidInput;
    return output;
  }
  const bool limited = force.norm() > config_.force_limit_N || torque.norm() > config_.torque_limit_Nm;
  output.wrench.force = input.frame.rotation * clamp_norm(force, config_.force_limit_N);
  output.wrench.torque = torque_frame.rotation * clamp_norm(torque, config_.torque_limit_Nm);
  output.deviation = deviation;
  output.rotation = rotation;
  output.status = limited ? Status::kLimited : Status::kOk;
  return output;
}

}  // namespace saras::csa
