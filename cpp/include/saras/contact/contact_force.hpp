// From how deep a tool presses into tissue, as a camera sees it now and then, to a force at a steady rate.
#pragma once

#include <limits>

#include "saras/spatial/law.hpp"

namespace saras {

struct ContactForceConfig {
  double stiffness_N_m = 300.0;  ///< K [N/m^exponent], > 0
  double exponent = 1.0;         ///< n of depth^n, 1 … 3; 1 is the source's spring
  double damping_N_s_m2 = 0.0;   ///< lambda [N s/m^(1+n)] of Hunt and Crossley, >= 0; 0: none
  double rate_cutoff_hz = 5.0;   ///< low-pass of the depth's rate, > 0
  double depth_limit_m = 0.05;   ///< a deeper reading is not believed, > 0
  double force_limit_N = 10.0;   ///< beyond it the estimate is saturated, > 0
  Seconds age_limit_s = 0.25;    ///< an older reading gives no estimate, > 0
  Seconds dt_max_s = 0.1;        ///< longest time step, > 0
  void validate() const;         ///< throws ConfigError
};

struct ContactForceInput {
  bool is_new = false;  ///< a reading came since the last step; else the fields below are not read
  double depth_m = std::numeric_limits<double>::quiet_NaN();  ///< of the tip under the undisturbed surface; <= 0: none
  Vector3 direction = Vector3::Zero();                        ///< outward normal of the tissue, any length but 0
  Seconds age_s = 0.0;                                        ///< of that reading now
};

struct ContactForceOutput {
  bool has_estimate = false;           ///< false: unknown, which is not zero; the wrenches are NaN then
  Wrench exerted;                      ///< by the tool on the tissue, in the frame of the direction
  Vector3 reaction = Vector3::Zero();  ///< on the tool, the opposite: +K depth^n n
  double depth_m = 0.0;                ///< >= 0
  Seconds age_s = std::numeric_limits<double>::infinity();  ///< of the reading behind it
  Status status = Status::kOk;
};

struct ContactForceState {
  bool known = false;
  double depth_m = 0.0;
  double rate_m_s = 0.0;
  Vector3 normal = Vector3::Zero();
  Seconds age_s = 0.0;
};

/// reaction = max(0, K d^n + lambda d^n d') normal with d = max(0, depth), Hunt and Crossley (1975); with n = 1 and
/// lambda = 0 the source's K d. The exerted wrench is its opposite, without torque, at the tip.
///
/// Each reading is held until the next, and its age grows. No estimate: WAITING before the first reading; STALE beyond
/// age_limit_s; INVALID_INPUT for a reading whose depth is not finite or beyond depth_limit_m, whose direction is zero
/// or not finite, or whose age is negative: whoever sends it says that he does not know, so nothing is held either, and
/// it is WAITING until a good one comes; LIMITED while the force would be beyond force_limit_N: a bound of the truth,
/// not the truth. The rate d' is taken over the time between readings, and is zero after a gap.
/// An invalid dt: no estimate, nothing taken; what is held ages by a dt that is too long.
class ContactForce {
 public:
  explicit ContactForce(ContactForceConfig config);
  ContactForceOutput step(const ContactForceInput& input, Seconds dt) noexcept;
  void reset(const ContactForceState& state = {}) { state_ = state; }
  const ContactForceState& state() const { return state_; }
  const ContactForceConfig& config() const { return config_; }

 private:
  bool take(const ContactForceInput& input) noexcept;

  ContactForceConfig config_;
  ContactForceState state_;
};

static_assert(has_law_shape<ContactForce, ContactForceInput, ContactForceState>());

}  // namespace saras
