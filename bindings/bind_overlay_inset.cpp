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
  m.def(
      "stiffness_color",
      [](double share) {
        const Color c = stiffness_color(share);
        return py::make_tuple(c.r, c.g, c.b, c.mono);
      },
      py::arg("share"), "Red, green, blue, and what stands for them in mono8; share: 0 softest, 1 stiffest, NaN grey.");
  py::class_<AwarenessInset>(m, "AwarenessInset", "Draws it bottom left, into images of one size.")
      .def(py::init<int, int, const S&>(), py::arg("width_px"), py::arg("height_px"), py::arg("style") = S{},
           "Raises ConfigError.")
      .def(
          "draw",
          [](const AwarenessInset& self, const AwarenessView& view, Pixels image, const std::string& encoding,
             const Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>& dots) {
            std::vector<InsetDot> map(static_cast<std::size_t>(dots.rows()));
            for (Eigen::Index i = 0; i < dots.rows(); ++i) {
              map[static_cast<std::size_t>(i)] = {dots.row(i).head<3>().transpose(), dots(i, 3)};
            }
            AwarenessView with_map = view;
            with_map.dots = map.data();
            with_map.dot_count = static_cast<int>(map.size());
            return self.draw(with_map, view_of(image, encoding));
          },
          py::arg("view"), py::arg("image").noconvert(), py::arg("encoding"),
          py::arg("dots") = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>(0, 4),
          "dots: (n, 4) of the stiffness map, x y z [m] and share 0 to 1, NaN: not known.\n"
          "False: the image is of another size.")
      .def("place", &AwarenessInset::place, py::arg("view"), py::arg("point"), "(2,) pixel in the box of a point (3,).")
      .def_property_readonly("box", &AwarenessInset::box, "(left, top, width, height) [px]");
}

}  // namespace saras::bindings
