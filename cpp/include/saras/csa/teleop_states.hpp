// Which side is in contact, what that means for master and slave, and how the two environments are brought together.
#pragma once

#include "saras/csa/slave_mlc.hpp"
#include "saras/spatial/law.hpp"

namespace saras::csa {

enum class ContactState : std::uint8_t {
  kNoContact = 0,  ///< neither slave nor proxy
  kProxyContact,   ///< the proxy is in the model, the slave does not touch yet
  kSlaveContact,   ///< the slave touches where the model has nothing
  kFullContact,    ///< both
};
/// NO_CONTACT, PROXY_CONTACT, SLAVE_CONTACT, FULL_CONTACT.
const char* to_string(ContactState state) noexcept;

enum class Synchronisation : std::uint8_t {
  kNever = 0,
  kAlways,          ///< the proxy goes to the slave and the master is re-referenced
  kWhenMismatched,  ///< the same, when they are further apart than the tolerance
};

/// One row of the table: what follows from where one is and what touches.
struct ContactTransition {
  ContactState state = ContactState::kNoContact;
  bool master_feels = false;  ///< compliance wrench; else zero
  SlaveMode mode = SlaveMode::kPosition;
  Synchronisation synchronise = Synchronisation::kNever;
};

/// Pure: Chalasani et al. 2018, figure 9, with the synchronisation of NO_CONTACT written out.
ContactTransition contact_transition(ContactState from, bool slave_contact, bool proxy_contact) noexcept;

/// A contact with hysteresis and debounce: on after `debounce_s` at or above `on`, off after as long at or below `off`.
struct ContactDetector {
  bool contact = false;
  Seconds pending_s = 0.0;  ///< for how long the signal has said otherwise
  void update(double signal, double on, double off, Seconds debounce_s, Seconds dt) noexcept;
};

struct CsaTeleopConfig {
  double scale = 0.5;                   ///< slave metres per master metre, (0, 10]
  double contact_on_N = 0.30;           ///< slave in contact from here
  double contact_off_N = 0.15;          ///< until here
  double proxy_on_m = 0.0005;           ///< proxy in contact from this depth in the model
  double proxy_off_m = 0.0;             ///< until here
  Seconds debounce_s = 0.02;            ///< a contact that is shorter does not count
  double stiffness_N_m = 300.0;         ///< k_d: F_d = k_d depth in PROXY_CONTACT
  double desired_force_N = 2.0;         ///< F_d in FULL_CONTACT
  double force_cap_N = 4.0;             ///< largest F_d
  double mismatch_tolerance_m = 0.002;  ///< FULL_CONTACT -> NO_CONTACT synchronises beyond it
  double force_limit_N = 3.3;           ///< largest wrench on the hand
  double torque_limit_Nm = 0.1;
  Seconds ramp_s = 0.1;  ///< the wrench goes from nothing to its limit in this time at the fastest
  Seconds dt_max_s = 0.1;
  void validate() const;  ///< throws ConfigError
};

/// Poses and wrenches in the slave's base axes.
struct CsaTeleopInput {
  Pose master_pose;            ///< of the handle
  Pose slave_pose;             ///< set-point of the slave's tip
  Pose proxy_pose;             ///< of the proxy's tip
  double slave_force_N = 0.0;  ///< norm of the filtered contact force
  bool force_known = false;
  double proxy_depth_m = 0.0;              ///< of the proxy's tip in the model; negative: outside
  Vector3 proxy_normal = Vector3::Zero();  ///< unit, from that tip to the surface: outward
  bool model_known = false;
  Wrench compliance_wrench;  ///< from the proxy's interaction with the model
  Wrench fixture_wrench;     ///< from fixtures that the proxy is beyond; felt in every state
  bool clutch = false;       ///< pressed: the master moves alone
  bool enabled = false;      ///< operator present, arms enabled
  bool stale = false;        ///< a pose is older than its limit
};

struct CsaTeleopOutput {
  ContactState state = ContactState::kNoContact;
  Pose desired;              ///< x_d, for slave and proxy
  bool hold = true;          ///< nobody moves: disabled, stale, or not known what touches
  bool synchronise = false;  ///< this tick: set the proxy to the slave, before it steps
  SlaveMode mode = SlaveMode::kPosition;
  Vector3 normal = Vector3::Zero();  ///< for the slave; zero: along its filtered force
  double desired_force_N = 0.0;
  Wrench wrench;            ///< on the hand, ramped
  double mismatch_m = 0.0;  ///< |slave - proxy|; after synchronisation what is left of it: zero
  Status status = Status::kWaiting;
};

struct CsaTeleopState {
  ContactState state = ContactState::kNoContact;
  ContactDetector slave;
  ContactDetector proxy;
  bool has_reference = false;
  Pose master_reference;
  Pose slave_reference;
  Wrench wrench;
};

/// x_d = x_s0 + s (x_m - x_m0), R_d = (R_m R_m0') R_s0. The wrench on the hand moves towards its target by at most
/// limit / ramp_s a second, on every transition and within every state.
class CsaTeleop {
 public:
  explicit CsaTeleop(CsaTeleopConfig config);
  CsaTeleopOutput step(const CsaTeleopInput& input, Seconds dt) noexcept;
  /// Without an argument: NO_CONTACT, new references at the next good input.
  void reset(const CsaTeleopState& state = {}) { state_ = state; }
  const CsaTeleopState& state() const { return state_; }
  const CsaTeleopConfig& config() const { return config_; }

 private:
  void take_reference(const CsaTeleopInput& input);
  void ramp_wrench(const Wrench& target, Seconds dt);

  CsaTeleopConfig config_;
  CsaTeleopState state_;
};

static_assert(has_law_shape<CsaTeleop, CsaTeleopInput, CsaTeleopState>());

}  // namespace saras::csa
