#include "bind_csa.hpp"

#include "saras/csa/compliance.hpp"
#include "saras/csa/master_mlc.hpp"
#include "saras/csa/qp.hpp"

namespace saras::bindings {
namespace {

using namespace csa;

void bind_qp(py::module_& m) {
  py::enum_<QpStatus>(m, "QpStatus", "How a quadratic programme ended.")
      .value("SOLVED", QpStatus::kSolved)
      .value("SOFTENED", QpStatus::kSoftened)
      .value("INFEASIBLE", QpStatus::kInfeasible)
      .value("INVALID_INPUT", QpStatus::kInvalidInput)
      .value("FAILED", QpStatus::kFailed);
  py::class_<QpResult>(m, "QpResult", "How a solve ended.")
      .def_readonly("status", &QpResult::status, "QpStatus")
      .def_readonly("iterations", &QpResult::iterations)
      .def_readonly("kkt_residual", &QpResult::kkt_residual)
      .def_readonly("slack", &QpResult::slack, "largest violation of a soft row");
  py::class_<QpSolver>(m, "QpSolver",
                       "minimise 1/2 x'Hx + g'x, lower <= x <= upper, row_lower <= A x <= row_upper.\n"
                       "DAQP, with memory taken once; a solution is only called solved with a KKT residual <= 1e-8.")
      .def(py::init<int, int, double>(), py::arg("variables"), py::arg("rows_max"), py::arg("soft_weight") = 1e6,
           "soft_weight: cost of a soft row's violation s is soft_weight s^2 / 2. Raises ConfigError.")
      .def(
          "solve",
          [](QpSolver& self, const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
             const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, const QpSolver::RowMajor& rows,
             const Eigen::VectorXd& row_lower, const Eigen::VectorXd& row_upper,
             const std::optional<Eigen::VectorXi>& soft) {
            const Eigen::Index n = self.variables();
            const Eigen::Index count = rows.rows();
            if (hessian.rows() != n || hessian.cols() != n || gradient.size() != n || lower.size() != n ||
                upper.size() != n || (count > 0 && rows.cols() != n) || row_lower.size() != count ||
                row_upper.size() != count || (soft && soft->size() != count) || count > self.rows_max()) {
              throw py::value_error("solve: expected hessian (" + std::to_string(n) + ", " + std::to_string(n) +
                                    "), vectors of " + std::to_string(n) + ", at most " +
                                    std::to_string(self.rows_max()) + " rows with bounds of their number");
            }
            self.hessian = hessian;
            self.gradient = gradient;
            self.lower = lower;
            self.upper = upper;
            self.rows.topRows(count) = rows;
            self.row_lower.head(count) = row_lower;
            self.row_upper.head(count) = row_upper;
            self.soft.setZero();
            if (soft) {
              self.soft.head(count) = *soft;
            }
            return self.solve(static_cast<int>(count));
          },
          py::arg("hessian"), py::arg("gradient"), py::arg("lower"), py::arg("upper"), py::arg("rows"),
          py::arg("row_lower"), py::arg("row_upper"), py::arg("soft") = py::none(),
          "hessian: (n, n); gradient, lower, upper: (n,); rows: (m, n); row_lower, row_upper: (m,), infinite for no\n"
          "bound; soft: (m,) 0 or 1. Gives a QpResult; solution and multipliers stay here. ValueError for shapes.")
      .def_property_readonly(
          "solution", [](const QpSolver& self) { return self.solution(); }, "(n,) of the last solved problem")
      .def_property_readonly(
          "multipliers", [](const QpSolver& self) { return self.multipliers(); },
          "(n + rows_max,) bounds first; positive at an upper bound: Hx + g + l[:n] + A' l[n:] = 0");
}

void bind_compliance(py::module_& m) {
  py::enum_<ComplianceConvention>(m, "ComplianceConvention", "How compliance gains act.")
      .value("AS_PRINTED", ComplianceConvention::kAsPrinted)
      .value("POSITIVE", ComplianceConvention::kPositive);
  using G = ComplianceGains;
  Struct<G>(m, "ComplianceGains", "Of one side of each axis, in the compliance frame.")
      .field("stiffness_N_m", &G::stiffness_N_m, "(3,) [N/m]")
      .field("damping_N_s_m", &G::damping_N_s_m, "(3,) [N s/m]")
      .field("force_bias_N", &G::force_bias_N, "(3,) [N]")
      .field("rotation_stiffness_Nm_rad", &G::rotation_stiffness_Nm_rad, "(3,) [N m/rad]")
      .field("torque_bias_Nm", &G::torque_bias_Nm, "(3,) [N m]");
  using C = ComplianceConfig;
  Struct<C> config(m, "ComplianceConfig", "Gains of ComplianceWrench. Raises ConfigError.");
  config
      .field("convention", &C::convention,
             "AS_PRINTED: restoring gains are negative; POSITIVE: stiffness and damping in the usual sense, >= 0")
      .field("negative", &C::negative, "ComplianceGains where the deviation is <= 0")
      .field("positive", &C::positive, "ComplianceGains where it is > 0")
      .field("rotation_damping_Nm_s_rad", &C::rotation_damping_Nm_s_rad, "(3,) [N m s/rad]")
      .field("deadband_m", &C::deadband_m, "[m]")
      .field("rotation_deadband_rad", &C::rotation_deadband_rad, "[rad]")
      .field("force_limit_N", &C::force_limit_N, "[N]")
      .field("torque_limit_Nm", &C::torque_limit_Nm, "[N m]")
      .field("walls_never_pull", &C::walls_never_pull, "a damper may weaken a wall's spring, but not turn it round")
      .field("dt_max_s", &C::dt_max_s, "longest time step [s]");
  using O = ComplianceOutput;
  Struct<O>(m, "ComplianceOutput", "Result of ComplianceWrench.step.")
      .field("wrench", &O::wrench, "(6,) on the hand, base axes")
      .field("deviation", &O::deviation, "(3,) in the compliance frame [m]")
      .field("rotation", &O::rotation, "(3,) rotation vector from the compliance frame [rad]")
      .field("status", &O::status, "Status");
  Struct<ComplianceState>(m, "ComplianceState", "Nothing is remembered.").cls().attr("_fields") = py::list();
  py::class_<ComplianceWrench>(m, "ComplianceWrench",
                               "Springs, dampers and biases about a frame (Chalasani et al. 2018, algorithm 1).")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](ComplianceWrench& self, const Pose& handle_pose, const Twist& handle_twist, const Pose& frame, Seconds dt,
             const std::optional<Pose>& torque_frame) {
            ComplianceInput input{handle_pose, handle_twist, frame, Quaternion::Identity(), torque_frame.has_value()};
            input.torque_rotation = torque_frame.value_or(Pose{}).rotation;
            return self.step(input, dt);
          },
          py::arg("handle_pose"), py::arg("handle_twist"), py::arg("frame"), py::arg("dt"),
          py::arg("torque_frame") = py::none(),
          "One tick, base axes. handle_pose: (4, 4); handle_twist: (6,); frame: (4, 4) compliance frame;\n"
          "torque_frame: (4, 4) whose rotation the torque refers to, the frame's own by default.")
      .def("reset", &ComplianceWrench::reset, py::arg("state") = ComplianceState{})
      .def_property_readonly("config", [](const ComplianceWrench& self) { return self.config(); })
      .def_property_readonly("state", [](const ComplianceWrench& self) { return self.state(); });
}

void bind_master(py::module_& m) {
  py::class_<GravityModel, std::shared_ptr<GravityModel>>(m, "GravityModel",
                                                          "Joint torques that hold a chain against gravity.")
      .def(py::init([](const std::vector<Joint>& joints, const std::vector<double>& masses_kg,
                       const std::vector<Vector3>& centres_m, const Vector3& gravity) {
             if (masses_kg.size() != centres_m.size()) {
               throw ConfigError("centres_m: count = " + std::to_string(centres_m.size()) + ": must be " +
                                 std::to_string(masses_kg.size()));
             }
             std::vector<LinkMass> masses;
             for (std::size_t i = 0; i < masses_kg.size(); ++i) {
               masses.push_back({masses_kg[i], centres_m[i]});
             }
             return GravityModel(joints, masses, gravity);
           }),
           py::arg("joints"), py::arg("masses_kg"), py::arg("centres_m"), py::arg("gravity") = Vector3(0.0, 0.0, -9.81),
           "joints: of kinematics.Chain. masses_kg, centres_m (3,): one a joint, in its link's frame. gravity: (3,)\n"
           "in the base frame [m/s^2]. Raises ConfigError, KinematicsError.")
      .def(
          "torque",
          [](const GravityModel& self, const Eigen::VectorXd& q) -> Eigen::VectorXd {
            if (q.size() != self.joints()) {
              throw py::value_error("q: expected " + std::to_string(self.joints()) + " joints, got " +
                                    std::to_string(q.size()));
            }
            return self.torque(q);
          },
          py::arg("q"), "(n,) what the motors must give [N m, N].");
  using C = MasterMlcConfig;
  Struct<C> config(m, "MasterMlcConfig", "Limits of MasterMlc. Raises ConfigError.");
  joint_field(config, "torque_limit", &C::torque_limit, "(n,) [N m, N]");
  config.field("gravity", &C::gravity, "add the gravity model's torques")
      .field("dt_max_s", &C::dt_max_s, "longest time step [s]");
  using O = MasterMlcOutput;
  Struct<O> output(m, "MasterMlcOutput", "Result of MasterMlc.step.");
  joint_field(output, "torque", &O::torque, "(n,) for the low-level controller [N m, N]");
  joint_field(output, "compliance_torque", &O::compliance_torque, "(n,) J' wrench");
  joint_field(output, "gravity_torque", &O::gravity_torque, "(n,)");
  output.field("status", &O::status, "LIMITED: a joint at its limit; STALE: without the wrench");
  Struct<MasterMlcState>(m, "MasterMlcState", "Nothing is remembered.").cls().attr("_fields") = py::list();
  py::class_<MasterMlc>(m, "MasterMlc", "torque = J' wrench + gravity + external, each joint limited.")
      .def(py::init([](const C& limits, const std::optional<std::shared_ptr<GravityModel>>& gravity) {
             return MasterMlc(limits, gravity.value_or(nullptr));
           }),
           py::arg("config"), py::arg("gravity") = py::none(), "gravity: GravityModel or None. Raises ConfigError.")
      .def(
          "step",
          [](MasterMlc& self, const Eigen::VectorXd& q, const Eigen::MatrixXd& jacobian, const Wrench& wrench,
             Seconds dt, const std::optional<Eigen::VectorXd>& external_torque, bool wrench_stale) {
            MasterMlcInput input{load_joints("q", q), load_jacobian(jacobian), wrench, {}, wrench_stale};
            if (external_torque) {
              input.external_torque = load_joints("external_torque", *external_torque);
            }
            return self.step(input, dt);
          },
          py::arg("q"), py::arg("jacobian"), py::arg("wrench"), py::arg("dt"), py::arg("external_torque") = py::none(),
          py::arg("wrench_stale") = false,
          "One tick. q: (n,) measured; jacobian: (6, n) base axes; wrench: (6,) on the hand, either computed by\n"
          "ComplianceWrench or given from outside; external_torque: (n,) sum of what others add.")
      .def("reset", &MasterMlc::reset, py::arg("state") = MasterMlcState{})
      .def_property_readonly("config", [](const MasterMlc& self) { return self.config(); })
      .def_property_readonly("state", [](const MasterMlc& self) { return self.state(); });
}

}  // namespace

void bind_csa(py::module_& m) {
  m.attr("MAX_JOINTS") = kMaxJoints;
  bind_qp(m);
  bind_compliance(m);
  bind_master(m);
  bind_csa_fixtures(m);
  bind_csa_teleop_fixtures(m);
  bind_csa_border(m);
  bind_csa_slave(m);
  bind_csa_teleop(m);
}

}  // namespace saras::bindings
