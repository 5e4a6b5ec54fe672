#include "law.hpp"
#include "rooms.hpp"
#include "saras/kinematics/rcm_arm.hpp"
#include "saras/kinematics/simball_handle.hpp"

namespace saras::bindings {

void bind_kinematics_dvrk(py::module_& m);

namespace {

void bind_chain(py::module_& m) {
  py::enum_<JointType>(m, "JointType", "How a joint moves.")
      .value("FIXED", JointType::kFixed)
      .value("REVOLUTE", JointType::kRevolute)
      .value("PRISMATIC", JointType::kPrismatic);
  Struct<Joint>(m, "Joint", "One joint of a Chain and the link behind it, as in URDF.")
      .field("name", &Joint::name, "name of the joint")
      .field("link", &Joint::link, "name of the link that the joint moves")
      .field("type", &Joint::type, "JointType")
      .field("parent_T_joint", &Joint::parent_T_joint, "(4, 4) in the frame of the link before it")
      .field("axis", &Joint::axis, "(3,) unit vector in the joint's frame")
      .field("lower", &Joint::lower, "lower limit [rad or m]")
      .field("upper", &Joint::upper, "upper limit [rad or m]");
  using Q = Eigen::Ref<const Eigen::VectorXd>;
  py::class_<Chain>(m, "Chain", "A serial chain of fixed, revolute and prismatic joints (Orocos KDL).")
      .def(py::init<std::vector<Joint>>(), py::arg("joints"))
      .def(
          "forward",
          [](const Chain& self, const Q& q, const std::string& link) {
            return link.empty() ? self.forward(q) : self.forward(q, link);
          },
          py::arg("q"), py::arg("link") = "",
          "(4, 4) base_T_link of the last link, or of a named one. q: (n,) moving joints [rad or m].\n"
          "Raises KinematicsError for a wrong length, a joint that is not finite, an unknown link.")
      .def(
          "jacobian", [](const Chain& self, const Q& q) { return Eigen::MatrixXd(self.jacobian(q)); }, py::arg("q"),
          "(6, n) twist of the last link's origin in the base frame, linear first, from joint rates.")
      .def("check_limits", &Chain::check_limits, py::arg("q"),
           "Raises KinematicsError naming the first joint beyond its limits.")
      .def_property_readonly("joint_names", [](const Chain& self) { return self.joint_names(); })
      .def_property_readonly(
          "limits", [](const Chain& self) { return Eigen::MatrixXd(self.limits()); }, "(n, 2) lower, upper [rad or m]");
}

const Vector6& finite(const Vector6& q) {
  for (int i = 0; i < mesa::kJoints; ++i) {
    if (!std::isfinite(q[i])) {
      throw KinematicsError(std::string(mesa::kJointNames.at(static_cast<std::size_t>(i))) + " = " +
                            std::to_string(q[i]) + ": must be finite");
    }
  }
  return q;
}

void bind_rcm_arm_config(py::module_& m) {
  Struct<RcmArmConfig>(m, "RcmArmConfig", "Dimensions and limits of a SARAS arm; defaults: mesa_geometry.hpp.")
      .field("scara_link_1_m", &RcmArmConfig::scara_link_1_m, "shoulder to elbow [m]")
      .field("scara_link_2_m", &RcmArmConfig::scara_link_2_m, "elbow to universal joint [m]")
      .field("tip_offset_m", &RcmArmConfig::tip_offset_m, "universal joint to tip at insertion = 0 [m]")
      .field("instrument_m", &RcmArmConfig::instrument_m, "adapter flange to tip [m]")
      .field("minimum_depth_m", &RcmArmConfig::minimum_depth_m, "least distance from trocar to tip [m]")
      .field("lower", &RcmArmConfig::lower, "(6,) lower joint limits [rad], insertion [m]")
      .field("upper", &RcmArmConfig::upper, "(6,) upper joint limits [rad], insertion [m]")
      .field("speed", &RcmArmConfig::speed, "(6,) speed limits [rad/s], insertion [m/s]");
}

void bind_rcm_arm(py::module_& m) {
  py::class_<RcmArm>(
      m, "RcmArm",
      "The SARAS endoscope robot. q = [scara_1, scara_2, universal_1, universal_2, insertion, roll] "
      "[rad], insertion [m];\nposes and points are in sbs_world (z up, universal joint in z = 0, trocar below).")
      .def(py::init<RcmArmConfig>(), py::arg("config") = RcmArmConfig{})
      .def_property_readonly("config", [](const RcmArm& self) { return self.config(); })
      .def_property_readonly(
          "limits",
          [](const RcmArm& self) {
            Eigen::Matrix<double, mesa::kJoints, 2> limits;
            limits << self.config().lower, self.config().upper;
            return limits;
          },
          "(6, 2) lower, upper [rad], insertion [m]")
      .def_property_readonly("joint_names", [](const RcmArm&) { return py::cast(mesa::kJointNames); })
      .def("chain", &RcmArm::chain, "The same mechanism as a Chain, with the links of the URDF.")
      .def(
          "forward", [](const RcmArm& self, const Vector6& q) { return self.forward(finite(q)); }, py::arg("q"),
          "(4, 4) base_T_tip; +z along the shaft from trocar to tip.")
      .def(
          "jacobian", [](const RcmArm& self, const Vector6& q) { return self.jacobian(finite(q)); }, py::arg("q"),
          "(6, 6) twist of the tip in the base frame, linear first, from joint rates.")
      .def(
          "universal_position", [](const RcmArm& self, const Vector6& q) { return self.universal_position(finite(q)); },
          py::arg("q"), "(3,) centre of the universal joint [m].")
      .def(
          "inverse",
          [](const RcmArm& self, const Pose& pose, const Vector6& q0) { return self.inverse(pose, q0).value(); },
          py::arg("base_T_tip"), py::arg("q0"),
          "(6,) joints for a (4, 4) pose, elbow on the side of q0. Raises KinematicsError naming joint, value, bound.")
      .def(
          "inverse_pivot",
          [](const RcmArm& self, const Vector3& tip, double roll, const Vector3& rcm, const Vector6& q0) {
            return self.inverse_pivot(tip, roll, rcm, q0).value();
          },
          py::arg("tip_position"), py::arg("roll"), py::arg("rcm"), py::arg("q0"),
          "(6,) joints with the tip at a point (3,) [m], the shaft through rcm (3,) [m], the roll joint at roll "
          "[rad].\n"
          "Elbow on the side of q0. Raises KinematicsError naming quantity, value, bound.")
      .def(
          "inverse_parallel",
          [](const RcmArm& self, const Vector3& tip, double roll, const Vector6& q0) {
            return self.inverse_parallel(tip, roll, q0).value();
          },
          py::arg("tip_position"), py::arg("roll"), py::arg("q0"),
          "(6,) joints with the tip at a point (3,) [m] and the universal joint as in q0.")
      .def(
          "unreachable",
          [](const RcmArm& self, const Vector3& tip, const Vector3& rcm) { return describe(self.reachable(tip, rcm)); },
          py::arg("tip_position"), py::arg("rcm"),
          "What keeps the tip from a point with the shaft through rcm: quantity, value, bounds; '' when reachable.")
      .def(
          "reachable",
          [](const RcmArm& self, const Vector3& tip, const Vector3& rcm) { return !self.reachable(tip, rcm); },
          py::arg("tip_position"), py::arg("rcm"), "Whether the tip can be at a point (3,) with the shaft through rcm.")
      .def("pivot_pose", &RcmArm::pivot_pose, py::arg("base_T_tip"), py::arg("rcm"),
           "The (4, 4) pose turned the least so that its shaft passes rcm; None nearer than minimum_depth_m.")
      .def("pivot_jacobian", &RcmArm::pivot_jacobian, py::arg("q"), py::arg("rcm"),
           "(6, 4) joint rates from (tip velocity [m/s], angular velocity about the shaft [rad/s]) that keep the\n"
           "shaft through rcm; None near a singularity.")
      .def("rcm_deviation", &RcmArm::rcm_deviation, py::arg("q"), py::arg("rcm"),
           "Distance of the shaft's line from the trocar [m].")
      .def(
          "limit_violation", [](const RcmArm& self, const Vector6& q) { return describe(self.check_limits(q)); },
          py::arg("q"), "First joint beyond its limits with value and bounds; '' when none.");
}

void bind_simball_handle(py::module_& m) {
  Struct<SimballHandleConfig>(m, "SimballHandleConfig", "Dimensions and limits of a hand piece.")
      .field("handle_distance_m", &SimballHandleConfig::handle_distance_m, "pivot to handle at insertion = 0 [m]")
      .field("lower", &SimballHandleConfig::lower, "(4,) lower limits [rad], insertion [m]")
      .field("upper", &SimballHandleConfig::upper, "(4,) upper limits [rad], insertion [m]");
  py::class_<SimballHandle>(m, "SimballHandle",
                            "The console's hand piece. q = [yaw, pitch, roll, insertion] [rad], insertion [m];\n"
                            "simball_base: origin in the pivot, z up; handle: +z along the shaft to the pivot.")
      .def(py::init<SimballHandleConfig>(), py::arg("config") = SimballHandleConfig{})
      .def_property_readonly("config", [](const SimballHandle& self) { return self.config(); })
      .def_property_readonly(
          "limits",
          [](const SimballHandle& self) {
            Eigen::Matrix<double, 4, 2> limits;
            limits << self.config().lower, self.config().upper;
            return limits;
          },
          "(4, 2) lower, upper [rad], insertion [m]")
      .def_property_readonly("joint_names", [](const SimballHandle&) { return py::cast(simball::kJointNames); })
      .def("forward", &SimballHandle::forward, py::arg("q"), "(4, 4) simball_T_handle.")
      .def("jacobian", &SimballHandle::jacobian, py::arg("q"),
           "(6, 4) twist of the handle in simball_base, linear first, from joint rates.")
      .def(
          "inverse", [](const SimballHandle& self, const Pose& pose) { return self.inverse(pose); },
          py::arg("simball_T_handle"),
          "(4,) joints of a (4, 4) pose, limits not applied; None when not above the pivot.")
      .def(
          "inverse_position",
          [](const SimballHandle& self, const Vector3& point, double roll) { return self.inverse(point, roll); },
          py::arg("handle_position"), py::arg("roll"),
          "(4,) joints of a point (3,) [m] and roll [rad], limits not applied; None when not above the pivot.")
      .def("clamp", &SimballHandle::clamp, py::arg("q"), "(4,) nearest joints inside the limits.")
      .def("check_limits", &SimballHandle::check_limits, py::arg("q"),
           "Raises KinematicsError naming the first joint beyond its limits, its value, the bounds.");
}

}  // namespace

void bind_kinematics(py::module_& m) {
  bind_chain(m);
  bind_rcm_arm_config(m);
  bind_rcm_arm(m);
  bind_simball_handle(m);
  bind_kinematics_dvrk(m);
  m.attr("MESA_NOMINAL_RCM") = py::cast(Vector3(mesa::kNominalRcm.data()));
  m.attr("MESA_SHAFT_RADIUS_M") = mesa::kShaftRadius;
}

}  // namespace saras::bindings
