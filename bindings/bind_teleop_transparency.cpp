#include "law.hpp"
#include "saras/teleop/transparency.hpp"

namespace saras::bindings {
namespace {

void bind_config(py::module_& m) {
  using Config = TransparencyConfig;
  Struct<Config>(m, "TransparencyConfig", "Gains and limits of a Transparency.")
      .field("mode", &Config::mode, "TransparencyMode")
      .field("scale", &Config::scale, "slave metres per master metre, (0, 10]")
      .field("stiffness_N_m", &Config::stiffness_N_m, "force on the hand per metre of slave error [N/m]")
      .field("damping_N_s_m", &Config::damping_N_s_m, "force on the hand per slave error velocity [N s/m]")
      .field("rotation_stiffness_Nm_rad", &Config::rotation_stiffness_Nm_rad, "torque per rotation error [N m/rad]")
      .field("rotation_damping_Nm_s_rad", &Config::rotation_damping_Nm_s_rad, "torque per its rate [N m s/rad]")
      .field("force_scale", &Config::force_scale, "force on the hand per force on the tissue")
      .field("torque_scale", &Config::torque_scale, "torque on the hand per torque on the tissue")
      .field("force_limit_N", &Config::force_limit_N, "largest force on the hand [N]")
      .field("torque_limit_Nm", &Config::torque_limit_Nm, "largest torque on the hand [N m]")
      .field("ramp_s", &Config::ramp_s, "force fades in and out over this time [s]")
      .field("drift_gain_1_s", &Config::drift_gain_1_s, "removes the drift that a reduced command leaves [1/s]")
      .field("drift_limit_m_s", &Config::drift_limit_m_s, "largest speed of that correction [m/s]")
      .field("slave_lag_s", &Config::slave_lag_s, "of the arm in free motion: no drift, not corrected [s]")
      .field("rotation_drift_gain_1_s", &Config::rotation_drift_gain_1_s, "the same for rotation [1/s]")
      .field("rotation_drift_limit_rad_s", &Config::rotation_drift_limit_rad_s, "its largest rate [rad/s]")
      .field("pivoted", &Config::pivoted, "project the slave's twist on an arm that pivots about its trocar")
      .field("pivot_radius_min_m", &Config::pivot_radius_min_m,
             "distance trocar - tip below which pivot rates are no longer raised [m]")
      .field("dt_max_s", &Config::dt_max_s, "longest time step [s]");
}

}  // namespace

void bind_transparency(py::module_& m) {
  py::enum_<TransparencyMode>(m, "TransparencyMode", "What the hand feels.")
      .value("POSITION_POSITION", TransparencyMode::kPositionPosition, "the position error")
      .value("POSITION_FORCE", TransparencyMode::kPositionForce, "the force on the tissue")
      .value("FOUR_CHANNEL", TransparencyMode::kFourChannel, "the sum of both");
  bind_config(m);
  Struct<TransparencyOutput>(m, "TransparencyOutput", "Result of Transparency.step, in the slave's base frame.")
      .field("desired_wrench", &TransparencyOutput::desired_wrench, "(6,) on the operator's hand [N, N m]")
      .field("desired_twist", &TransparencyOutput::desired_twist, "(6,) of the slave's tip [m/s, rad/s]")
      .field("error", &TransparencyOutput::error, "(6,) slave - mapped master [slave m, rad]")
      .field("status", &TransparencyOutput::status, "saras.Status");
  Struct<TransparencyState>(m, "TransparencyState", "All that a Transparency remembers.")
      .field("has_reference", &TransparencyState::has_reference, "whether references were taken")
      .field("master_reference", &TransparencyState::master_reference, "(4, 4) master pose there")
      .field("slave_reference", &TransparencyState::slave_reference, "(4, 4) slave pose there")
      .field("lagged_master", &TransparencyState::lagged_master,
             "(3,) scaled master displacement behind slave_lag_s [m]")
      .field("ramp", &TransparencyState::ramp, "0 = no force, 1 = all of it")
      .field("wrench", &TransparencyState::wrench, "(6,) last wrench before the ramp");
  py::class_<Transparency>(m, "Transparency", "Desired wrench on the hand and desired twist of the slave, one side.")
      .def(py::init<TransparencyConfig>(), py::arg("config") = TransparencyConfig{})
      .def(
          "step",
          [](Transparency& self, const Pose& master_pose, const Twist& master_twist, const Pose& slave_pose,
             const Twist& slave_twist, const Wrench& tissue_wrench, const Vector3& rcm, double dt, bool clutch,
             bool stale, const std::optional<Twist>& master_twist_filtered, const Wrench& guidance_wrench) {
            return self.step({master_pose, master_twist, slave_pose, slave_twist, tissue_wrench, rcm, clutch, stale,
                              master_twist_filtered, guidance_wrench},
                             dt);
          },
          py::arg("master_pose"), py::arg("master_twist"), py::arg("slave_pose"), py::arg("slave_twist"),
          py::arg("tissue_wrench"), py::arg("rcm"), py::arg("dt"), py::arg("clutch") = false, py::arg("stale") = false,
          py::arg("master_twist_filtered") = py::none(), py::arg("guidance_wrench") = Wrench{},
          "One tick; everything in the slave's base frame.\n\n"
          "master_pose: (4, 4) tracked pose, master_twist: (6,). slave_pose: (4, 4) measured tip, slave_twist: (6,).\n"
          "tissue_wrench: (6,) exerted on the tissue. rcm: (3,) trocar [m]. dt: since the previous step [s].\n"
          "stale: any of these is older than its limit. master_twist_filtered: (6,) for the damping term.\n"
          "guidance_wrench: (6,) further wrench on the hand, from fixtures or nearness.")
      .def("reset", &Transparency::reset, py::arg("state") = TransparencyState{},
           "Without argument: new references at the next good input (engagement).")
      .def_property_readonly("config", [](const Transparency& self) { return self.config(); })
      .def_property_readonly("state", [](const Transparency& self) { return self.state(); });
  m.def("project_on_pivot", &project_on_pivot, py::arg("tip_twist"), py::arg("base_T_tip"), py::arg("rcm"),
        py::arg("radius_min") = 0.01,
        "The part (6,) of a tip twist (6,) that an arm pivoting about rcm (3,) can do: translation kept,\n"
        "rotation = pivoting + roll. Closer than radius_min [m] the pivot rate is that at radius_min.");
}

}  // namespace saras::bindings
