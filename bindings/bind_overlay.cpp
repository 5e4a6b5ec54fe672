#include "bind_overlay.hpp"

#include "rooms.hpp"
#include "saras/overlay/image_watch.hpp"
#include "saras/overlay/pinhole.hpp"

namespace saras::bindings {

ImageView view_of(Pixels& pixels, const std::string& encoding, bool drawn_on) {
  ImageView view;
  if (!parse_encoding(encoding, view.format)) {
    throw py::value_error("encoding = '" + encoding + "': must be bgr8, rgb8, mono8, bgra8 or rgba8");
  }
  const int n = channels(view.format);
  const bool flat = n == 1 && pixels.ndim() == 2;
  const bool dense =
      flat ? pixels.strides(1) == 1
           : pixels.ndim() == 3 && pixels.shape(2) == n && pixels.strides(2) == 1 && pixels.strides(1) == n;
  if (!dense || pixels.strides(0) < 0) {
    throw py::value_error("image: expected uint8 (height, width" + std::string(n == 1 ? "" : ", " + std::to_string(n)) +
                          ") with dense rows for " + encoding + ", got shape " + shape_text(pixels));
  }
  // A picture that is only looked at may be read-only, as those of a camera are.
  view.data = drawn_on ? pixels.mutable_data() : const_cast<std::uint8_t*>(pixels.data());
  view.height = static_cast<int>(pixels.shape(0));
  view.width = static_cast<int>(pixels.shape(1));
  view.stride = static_cast<std::size_t>(pixels.strides(0));
  return view;
}

void bind_overlay_camera(py::module_& m) {
  using C = CameraConfig;
  Struct<C>(m, "CameraConfig", "A calibrated camera, as sensor_msgs/CameraInfo and OpenCV have it.")
      .field("width_px", &C::width_px, "of the image that was calibrated")
      .field("height_px", &C::height_px, "")
      .field("K", &C::K, "(3, 3) of the raw image [px]")
      .field("R", &C::R, "(3, 3) rectified_R_raw")
      .field("P", &C::P, "(3, 4) of the rectified image; the right eye's holds the baseline")
      .field("distortion", &C::distortion, "8 numbers: k1 k2 p1 p2 k3 (plumb_bob) k4 k5 k6 (rational_polynomial)")
      .field("rectified", &C::rectified, "drawn on are rectified images; else raw ones")
      .field("near_m", &C::near_m, "nothing nearer is drawn [m]");
  py::class_<PinholeEye>(m, "PinholeEye", "Points of the rectified left optical frame in the pixels of one eye.")
      .def(py::init<const C&>(), py::arg("config"))
      .def(
          "project",
          [](const PinholeEye& self, const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>& points) {
            Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> pixels(points.rows(), 2);
            for (Eigen::Index i = 0; i < points.rows(); ++i) {
              Pixel pixel = Pixel::Constant(std::numeric_limits<double>::quiet_NaN());
              self.project(points.row(i).transpose(), pixel);
              pixels.row(i) = pixel.transpose();
            }
            return pixels;
          },
          py::arg("points"), "(n, 2) pixels of (n, 3) points [m]; NaN: behind, too near, or beyond the lens model.")
      .def(
          "project_line",
          [](const PinholeEye& self, const Vector3& a, const Vector3& b, double margin_px) {
            const ProjectedLine line = self.project_line(a, b, margin_px);
            Array pieces({line.count, 2, 3});
            auto out = pieces.mutable_unchecked<3>();
            for (int i = 0; i < line.count; ++i) {
              const LinePiece& piece = line.pieces[static_cast<std::size_t>(i)];
              const double numbers[2][3] = {{piece.a.x(), piece.a.y(), piece.depth_a_m},
                                            {piece.b.x(), piece.b.y(), piece.depth_b_m}};
              for (int end = 0; end < 2; ++end) {
                for (int k = 0; k < 3; ++k) {
                  out(i, end, k) = numbers[end][k];
                }
              }
            }
            return pieces;
          },
          py::arg("a"), py::arg("b"), py::arg("margin_px") = 0.0,
          "(n, 2, 3): both ends of each visible piece of the segment: column, row [px], depth [m].")
      .def_property_readonly("config", [](const PinholeEye& self) { return self.config(); });
}

void bind_overlay_watch(py::module_& m) {
  m.def(
      "fingerprint",
      [](Pixels image, const std::string& encoding) { return fingerprint(view_of(image, encoding, false)); },
      py::arg("image"), py::arg("encoding"), "A number that changes when any pixel does.");
  Struct<FrozenWatchConfig>(m, "FrozenWatchConfig", "When a picture counts as frozen.")
      .field("frozen_after_s", &FrozenWatchConfig::frozen_after_s, "the same picture for so long [s]");
  using O = FrozenWatchOutput;
  Struct<O>(m, "FrozenWatchOutput", "Result of FrozenWatch.step.")
      .field("frozen", &O::frozen, "")
      .field("unchanged_s", &O::unchanged_s, "since the picture changed [s]")
      .field("status", &O::status, "STALE: frozen");
  py::class_<FrozenWatch>(m, "FrozenWatch", "Whether a camera gives the same picture again and again.")
      .def(py::init<FrozenWatchConfig>(), py::arg("config") = FrozenWatchConfig{})
      .def(
          "step", [](FrozenWatch& self, std::uint64_t fingerprint, Seconds dt) { return self.step({fingerprint}, dt); },
          py::arg("fingerprint"), py::arg("dt"), "One image; dt: since the one before [s].");
  py::enum_<EyeSide>(m, "EyeSide", "Whose image.")
      .value("LEFT", EyeSide::kLeft)
      .value("RIGHT", EyeSide::kRight)
      .value("NONE", EyeSide::kNone);
  using P = StereoPairingConfig;
  Struct<P>(m, "StereoPairingConfig", "Which two images are of one moment.")
      .field("max_skew_s", &P::max_skew_s, "their stamps differ by no more [s]")
      .field("wait_s", &P::wait_s, "so long an image waits for the other eye's [s]");
  using Q = StereoPairingOutput;
  Struct<Q>(m, "StereoPairingOutput", "Which images leave now.")
      .field("waiting_alone", &Q::waiting_alone, "(left, right): the one that was waiting stays without a partner")
      .field("pair", &Q::pair, "the one that came and the waiting one of the other eye")
      .field("arrived_alone", &Q::arrived_alone, "the one that came is too old for the other eye's")
      .field("status", &Q::status, "STALE: one stays alone");
  py::class_<StereoPairing>(m, "StereoPairing", "Pairs the images of two eyes by their stamps.")
      .def(py::init<P>(), py::arg("config") = P{})
      .def(
          "step",
          [](StereoPairing& self, EyeSide arrived, std::int64_t stamp_ns, Seconds dt) {
            return self.step({arrived, stamp_ns}, dt);
          },
          py::arg("arrived"), py::arg("stamp_ns"), py::arg("dt"),
          "One image, or (NONE) only time; dt: since the last.");
}

void bind_overlay(py::module_& m) {
  bind_overlay_camera(m);
  bind_overlay_watch(m);
  bind_overlay_tools(m);
  bind_overlay_inset(m);
  bind_overlay_stiffness(m);
}

}  // namespace saras::bindings
