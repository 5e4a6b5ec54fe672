#include "law.hpp"
#include "saras/teleop/frame_mapping.hpp"

namespace saras::bindings {

void bind_frame_mapping(py::module_& m) {
  py::enum_<Mapping>(m, "Mapping", "Where base_T_console comes from.")
      .value("STATIC", Mapping::kStatic, "the configuration")
      .value("ENDOSCOPE", Mapping::kEndoscope, "each input, so that the hand moves as the picture shows");
  Struct<FrameMappingConfig>(m, "FrameMappingConfig", "Frames, filter and limits of a FrameMapping.")
      .field("mapping", &FrameMappingConfig::mapping, "Mapping.STATIC or Mapping.ENDOSCOPE")
      .field("base_T_console", &FrameMappingConfig::base_T_console,
             "(4, 4) console (simball_base) in the arm's base, for Mapping.STATIC")
      .field("touch_T_console", &FrameMappingConfig::touch_T_console,
             "(4, 4) console in the frame in which the device takes forces; its rotation is used")
      .field("cutoff_hz", &FrameMappingConfig::cutoff_hz, "cut-off of the low-pass behind tracked_twist_filtered [Hz]")
      .field("dt_max_s", &FrameMappingConfig::dt_max_s, "a longer interval re-references like a clutch [s]");
  Struct<FrameMappingOutput>(m, "FrameMappingOutput",
                             "Result of FrameMapping.step. Twists are means over interval_s, in base axes.")
      .field("has_pose", &FrameMappingOutput::has_pose, "pose and twists are new: publish them")
      .field("has_wrench", &FrameMappingOutput::has_wrench, "touch_wrench is new: publish it")
      .field("tracked_pose", &FrameMappingOutput::tracked_pose, "(4, 4) base_T_tracked, never jumps")
      .field("tracked_twist", &FrameMappingOutput::tracked_twist, "(6,) of tracked_pose [m/s, rad/s]; 0 under clutch")
      .field("tracked_twist_filtered", &FrameMappingOutput::tracked_twist_filtered, "(6,) low-passed")
      .field("handle_twist", &FrameMappingOutput::handle_twist,
             "(6,) of the handle, also under clutch and over gaps: bill energy with it")
      .field("touch_wrench", &FrameMappingOutput::touch_wrench, "(6,) for the hand in touch axes [N, N m]")
      .field("interval_s", &FrameMappingOutput::interval_s, "time that the twists span [s]")
      .field("gap", &FrameMappingOutput::gap, "interval_s was above dt_max_s: re-referenced")
      .field("status", &FrameMappingOutput::status, "saras.Status");
  Struct<FrameMappingState>(m, "FrameMappingState", "All that a FrameMapping remembers.")
      .field("has_reference", &FrameMappingState::has_reference, "whether a pose was seen")
      .field("base_T_reference", &FrameMappingState::base_T_reference, "(4, 4) tracked pose at the reference")
      .field("console_T_reference", &FrameMappingState::console_T_reference, "(4, 4) handle at the reference")
      .field("base_T_console", &FrameMappingState::base_T_console, "(4, 4) mapping in use")
      .field("console_T_previous", &FrameMappingState::console_T_previous, "(4, 4) handle at the last good input")
      .field("base_T_tracked", &FrameMappingState::base_T_tracked, "(4, 4) last tracked pose")
      .field("tracked_twist_filtered", &FrameMappingState::tracked_twist_filtered, "(6,) filter state")
      .field("elapsed_s", &FrameMappingState::elapsed_s, "time since the last good input [s]");
  py::class_<FrameMapping>(m, "FrameMapping",
                           "Handle pose and twist from the console's frame to the arm's base frame, wrench back.")
      .def(py::init<FrameMappingConfig>(), py::arg("config") = FrameMappingConfig{})
      .def(
          "step",
          [](FrameMapping& self, const Pose& console_T_handle, double dt, bool clutch, const Wrench& base_wrench,
             const std::optional<Pose>& base_T_console, bool stale) {
            return self.step({console_T_handle, clutch, base_wrench, base_T_console, stale}, dt);
          },
          py::arg("console_T_handle"), py::arg("dt"), py::arg("clutch") = false, py::arg("base_wrench") = Wrench{},
          py::arg("base_T_console") = py::none(), py::arg("stale") = false,
          "One tick.\n\n"
          "console_T_handle: (4, 4) measured handle in simball_base. dt: since the previous step [s].\n"
          "base_wrench: (6,) for the hand in base axes. base_T_console: (4, 4), needed by Mapping.ENDOSCOPE.\n"
          "stale: the pose is older than its limit. Publish only what has_pose and has_wrench allow.")
      .def("reset", &FrameMapping::reset, py::arg("state") = FrameMappingState{}, "Without argument: new reference.")
      .def_property_readonly("config", [](const FrameMapping& self) { return self.config(); })
      .def_property_readonly("state", [](const FrameMapping& self) { return self.state(); });
}

}  // namespace saras::bindings
