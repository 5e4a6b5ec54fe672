#include "bind_calibration.hpp"
#include "saras/calibration/calibration_error.hpp"
#include "saras/calibration/hand_eye.hpp"

namespace saras::bindings {
namespace {

std::vector<HandEyePair> load_pairs(const py::object& base_T_gripper, const py::object& camera_T_target,
                                    const py::object& gripper_twist, const std::optional<std::vector<int>>& groups) {
  const auto gripper = load_poses(base_T_gripper, "base_T_gripper");
  const auto target = load_poses(camera_T_target, "camera_T_target");
  if (gripper.size() != target.size()) {
    throw CalibrationError("base_T_gripper has " + std::to_string(gripper.size()) + " poses, camera_T_target " +
                           std::to_string(target.size()) + ": must be as many");
  }
  if (groups && groups->size() != gripper.size()) {
    throw py::value_error("groups: expected " + std::to_string(gripper.size()) + " numbers, got " +
                          std::to_string(groups->size()));
  }
  std::vector<HandEyePair> pairs;
  for (std::size_t i = 0; i < gripper.size(); ++i) {
    pairs.push_back({gripper[i], target[i], {}, groups ? (*groups)[i] : 0});
  }
  if (!gripper_twist.is_none()) {
    const Array twists = Array::ensure(gripper_twist);
    if (!twists || twists.ndim() != 2 || twists.shape(1) != 6 ||
        twists.shape(0) != static_cast<py::ssize_t>(pairs.size())) {
      PyErr_Clear();
      throw py::value_error("gripper_twist: expected shape (n, 6), one row a pair");
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      pairs[i].gripper_twist = to_twist(Eigen::Map<const Vector6>(twists.data() + 6 * i));
    }
  }
  return pairs;
}

Array store_residuals(const std::vector<Vector6>& residuals) {
  Array array({static_cast<py::ssize_t>(residuals.size()), py::ssize_t{6}});
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    Eigen::Map<Vector6>(array.mutable_data() + 6 * i) = residuals[i];
  }
  return array;
}

void bind_result(py::module_& m) {
  using H = HandEye;
  py::class_<H>(m, "HandEye", "Where the camera sits, how well that is known, and what each pair says.")
      .def_property_readonly(
          "gripper_T_camera", [](const H& h) { return h.gripper_T_camera; }, "(4, 4); eye-to-hand: base_T_camera")
      .def_property_readonly(
          "base_T_target", [](const H& h) { return h.base_T_target; }, "(4, 4); eye-to-hand: gripper_T_target")
      .def_property_readonly(
          "covariance", [](const H& h) { return store_matrix6(h.covariance); },
          "(6, 6) of saras.displacement(estimate, truth) of gripper_T_camera: [m, rad], in the gripper's axes")
      .def_property_readonly(
          "target_covariance", [](const H& h) { return store_matrix6(h.target_covariance); },
          "(6, 6) the same of base_T_target, in the base's axes")
      .def_property_readonly(
          "residuals", [](const H& h) { return store_residuals(h.residuals); },
          "(n, 6) saras.displacement(base_T_target, what each pair says): [m, rad]")
      .def_readonly("used", &H::used, "n flags; False: a gross error that was left out")
      .def_readonly("rms_m", &H::rms_m, "of the used residuals' lengths [m]")
      .def_readonly("rms_rad", &H::rms_rad, "of the used residuals' angles [rad]")
      .def_readonly("rotation_noise", &H::rotation_noise, "estimated noise of rotations, times what was expected")
      .def_readonly("translation_noise", &H::translation_noise, "the same of translations")
      .def_readonly("spread_rad", &H::spread_rad, "conditioning: second RMS extent of the relative rotations [rad]")
      .def_readonly("time_offset_s", &H::time_offset_s, "correction to the offset that base_T_gripper already has [s]")
      .def_readonly("time_offset_std_s", &H::time_offset_std_s, "its standard deviation [s]");
}

}  // namespace

void bind_calibration_hand_eye(py::module_& m) {
  using N = HandEyeNoise;
  Struct<N>(m, "HandEyeNoise", "Expected errors per axis; their ratios weigh, common factors are estimated.")
      .field("robot_rotation_rad", &N::robot_rotation_rad, "[rad]")
      .field("robot_translation_m", &N::robot_translation_m, "[m]")
      .field("camera_rotation_rad", &N::camera_rotation_rad, "[rad]")
      .field("camera_translation_m", &N::camera_translation_m, "[m]");
  bind_result(m);
  const HandEyeOptions defaults;
  m.def(
      "hand_eye",
      [](const py::object& base_T_gripper, const py::object& camera_T_target, bool eye_to_hand, const N& noise,
         bool robust, const std::optional<Pose>& initial, bool allow_repeats, double min_spread_rad, double max_rms_m,
         double max_rms_rad, const py::object& gripper_twist, const std::optional<std::vector<int>>& groups) {
        const auto pairs = load_pairs(base_T_gripper, camera_T_target, gripper_twist, groups);
        HandEyeOptions options;
        options.noise = noise;
        options.eye_to_hand = eye_to_hand;
        options.robust = robust;
        options.allow_repeats = allow_repeats;
        options.min_spread_rad = min_spread_rad;
        options.max_rms_m = max_rms_m;
        options.max_rms_rad = max_rms_rad;
        options.time_offset = !gripper_twist.is_none();
        options.grouped = groups.has_value();
        const py::gil_scoped_release release;
        return hand_eye(pairs, options, initial);
      },
      py::arg("base_T_gripper"), py::arg("camera_T_target"), py::kw_only(), py::arg("eye_to_hand") = false,
      py::arg("noise") = N{}, py::arg("robust") = true, py::arg("initial") = py::none(),
      py::arg("allow_repeats") = false, py::arg("min_spread_rad") = defaults.min_spread_rad,
      py::arg("max_rms_m") = defaults.max_rms_m, py::arg("max_rms_rad") = defaults.max_rms_rad,
      py::arg("gripper_twist") = py::none(), py::arg("groups") = py::none(),
      "A X = X B by joint maximum likelihood over camera and target, robust against gross errors.\n\n"
      "base_T_gripper, camera_T_target: (n, 4, 4), n >= 3. eye_to_hand: the camera stands in the base and sees a "
      "target\n"
      "on the gripper. initial: (4, 4) to start from instead of the linear solution. gripper_twist: (n, 6) in the "
      "base's\n"
      "axes [m/s, rad/s]; with it a time offset is estimated too. groups: n numbers; neighbours in a stream share "
      "one,\n"
      "and the covariance then comes from the spread between groups.\n"
      "Raises CalibrationError: fewer than 3 pairs, repeats, parallel axes (min_spread_rad, names the spread), "
      "implausible\n"
      "units, pairs that fit no rigid mounting (max_rms_m, max_rms_rad).");
  m.def(
      "rotation_spread",
      [](const py::object& poses) {
        std::vector<HandEyePair> pairs;
        for (const auto& pose : load_poses(poses, "poses")) {
          pairs.push_back({pose, {}, {}, 0});
        }
        return rotation_spread(pairs);
      },
      py::arg("poses"), "(3,) RMS extents [rad] of all relative rotations of (n, 4, 4), largest first.");
}

}  // namespace saras::bindings
