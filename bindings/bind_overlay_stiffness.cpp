#include "bind_overlay.hpp"
#include "saras/overlay/stiffness_overlay.hpp"

namespace saras::bindings {
namespace {

using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

bool draw(StiffnessOverlay& self, const Positions& vertices, const Eigen::VectorXd& stiffness,
          const Eigen::VectorXd& std_N_m, const Triangles& triangles, const Pose& left_T_map, Pixels image,
          const std::string& encoding) {
  if (stiffness.size() != vertices.rows() || std_N_m.size() != vertices.rows()) {
    throw py::value_error("stiffness, std: " + std::to_string(stiffness.size()) + " and " +
                          std::to_string(std_N_m.size()) + " numbers for " + std::to_string(vertices.rows()) +
                          " vertices");
  }
  std::vector<MapVertex> corners(static_cast<std::size_t>(vertices.rows()));
  for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
    corners[static_cast<std::size_t>(i)] = {vertices.row(i).transpose(), stiffness[i], std_N_m[i]};
  }
  std::vector<MapTriangle> faces(static_cast<std::size_t>(triangles.rows()));
  for (Eigen::Index i = 0; i < triangles.rows(); ++i) {
    faces[static_cast<std::size_t>(i)] = {triangles(i, 0), triangles(i, 1), triangles(i, 2)};
  }
  StiffnessMapView map;
  map.vertices = corners.data();
  map.vertex_count = static_cast<int>(corners.size());
  map.triangles = faces.data();
  map.triangle_count = static_cast<int>(faces.size());
  map.left_T_map = left_T_map;
  return self.draw(map, view_of(image, encoding));
}

}  // namespace

void bind_overlay_stiffness(py::module_& m) {
  using S = StiffnessOverlayStyle;
  Struct<S>(m, "StiffnessOverlayStyle", "How the stiffness map looks on the organ.")
      .field("low_N_m", &S::low_N_m, "dark end of the colours [N/m]")
      .field("high_N_m", &S::high_N_m, "yellow end [N/m]")
      .field("opacity", &S::opacity, "where it is sure")
      .field("uncertain_std_N_m", &S::uncertain_std_N_m, "such a deviation is as faint as what is not known [N/m]")
      .field("faint_opacity", &S::faint_opacity, "of what is unsure, and of the grey of what is not known")
      .field("bar", &S::bar, "the colour bar");
  py::class_<StiffnessOverlay>(m, "StiffnessOverlay",
                               "Draws the stiffness map over the organ in one eye's image: opacity says how sure.")
      .def(py::init<const CameraConfig&, const S&>(), py::arg("camera"), py::arg("style") = S{}, "Raises ConfigError.")
      .def("draw", &draw, py::arg("vertices"), py::arg("stiffness"), py::arg("std"), py::arg("triangles"),
           py::arg("left_T_map"), py::arg("image").noconvert(), py::arg("encoding"),
           "vertices (n, 3) [m], stiffness (n,) [N/m], std (n,) [N/m]; NaN or infinite: not known; triangles (m, 3);\n"
           "left_T_map (4, 4) to the rectified left optical frame. False: the image is of another size.")
      .def(
          "draw_unknown",
          [](const StiffnessOverlay& self, Pixels image, const std::string& encoding) {
            return self.draw_unknown(view_of(image, encoding));
          },
          py::arg("image").noconvert(), py::arg("encoding"),
          "Says that there is no map. False: the image is of another size.")
      .def_property_readonly("bar", &StiffnessOverlay::bar, "(left, top, width, height) of the colour bar [px].");
}

}  // namespace saras::bindings
