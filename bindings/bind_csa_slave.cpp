#include <optional>

#include "bind_csa.hpp"
#include "saras/csa/slave_mlc.hpp"
#include "saras/csa/virtual_fixture.hpp"

namespace saras::bindings {
namespace {

using namespace csa;

const FixtureRows* rows_of(const std::optional<FixtureOutput>& fixtures) {
  return fixtures ? &fixtures->rows : nullptr;
}

void bind_enums(py::module_& m) {
  py::enum_<MotionReason> reason(m, "MotionReason", "Why less than asked was done; from INVALID_INPUT on a hold.");
  for (int i = 0; i <= static_cast<int>(MotionReason::kSolverFailed); ++i) {
    reason.value(to_string(static_cast<MotionReason>(i)), static_cast<MotionReason>(i));
  }
  m.def("is_hold", &is_hold, py::arg("reason"), "Whether a MotionReason means standing still.");
  py::enum_<SlaveMode>(m, "SlaveMode", "Which projections the slave uses.")
      .value("POSITION", SlaveMode::kPosition)
      .value("HYBRID", SlaveMode::kHybrid)
      .value("ADMITTANCE", SlaveMode::kAdmittance);
  py::enum_<PalpationKind>(m, "PalpationKind", "What is superimposed along the normal.")
      .value("NONE", PalpationKind::kNone)
      .value("FORCE", PalpationKind::kForce)
      .value("MOTION", PalpationKind::kMotion);
  Struct<Palpation>(m, "Palpation", "Motion primitive of continuous palpation.")
      .field("kind", &Palpation::kind, "PalpationKind")
      .field("amplitude", &Palpation::amplitude, "[N] or [m]; of the force primitive at most 0.95 F_d")
      .field("frequency_hz", &Palpation::frequency_hz, "[Hz]");
}

void bind_motion(py::module_& m) {
  using C = ConstrainedMotionConfig;
  Struct<C> config(m, "ConstrainedMotionConfig", "Limits of the joints and weights. Raises ConfigError.");
  joint_field(config, "lower", &C::lower, "(n,) joint limits [rad, m]");
  joint_field(config, "upper", &C::upper, "(n,) [rad, m]");
  joint_field(config, "speed", &C::speed, "(n,) largest speeds [rad/s, m/s]");
  joint_field(config, "lead", &C::lead, "(n,) largest |set-point - measured| [rad, m]");
  config.field("rotation_weight_m", &C::rotation_weight_m, "one radian of error counts as so many metres")
      .field("first_weight", &C::first_weight, "error along the direction that comes first counts so many times")
      .field("damping", &C::damping, "weight of joint speeds [m^2/rad^2]")
      .field("singular_value_min_m", &C::singular_value_min_m, "below it damping rises [m]")
      .field("damping_singular", &C::damping_singular, "at singular value zero")
      .field("recovery_speed_m_s", &C::recovery_speed_m_s, "out of a violated fixture [m/s]")
      .field("soft_weight", &C::soft_weight, "cost of violating a soft row, per (m/s)^2")
      .field("dt_max_s", &C::dt_max_s, "longest time step [s]");
  using O = ConstrainedMotionOutput;
  Struct<O> output(m, "ConstrainedMotionOutput", "One tick of joint motion.");
  joint_field(output, "q", &O::q, "(n,) next set-point; the old one under a hold");
  joint_field(output, "rates", &O::rates, "(n,) [rad/s, m/s]");
  output.field("twist", &O::twist, "(6,) J rates")
      .field("fixture", &O::fixture, "index of the fixture that acts most; -1: none")
      .field("smallest_singular_value_m", &O::smallest_singular_value_m, "of the weighted Jacobian [m]")
      .field("kkt_residual", &O::kkt_residual, "")
      .field("reason", &O::reason, "MotionReason")
      .field("status", &O::status, "Status");
  py::class_<ConstrainedMotion>(m, "ConstrainedMotion", "Joint motion towards a twist inside limits and fixtures.")
      .def(py::init<C>(), py::arg("config"), "Raises ConfigError.")
      .def(
          "step",
          [](ConstrainedMotion& self, const Eigen::VectorXd& q, const Eigen::MatrixXd& jacobian, const Twist& twist,
             Seconds dt, const std::optional<Eigen::VectorXd>& q_measured, const std::optional<FixtureOutput>& fixtures,
             const Vector3& first) {
            ConstrainedMotionInput input;
            input.q = load_joints("q", q);
            input.jacobian = load_jacobian(jacobian);
            input.twist = twist;
            input.first = first;
            input.rows = rows_of(fixtures);
            if (q_measured) {
              input.q_measured = load_joints("q_measured", *q_measured);
            }
            return self.step(input, dt);
          },
          py::arg("q"), py::arg("jacobian"), py::arg("twist"), py::arg("dt"), py::arg("q_measured") = py::none(),
          py::arg("fixtures") = py::none(), py::arg("first") = Vector3(0.0, 0.0, 0.0),
          "q: (n,) set-point; jacobian: (6, n) at q, base axes; twist: (6,) wanted; q_measured: (n,) bounds the lead;\n"
          "fixtures: FixtureOutput; first: (3,) unit, speed along it comes before all other directions.")
      .def_property_readonly("config", [](const ConstrainedMotion& self) { return self.config(); });
  py::class_<ProxySlave>(m, "ProxySlave", "The slave of the virtual environment: motion only.")
      .def(py::init<C, double, double>(), py::arg("config"), py::arg("speed_limit_m_s") = 0.1,
           py::arg("rotation_speed_limit_rad_s") = 1.0, "Raises ConfigError.")
      .def(
          "step",
          [](ProxySlave& self, const Eigen::VectorXd& q, const Eigen::MatrixXd& jacobian, const Pose& pose,
             const Pose& desired, Seconds dt, const std::optional<FixtureOutput>& fixtures) {
            ConstrainedMotionInput input;
            input.q = load_joints("q", q);
            input.jacobian = load_jacobian(jacobian);
            input.rows = rows_of(fixtures);
            return self.step(input, pose, desired, dt);
          },
          py::arg("q"), py::arg("jacobian"), py::arg("pose"), py::arg("desired"), py::arg("dt"),
          py::arg("fixtures") = py::none(), "pose: (4, 4) at q; desired: (4, 4).");
}

void bind_slave_mlc(py::module_& m) {
  using C = SlaveMlcConfig;
  Struct<C> config(m, "SlaveMlcConfig", "Limits and gains of SlaveMlc. Raises ConfigError, at once.");
  config.field("motion", &C::motion, "ConstrainedMotionConfig")
      .field("admittance_m_Ns", &C::admittance_m_Ns, "K_g, largest [m/(N s)]")
      .field("scheduled", &C::scheduled, "lower K_g by the estimated stiffness")
      .field("stiffness_min_N_m", &C::stiffness_min_N_m, "[N/m]")
      .field("stiffness_max_N_m", &C::stiffness_max_N_m, "taken while nothing is known [N/m]")
      .field("period_s", &C::period_s, "of this controller [s]")
      .field("arm_lag_s", &C::arm_lag_s, "2 zeta / omega_n [s]")
      .field("sensor_lag_s", &C::sensor_lag_s, "[s]")
      .field("stability_margin", &C::stability_margin, "largest K_g k (period + arm + sensor), at most 0.5")
      .field("approach_speed_m_s", &C::approach_speed_m_s, "largest speed from force [m/s]")
      .field("speed_limit_m_s", &C::speed_limit_m_s, "largest speed from position [m/s]")
      .field("rotation_speed_limit_rad_s", &C::rotation_speed_limit_rad_s, "[rad/s]")
      .field("force_cutoff_hz", &C::force_cutoff_hz, "[Hz]")
      .field("normal_cutoff_hz", &C::normal_cutoff_hz, "[Hz]")
      .field("normal_force_min_N", &C::normal_force_min_N, "below it the normal is kept [N]")
      .field("normal_rate_rad_s", &C::normal_rate_rad_s, "the normal turns at most so fast [rad/s]")
      .field("force_cap_N", &C::force_cap_N, "[N]")
      .field("force_range_N", &C::force_range_N, "a component at or beyond it: saturated [N]");
  using O = SlaveMlcOutput;
  Struct<O>(m, "SlaveMlcOutput", "Result of SlaveMlc.step.")
      .field("motion", &O::motion, "ConstrainedMotionOutput")
      .field("normal", &O::normal, "(3,) that was used; zero: none")
      .field("normal_force_N", &O::normal_force_N, "[N]")
      .field("desired_force_N", &O::desired_force_N, "with palpation [N]")
      .field("admittance_m_Ns", &O::admittance_m_Ns, "K_g that was used")
      .field("status", &O::status, "Status");
  using S = SlaveMlcState;
  Struct<S>(m, "SlaveMlcState", "Filters, normal and phase of palpation.")
      .field("has_force", &S::has_force, "")
      .field("force", &S::force, "(3,) low-passed F_c [N]")
      .field("normal_force", &S::normal_force, "(3,) low-passed further [N]")
      .field("has_normal", &S::has_normal, "")
      .field("normal", &S::normal, "(3,)")
      .field("phase_rad", &S::phase_rad, "[rad]")
      .field("palpating_motion", &S::palpating_motion, "")
      .field("anchor_m", &S::anchor_m, "still to go along the normal [m]");
  py::class_<SlaveMlc>(m, "SlaveMlc", "Hybrid force and motion as one constrained optimisation.")
      .def(py::init<C>(), py::arg("config"), "Raises ConfigError.")
      .def(
          "step",
          [](SlaveMlc& self, const Eigen::VectorXd& q, const Eigen::MatrixXd& jacobian, const Pose& pose,
             const Pose& desired, Seconds dt, const std::optional<Wrench>& tissue_wrench, SlaveMode mode,
             double desired_force_N, const Vector3& normal, double stiffness_N_m, const Palpation& palpation,
             const std::optional<Eigen::VectorXd>& q_measured, const std::optional<FixtureOutput>& fixtures,
             bool stale) {
            SlaveMlcInput input;
            input.q = load_joints("q", q);
            if (q_measured) {
              input.q_measured = load_joints("q_measured", *q_measured);
            }
            input.jacobian = load_jacobian(jacobian);
            input.pose = pose;
            input.desired = desired;
            input.force_known = tissue_wrench.has_value();
            input.tissue_wrench = tissue_wrench.value_or(Wrench{});
            input.mode = mode;
            input.desired_force_N = desired_force_N;
            input.normal = normal;
            input.stiffness_N_m = stiffness_N_m;
            input.palpation = palpation;
            input.rows = rows_of(fixtures);
            input.stale = stale;
            return self.step(input, dt);
          },
          py::arg("q"), py::arg("jacobian"), py::arg("pose"), py::arg("desired"), py::arg("dt"),
          py::arg("tissue_wrench") = py::none(), py::arg("mode") = SlaveMode::kPosition,
          py::arg("desired_force_N") = 0.0, py::arg("normal") = Vector3(0.0, 0.0, 0.0),
          py::arg("stiffness_N_m") = std::numeric_limits<double>::quiet_NaN(), py::arg("palpation") = Palpation{},
          py::arg("q_measured") = py::none(), py::arg("fixtures") = py::none(), py::arg("stale") = false,
          "One tick, base axes. q: (n,) set-point, jacobian (6, n) and pose (4, 4) there; desired: (4, 4);\n"
          "tissue_wrench: (6,) measured, exerted on the tissue, or None; normal: (3,) outward, zero: along the force;\n"
          "stiffness_N_m: estimated, NaN: unknown; fixtures: FixtureOutput.")
      .def("reset", &SlaveMlc::reset, py::arg("state") = S{})
      .def("admittance", &SlaveMlc::admittance, py::arg("stiffness_N_m"), "K_g for an estimated stiffness.")
      .def_property_readonly("config", [](const SlaveMlc& self) { return self.config(); })
      .def_property_readonly("state", [](const SlaveMlc& self) { return self.state(); });
}

}  // namespace

void bind_csa_slave(py::module_& m) {
  bind_enums(m);
  bind_motion(m);
  bind_slave_mlc(m);
}

}  // namespace saras::bindings
