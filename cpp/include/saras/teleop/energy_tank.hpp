// The passivity layer: what motors may do is bounded by a store of energy.
//
// One law, three places: at the handles (port guard: desired = wrench on the hand, conjugate = handle
// twist), as the shared store between them (tank_master) and at the arms (tank_slave: desired = twist,
// conjugate = wrench exerted on the tissue). Work out of the tank is applied . conjugate . dt.
//
// After Ferraguti, Secchi et al., "Bilateral teleoperation of a dual arms surgical robot with passive
// virtual fixtures generation" and Franken et al. 2011, with the energy itself as state, a budget over the
// time the device holds a command, and a ledger for exchange (energy_ledger.hpp).
#pragma once

#include <array>

#include "saras/spatial/law.hpp"

namespace saras {

inline constexpr int kMaxTankChannels = 8;

/// One column a channel (handle or arm); fixed capacity, so that no step allocates.
using ChannelArray = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxTankChannels>;

struct EnergyTankConfig {
  double initial_J = 0.40;    ///< energy at construction, counted as granted; minimum_J for a restart [J]
  double minimum_J = 0.02;    ///< below it only damping acts [J]
  double request_J = 0.15;    ///< below it the tank asks its peers and reduces the command [J]
  double available_J = 0.25;  ///< above it the tank may give to peers; asking stops here [J]
  double maximum_J = 0.50;    ///< capacity [J]
  double exchange_W = 2.0;    ///< largest power to one requesting peer [W]
  Vector6 damping_min = (Vector6() << 1, 1, 1, 0, 0, 0).finished();  ///< B with a full tank; 0 on axes without a motor
  Vector6 damping_max = (Vector6() << 6, 6, 6, 0, 0, 0).finished();  ///< B with an empty tank
  Vector6 conjugate_rate = Vector6::Constant(20.0);  ///< largest rate of change of the conjugate [unit/s]
  Vector6 applied_limit = (Vector6() << 3.3, 3.3, 3.3, 0, 0, 0).finished();  ///< saturation per axis of the output
  Seconds hold_s = 0.002;   ///< longest time the device keeps a command before it zeroes it [s]
  Seconds dt_max_s = 0.01;  ///< a longer interval is billed, and answered by zero [s]

  void validate() const;  ///< throws ConfigError
};

struct EnergyTankInput {
  ChannelArray desired;    ///< what transparency wants: wrench on the hand, or twist of the arm
  ChannelArray conjugate;  ///< mean over the last interval: twist of the handle, or wrench exerted on the tissue
  ChannelArray
      measured;  ///< optional (0 columns: none): the applied side as measured, for the worst case of a lagging arm
  bool conjugate_stale = false;  ///< conjugate is older than its limit: zero output
  bool has_work = false;         ///< work_J is measured; else applied_prev . conjugate . dt is billed
  double work_J = 0.0;           ///< what really left through the ports since the last tick [J]
  double received_J = 0.0;       ///< credited by the ledgers since the last tick [J]
  int requesting_peers = 0;      ///< how many peers ask for energy
  bool peer_has_room = true;     ///< some peer can take overflow
};

struct EnergyTankOutput {
  ChannelArray applied;               ///< goes to the device; zero when the status says so
  double energy_J = 0.0;              ///< tank level after this tick [J]
  double sent_J = 0.0;                ///< left for the peers in this tick: put it on the ledger [J]
  double sent_overflow_J = 0.0;       ///< the part of sent_J that is overflow, not an answer to requests [J]
  bool requesting = false;            ///< ask the peers for energy
  bool has_room = true;               ///< the tank can take more
  double reduction = 0.0;             ///< K_E in [0, 1]
  double scale = 1.0;                 ///< alpha in [0, 1]: what the budget over hold_s lets through
  Vector6 damping = Vector6::Zero();  ///< B of this tick
  Status status = Status::kOk;
};

struct EnergyTankState {
  double energy_J = 0.0;    ///< level; the state of the law
  double granted_J = 0.0;   ///< cumulative: charge at construction or restart, and grants
  double work_out_J = 0.0;  ///< cumulative: through the ports (negative: the surroundings put energy in)
  double received_J = 0.0;  ///< cumulative: from peers
  double sent_J = 0.0;      ///< cumulative: to peers
  double vented_J = 0.0;    ///< cumulative: discarded because the tank was full
  bool requesting = false;
  bool rate_locked = false;  ///< after RATE_EXCEEDED: damping only until energy_J > minimum_J
  bool has_conjugate = false;
  ChannelArray applied;    ///< of the last tick: what the next one bills
  ChannelArray conjugate;  ///< of the last tick
};

/// Invariant, to rounding: energy_J + work_out_J + sent_J + vented_J = granted_J + received_J.
class EnergyTank {
 public:
  /// channels: 1 … kMaxTankChannels. Throws ConfigError.
  EnergyTank(EnergyTankConfig config, int channels);

  EnergyTankOutput step(const EnergyTankInput& input, Seconds dt) noexcept;

  /// Puts energy in from outside (engagement); what exceeds the capacity is vented. Throws ConfigError for
  /// a negative or non-finite amount.
  void grant(double energy_J);

  /// A restart: level minimum_J (counted as granted), all else zero.
  void reset();
  /// Continues from a recorded state. Throws ConfigError when its channels differ or a number is not finite.
  void reset(const EnergyTankState& state);

  const EnergyTankState& state() const { return state_; }
  const EnergyTankConfig& config() const { return config_; }
  int channels() const { return channels_; }

  /// Deepest that damping alone can take the level below minimum_J: sum of B_max (c h)^2 h / 4 over all axes
  /// and channels, the most work -B v (v + d) can do for |d| <= c h.
  double damping_reserve_J() const { return damping_reserve_J_; }

 private:
  bool bill(const EnergyTankInput& input, bool conjugate_usable, Seconds dt, bool time_step_usable) noexcept;
  void exchange(const EnergyTankInput& input, Seconds dt, EnergyTankOutput& output) noexcept;
  bool rate_exceeded(const ChannelArray& conjugate) const noexcept;
  ChannelArray command(const EnergyTankInput& input, double reduction, const Vector6& damping,
                       double scale) const noexcept;
  double worst_work_J(const ChannelArray& applied, const EnergyTankInput& input) const noexcept;
  ChannelArray damp_within_budget(const EnergyTankInput& input, const Vector6& damping) const noexcept;
  void apply(const EnergyTankInput& input, bool damping_only, EnergyTankOutput& output) const noexcept;
  EnergyTankOutput finish(EnergyTankOutput output, Status status) noexcept;

  EnergyTankConfig config_;
  int channels_;
  double damping_reserve_J_;
  EnergyTankState state_;
};

static_assert(has_law_shape<EnergyTank, EnergyTankInput, EnergyTankState>());

}  // namespace saras
