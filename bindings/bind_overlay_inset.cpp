#include "bind_overlay.hpp"
#include "saras/overlay/awareness_inset.hpp"

namespace saras::bindings {

void bind_overlay_inset(py::module_& m) {
  using S = AwarenessInsetStyle;
  Struct<S>(m, "AwarenessInsetStyle", "How the inset of situational awareness looks.")
      .field("width", &S::width, "as a share of the image's width")
      .field("span_m", &S::span_m, "so wide is what it shows [m]")
      .field("azimuth_rad", &S::azimuth_rad, "from where it is seen, about the base's z [rad]")
      .field("elevation_rad", &S::elevation_rad, "above the plane [rad]")
      .field("arrow_m_per_N", &S::arrow_m_per_N, "length of the force's arrow [m/N]")
      .field("least_force_N", &S::least_force_N, "no arrow below it [N]");
  py::class_<AwarenessView>(m, "AwarenessView", "What the inset shows, in the slave's base; not finite: not known.")
      .def(py::init([] { return AwarenessView{}; }))
      .def_readwrite("known", &AwarenessView::known, "else only a grey text")
      .def_readwrite("hold", &AwarenessView::hold)
      .def_readwrite("center", &AwarenessView::center, "(3,) middle of what is shown [m]")
      .def_readwrite("tip", &AwarenessView::tip, "(3,) of the slave, white [m]")
      .def_readwrite("proxy", &AwarenessView::proxy, "(3,) green [m]")
      .def_readwrite("closest", &AwarenessView::closest, "(3,) of the model to the proxy, red [m]")
      .def_readwrite("normal", &AwarenessView::normal, "(3,) of the model there")
      .def_readwrite("force_N", &AwarenessView::force_N, "(3,) on the hand [N]")
      .def_readwrite("region_closed", &AwarenessView::region_closed)
      .def_property(
          "text", [](const AwarenessView& self) { return std::string(self.text.view()); },
          [](AwarenessView& self, const std::string& text) { self.text = ShortText(text); })
      .def_property(
          "region",
          [](const AwarenessView& self) {
            Eigen::Matrix<double, Eigen::Dynamic, 3> corners(self.region_corners, 3);
            for (int i = 0; i < self.region_corners; ++i) {
              corners.row(i) = self.region[static_cast<std::size_t>(i)].transpose();
            }
            return corners;
          },
          [](AwarenessView& self, const Eigen::Matrix<double, Eigen::Dynamic, 3>& corners) {
            if (corners.rows() > kMaxRegionCorners) {
              throw py::value_error("region: " + std::to_string(corners.rows()) + " corners: at most " +
                                    std::to_string(kMaxRegionCorners));
            }
            self.region_corners = static_cast<int>(corners.rows());
            for (int i = 0; i < self.region_corners; ++i) {
              self.region[static_cast<std::size_t>(i)] = corners.row(i).transpose();
            }
          },
          "(n, 3) corners [m], at most 64");
  py::class_<AwarenessInset>(m, "AwarenessInset", "Draws it bottom left, into images of one size.")
      .def(py::init<int, int, const S&>(), py::arg("width_px"), py::arg("height_px"), py::arg("style") = S{},
           "Raises ConfigError.")
      .def(
          "draw",
          [](const AwarenessInset& self, const AwarenessView& view, Pixels image, const std::string& encoding) {
            return self.draw(view, view_of(image, encoding));
          },
          py::arg("view"), py::arg("image").noconvert(), py::arg("encoding"), "False: the image is of another size.")
      .def("place", &AwarenessInset::place, py::arg("view"), py::arg("point"), "(2,) pixel in the box of a point (3,).")
      .def_property_readonly("box", &AwarenessInset::box, "(left, top, width, height) [px]");
}

}  // namespace saras::bindings
