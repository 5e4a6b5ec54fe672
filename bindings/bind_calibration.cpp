#include "bind_calibration.hpp"

#include "rooms.hpp"
#include "saras/calibration/board.hpp"
#include "saras/calibration/calibration_error.hpp"
#include "saras/calibration/frame_registration.hpp"

namespace saras::bindings {
namespace {

[[noreturn]] void refuse_shape(const char* what, const char* expected, const Array& array) {
  PyErr_Clear();
  throw py::value_error(std::string(what) + ": expected shape " + expected + ", got " +
                        (array ? shape_text(array) : std::string("no array")));
}

void bind_board(py::module_& m) {
  using B = BoardConfig;
  Struct<B>(m, "BoardConfig",
            "Dots on a circle for the arms to touch, ArUco markers on a concentric one for the endoscope.")
      .field("dot_circle_radius_m", &B::dot_circle_radius_m, "circle of the dots' centres [m]")
      .field("dot_diameter_m", &B::dot_diameter_m, "[m]")
      .field("dot_angles_deg", &B::dot_angles_deg, "increasing and uneven, so that a wrong order shows [deg]")
      .field("marker_circle_radius_m", &B::marker_circle_radius_m, "circle of the markers' centres [m]")
      .field("marker_side_m", &B::marker_side_m, "edge of the black square [m]")
      .field("marker_angles_deg", &B::marker_angles_deg, "[deg]");
  m.def(
      "dot_centers",
      [](const B& config) {
        config.validate();
        return store_points(dot_centers(config));
      },
      py::arg("config"), "(n, 3) centres of the dots in the board's frame [m]. Raises ConfigError.");
  m.def(
      "marker_corners",
      [](const B& config) {
        config.validate();
        const auto markers = marker_corners(config);
        Array array({static_cast<py::ssize_t>(markers.size()), py::ssize_t{4}, py::ssize_t{3}});
        for (std::size_t i = 0; i < markers.size(); ++i) {
          for (std::size_t j = 0; j < 4; ++j) {
            Eigen::Map<Vector3>(array.mutable_data() + 12 * i + 3 * j) = markers[i][j];
          }
        }
        return array;
      },
      py::arg("config"),
      "(n, 4, 3) corners in the board's frame [m]: upper left, upper right, lower right, lower left, as detectors "
      "give\n"
      "them; a marker's upper edge is towards the board's +y. Raises ConfigError.");
}

void bind_frame(py::module_& m) {
  using F = FrameFromPoints;
  py::class_<F>(m, "FrameFromPoints", "Where a board lies in an arm's base frame.")
      .def_property_readonly(
          "base_T_board", [](const F& f) { return f.base_T_board; }, "(4, 4)")
      .def_property_readonly(
          "residuals", [](const F& f) { return store_points(f.residuals); },
          "(n, 3) touched - fitted, in the base's frame [m]")
      .def_readonly("rms_m", &F::rms_m, "root mean square length of the residuals [m]")
      .def_readonly("spread_m", &F::spread_m, "conditioning: RMS extent of the dots across their best line [m]")
      .def_property_readonly(
          "covariance", [](const F& f) { return store_matrix6(f.covariance); },
          "(6, 6) of saras.displacement(estimate, truth): [m, rad], in the base's axes, at the board's origin");
  const FrameFromPointsOptions defaults;
  m.def(
      "frame_from_points",
      [](const py::object& touched, const py::object& board_points, const std::optional<Vector3>& above,
         double touch_noise_m, double max_rms_m, double min_spread_m) {
        FrameFromPointsOptions options;
        options.above = above;
        options.touch_noise_m = touch_noise_m;
        options.max_rms_m = max_rms_m;
        options.min_spread_m = min_spread_m;
        return frame_from_points(load_points(touched, "touched"), load_points(board_points, "board_points"), options);
      },
      py::arg("touched"), py::arg("board_points"), py::arg("above") = py::none(),
      py::arg("touch_noise_m") = defaults.touch_noise_m, py::arg("max_rms_m") = defaults.max_rms_m,
      py::arg("min_spread_m") = defaults.min_spread_m,
      "Rigid least squares (Kabsch) of touched points (n, 3) in the base's frame [m] to the same dots (n, 3) on the\n"
      "board [m]; a dot may come more than once. above: (3,) a point on the printed side in the base's frame (the\n"
      "trocar). touch_noise_m: expected error per axis. Raises CalibrationError: fewer than 3 different dots, "
      "collinear\n"
      "(min_spread_m), another unit, another order, a touch that does not fit (max_rms_m), board seen from behind.");
  m.def(
      "frame_from_three_points",
      [](const py::object& touched) {
        const auto points = load_points(touched, "touched");
        if (points.size() != 3) {
          throw CalibrationError("touched: " + std::to_string(points.size()) + " points: must be 3");
        }
        return frame_from_three_points(points[0], points[1], points[2]);
      },
      py::arg("touched"),
      "The source document's construction, for comparison: (4, 4) with its origin in the circumcentre of three "
      "touched\n"
      "dots (3, 3) [m], x to the first, z along (second - first) x (third - first). Raises CalibrationError.");
}

}  // namespace

std::vector<Vector3> load_points(const py::object& source, const char* what) {
  const Array array = Array::ensure(source);
  if (!array || array.ndim() != 2 || array.shape(1) != 3) {
    refuse_shape(what, "(n, 3)", array);
  }
  std::vector<Vector3> points;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    points.emplace_back(Eigen::Map<const Vector3>(array.data() + 3 * i));
  }
  return points;
}

Array store_points(const std::vector<Vector3>& points) {
  Array array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Map<Vector3>(array.mutable_data() + 3 * i) = points[i];
  }
  return array;
}

std::vector<Pose> load_poses(const py::object& source, const char* what) {
  const Array array = Array::ensure(source);
  if (!array || array.ndim() != 3 || array.shape(1) != 4 || array.shape(2) != 4) {
    refuse_shape(what, "(n, 4, 4)", array);
  }
  std::vector<Pose> poses;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    Array one({4, 4});
    std::copy_n(array.data() + 16 * i, 16, one.mutable_data());
    poses.push_back(load_pose(one));
  }
  return poses;
}

Array store_matrix6(const Eigen::Matrix<double, 6, 6>& matrix) {
  Array array({6, 6});
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(array.mutable_data()) = matrix;
  return array;
}

void bind_calibration(py::module_& m) {
  bind_board(m);
  bind_frame(m);
#ifdef SARAS_WITH_CERES
  bind_calibration_hand_eye(m);
#endif
}

}  // namespace saras::bindings
