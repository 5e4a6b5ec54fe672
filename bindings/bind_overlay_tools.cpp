#include <algorithm>

#include "bind_overlay.hpp"
#include "saras/overlay/overlay_painter.hpp"

namespace saras::bindings {
namespace {

template <typename T>
void name_field(Struct<T>& bound, const char* doc) {
  bound.field(
      "name", [](const T& self) { return std::string(self.name.view()); },
      [](T& self, const std::string& name) { self.name = ShortText(name); }, doc);
}

void bind_marks(py::module_& m) {
  using T = OverlayTool;
  Struct<T> tool(m, "OverlayTool", "A tool as last heard of, in the world.");
  name_field(tool, "as it is written on the image");
  tool.field("tip", &T::tip, "(3,) [m]; NaN: unknown")
      .field("trocar", &T::trocar, "(3,) remote centre [m]")
      .field("distance_m", &T::distance_m, "to the nearest thing; NaN: unknown; inf: nothing there")
      .field("state", &T::state, "colliding_regions' own word")
      .field("known_distance_m", &T::known_distance_m, "between the two points; NaN: none")
      .field("on_tool", &T::on_tool, "(3,) nearest point on the tool [m]")
      .field("on_partner", &T::on_partner, "(3,) and on what it is near to [m]");
  using M = ToolMark;
  Struct<M> mark(m, "ToolMark", "What is drawn of one tool, in the rectified left optical frame.");
  name_field(mark, "");
  mark.field("level", &M::level, "its colour")
      .field("distance_m", &M::distance_m, "NaN: unknown")
      .field("placed", &M::placed, "tip and trocar are known")
      .field("tip", &M::tip, "(3,) [m]")
      .field("trocar", &M::trocar, "(3,) [m]")
      .field("witness", &M::witness, "the two points are known and near")
      .field("on_tool", &M::on_tool, "(3,) [m]")
      .field("on_partner", &M::on_partner, "(3,) [m]");
}

void bind_law(py::module_& m) {
  using C = ToolOverlayConfig;
  Struct<C>(m, "ToolOverlayConfig", "Thresholds of the colours, and how old things may be.")
      .field("collision_m", &C::collision_m, "at most this far is red [m]")
      .field("warning_m", &C::warning_m, "below it is yellow [m]")
      .field("hysteresis_m", &C::hysteresis_m, "a colour is left this much further out [m]")
      .field("witness_below_m", &C::witness_below_m, "nearer than this the nearest points are shown [m]")
      .field("distances_timeout_s", &C::distances_timeout_s, "older distances are unknown [s]")
      .field("tools_timeout_s", &C::tools_timeout_s, "older tools are unknown [s]")
      .field("camera_timeout_s", &C::camera_timeout_s, "an older pose of the camera is unknown [s]");
  using O = ToolOverlayOutput;
  py::class_<O>(m, "ToolOverlayOutput", "Result of ToolOverlay.step.")
      .def_property_readonly(
          "tools",
          [](const O& self) { return std::vector<ToolMark>(self.tools.begin(), self.tools.begin() + self.count); },
          "a ToolMark each")
      .def_readonly("camera_known", &O::camera_known, "false: nothing is placed")
      .def_readonly("status", &O::status, "STALE: some tool is unknown");
  py::class_<ToolOverlay>(m, "ToolOverlay", "Green, yellow, red or grey for each tool. Unknown is never green.")
      .def(py::init<C>(), py::arg("config") = C{})
      .def(
          "step",
          [](ToolOverlay& self, const std::vector<OverlayTool>& tools, const Pose& camera_T_world,
             Seconds distances_age_s, Seconds tools_age_s, Seconds camera_age_s, Seconds dt) {
            if (tools.size() > kMaxTools) {
              throw py::value_error("tools: " + std::to_string(tools.size()) + " are more than " +
                                    std::to_string(kMaxTools));
            }
            ToolOverlayInput input;
            std::copy(tools.begin(), tools.end(), input.tools.begin());
            input.count = static_cast<int>(tools.size());
            input.camera_T_world = camera_T_world;
            input.distances_age_s = distances_age_s;
            input.tools_age_s = tools_age_s;
            input.camera_age_s = camera_age_s;
            return self.step(input, dt);
          },
          py::arg("tools"), py::arg("camera_T_world"), py::arg("distances_age_s"), py::arg("tools_age_s"),
          py::arg("camera_age_s"), py::arg("dt"),
          "One tick. tools: OverlayTool each; camera_T_world: (4, 4) into the rectified left optical frame; ages [s].")
      .def("reset", [](ToolOverlay& self) { self.reset(); })
      .def_property_readonly("config", [](const ToolOverlay& self) { return self.config(); });
}

}  // namespace

void bind_overlay_tools(py::module_& m) {
  bind_marks(m);
  bind_law(m);
  using S = OverlayStyle;
  Struct<S>(m, "OverlayStyle", "How the overlay looks.")
      .field("line_m", &S::line_m, "a shaft's line is as thick as this would look there [m]")
      .field("least_line_px", &S::least_line_px, "bound of that, for an image 480 rows high [px]")
      .field("greatest_line_px", &S::greatest_line_px, "the other bound [px]")
      .field("ruler_step_m", &S::ruler_step_m, "ticks along the shaft from the tip on [m]; 0: none")
      .field("ruler_ticks", &S::ruler_ticks, "how many")
      .field("text_height", &S::text_height, "of a capital, as a share of the image's height")
      .field("panel", &S::panel, "the list of all tools");
  py::enum_<OverlayNotice>(m, "OverlayNotice", "Why there is no overlay, or what is wrong with the picture.")
      .value("NONE", OverlayNotice::kNone)
      .value("FROZEN", OverlayNotice::kFrozen)
      .value("OUT_OF_STEP", OverlayNotice::kOutOfStep)
      .value("NO_INTRINSICS", OverlayNotice::kNoIntrinsics)
      .value("SIZE_DIFFERS", OverlayNotice::kSizeDiffers)
      .value("NO_CAMERA_POSE", OverlayNotice::kNoCameraPose);
  py::class_<OverlayPainter>(m, "OverlayPainter", "Draws what ToolOverlay says into the image of one eye.")
      .def(py::init<const CameraConfig&, const OverlayStyle&>(), py::arg("camera"), py::arg("style") = OverlayStyle{})
      .def(
          "draw",
          [](const OverlayPainter& self, const ToolOverlayOutput& tools, Pixels image, const std::string& encoding) {
            return self.draw(tools, view_of(image, encoding));
          },
          py::arg("tools"), py::arg("image").noconvert(), py::arg("encoding"),
          "Draws in place; False, and nothing drawn: the image is not of the camera's size.\n"
          "image: uint8 (height, width[, channels]); encoding: bgr8, rgb8, mono8, bgra8 or rgba8.");
  m.def(
      "draw_notice",
      [](OverlayNotice notice, Pixels image, const std::string& encoding) {
        static const NoticePainter painter;
        painter.draw(notice, view_of(image, encoding));
      },
      py::arg("notice"), py::arg("image").noconvert(), py::arg("encoding"), "Writes a notice on an image, in place.");
  m.def(
      "color_of",
      [](ProximityState level) {
        const Color c = color_of(level);
        return py::make_tuple(c.r, c.g, c.b, c.mono);
      },
      py::arg("level"), "Red, green, blue, and what stands for them in mono8, each 0 to 255.");
}

}  // namespace saras::bindings
