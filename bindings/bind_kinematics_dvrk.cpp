#include "law.hpp"
#include "rooms.hpp"
#include "saras/kinematics/dvrk_ecm.hpp"
#include "saras/kinematics/dvrk_psm.hpp"

namespace saras::bindings {
namespace {

using namespace dvrk;

template <typename Vector, typename Names>
const Vector& finite(const Vector& q, const Names& names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double value = q[static_cast<Eigen::Index>(i)];
    if (!std::isfinite(value)) {
      throw KinematicsError(std::string(names.at(i)) + " = " + std::to_string(value) + ": must be finite");
    }
  }
  return q;
}

template <typename Config>
Eigen::MatrixX2d limits(const Config& config) {
  Eigen::MatrixX2d both(config.lower.size(), 2);
  both << config.lower, config.upper;
  return both;
}

void bind_tools(py::module_& m) {
  py::class_<Tool>(m, "DvrkTool", "One da Vinci instrument. Angles are limits of both signs.")
      .def_readonly("model", &Tool::model, "six digits")
      .def_readonly("name", &Tool::name, "as dVRK writes it")
      .def_readonly("length_m", &Tool::length_m, "DH d of the roll row [m]")
      .def_readonly("wrist_offset_m", &Tool::wrist_offset_m, "wrist pitch axis to wrist yaw axis [m]")
      .def_readonly("roll_limit_rad", &Tool::roll_limit_rad)
      .def_readonly("wrist_pitch_limit_rad", &Tool::wrist_pitch_limit_rad)
      .def_readonly("wrist_yaw_limit_rad", &Tool::wrist_yaw_limit_rad)
      .def_readonly("jaw_lower_rad", &Tool::jaw_lower_rad)
      .def_readonly("jaw_upper_rad", &Tool::jaw_upper_rad);
  m.def("dvrk_tools", &tools, "All known instruments, by model.");
  m.def("dvrk_find_tool", &find_tool, py::arg("text"),
        "By model ('400006') or dVRK name ('LARGE_NEEDLE_DRIVER:400006'). Raises ConfigError naming what is known.");
  m.def(
      "dvrk_psm_config",
      [](const std::string& tool, const std::string& body) { return psm_config(find_tool(tool), find_body(body)); },
      py::arg("tool"), py::arg("body"), "PsmConfig of a body with an instrument. Raises ConfigError.");
  m.def(
      "dvrk_ecm_config",
      [](const std::string& endoscope, const std::string& body) {
        return ecm_config(find_endoscope(endoscope), find_body(body));
      },
      py::arg("endoscope"), py::arg("body"), "EcmConfig of a body with an endoscope. Raises ConfigError.");
}

void bind_psm(py::module_& m) {
  Struct<PsmConfig>(m, "PsmConfig", "Dimensions and limits of a PSM; defaults: Classic body, 400006.")
      .field("insertion_offset_m", &PsmConfig::insertion_offset_m, "carriage at insertion 0 behind the centre [m]")
      .field("tool_length_m", &PsmConfig::tool_length_m, "DH d of the roll row [m]")
      .field("wrist_offset_m", &PsmConfig::wrist_offset_m, "wrist pitch axis to wrist yaw axis [m]")
      .field("lower", &PsmConfig::lower, "(6,) lower limits [rad], insertion [m]")
      .field("upper", &PsmConfig::upper, "(6,) upper limits [rad], insertion [m]");
  py::class_<Psm>(m, "Psm",
                  "The da Vinci's patient side manipulator. q = [yaw, pitch, insertion, roll, wrist_pitch, wrist_yaw]\n"
                  "[rad], insertion [m]; the base frame's origin is the remote centre, its -z the shaft at zero.")
      .def(py::init<PsmConfig>(), py::arg("config") = PsmConfig{})
      .def_property_readonly("config", [](const Psm& self) { return self.config(); })
      .def_property_readonly(
          "limits", [](const Psm& self) { return limits(self.config()); }, "(6, 2) lower, upper [rad], insertion [m]")
      .def_property_readonly("joint_names", [](const Psm&) { return py::cast(kPsmJointNames); })
      .def(
          "forward", [](const Psm& self, const Vector6& q) { return self.forward(finite(q, kPsmJointNames)); },
          py::arg("q"), "(4, 4) base_T_tip. Raises KinematicsError naming the joint that is not finite.")
      .def(
          "jacobian", [](const Psm& self, const Vector6& q) { return self.jacobian(finite(q, kPsmJointNames)); },
          py::arg("q"), "(6, 6) twist of the tip in the base frame, linear first, from joint rates.")
      .def(
          "inverse",
          [](const Psm& self, const Pose& pose, const Vector6& q0) {
            return self.inverse(pose, finite(q0, kPsmJointNames)).value();
          },
          py::arg("base_T_tip"), py::arg("q0"),
          "(6,) joints of a (4, 4) pose inside the limits, nearest to q0 (6,), closed form.\n"
          "Raises KinematicsError naming joint, value, bounds.")
      .def("shaft", &Psm::shaft, py::arg("q"), "(3,) unit vector from the remote centre along the shaft.")
      .def("wrist_position", &Psm::wrist_position, py::arg("q"), "(3,) end of the straight shaft, in the base [m].")
      .def(
          "limit_violation", [](const Psm& self, const Vector6& q) { return describe(self.check_limits(q)); },
          py::arg("q"), "First joint beyond its limits with value and bounds; '' when none.");
}

void bind_ecm(py::module_& m) {
  Struct<EcmConfig>(m, "EcmConfig", "Dimensions and limits of an ECM; defaults: Classic body, straight endoscope.")
      .field("insertion_offset_m", &EcmConfig::insertion_offset_m, "carriage at insertion 0 behind the centre [m]")
      .field("endoscope_length_m", &EcmConfig::endoscope_length_m, "DH d of the roll row [m]")
      .field("view_angle_rad", &EcmConfig::view_angle_rad, "lens about x, down positive [rad]")
      .field("lower", &EcmConfig::lower, "(4,) lower limits [rad], insertion [m]")
      .field("upper", &EcmConfig::upper, "(4,) upper limits [rad], insertion [m]");
  py::class_<Ecm>(m, "Ecm",
                  "The da Vinci's endoscope manipulator. q = [yaw, pitch, insertion, roll] [rad], insertion [m];\n"
                  "the base frame's origin is the remote centre, its -z the shaft at zero.")
      .def(py::init<EcmConfig>(), py::arg("config") = EcmConfig{})
      .def_property_readonly("config", [](const Ecm& self) { return self.config(); })
      .def_property_readonly(
          "limits", [](const Ecm& self) { return limits(self.config()); }, "(4, 2) lower, upper [rad], insertion [m]")
      .def_property_readonly("joint_names", [](const Ecm&) { return py::cast(kEcmJointNames); })
      .def(
          "forward", [](const Ecm& self, const Vector4& q) { return self.forward(finite(q, kEcmJointNames)); },
          py::arg("q"), "(4, 4) base_T_tip. Raises KinematicsError naming the joint that is not finite.")
      .def(
          "jacobian", [](const Ecm& self, const Vector4& q) { return self.jacobian(finite(q, kEcmJointNames)); },
          py::arg("q"), "(6, 4) twist of the tip in the base frame, linear first, from joint rates.")
      .def(
          "inverse",
          [](const Ecm& self, const Pose& pose, const Vector4& q0, double rotation_tolerance_rad) {
            return self.inverse(pose, finite(q0, kEcmJointNames), rotation_tolerance_rad).value();
          },
          py::arg("base_T_tip"), py::arg("q0"), py::arg("rotation_tolerance_rad") = 1e-6,
          "(4,) joints that reach the point of a (4, 4) pose with the roll that comes nearest to its rotation.\n"
          "Four joints cannot reach every rotation: what remains must be within rotation_tolerance_rad (pi takes\n"
          "any). Raises KinematicsError naming joint or rotation, value, bounds.")
      .def(
          "rotation_error",
          [](const Ecm& self, const Pose& pose, const Vector4& q0) {
            return self.inverse(pose, finite(q0, kEcmJointNames), M_PI).rotation_error_rad;
          },
          py::arg("base_T_tip"), py::arg("q0"), "Rotation that inverse would leave [rad].")
      .def("shaft", &Ecm::shaft, py::arg("q"), "(3,) unit vector from the remote centre along the endoscope.")
      .def(
          "limit_violation", [](const Ecm& self, const Vector4& q) { return describe(self.check_limits(q)); },
          py::arg("q"), "First joint beyond its limits with value and bounds; '' when none.");
}

}  // namespace

void bind_kinematics_dvrk(py::module_& m) {
  bind_psm(m);
  bind_ecm(m);
  bind_tools(m);  // its functions give what the two above have made
}

}  // namespace saras::bindings
