#include "law.hpp"
#include "saras/teleop/twist_estimator.hpp"

namespace saras::bindings {

void bind_twist_estimator(py::module_& m) {
  Struct<TwistEstimatorConfig>(m, "TwistEstimatorConfig", "Limits and filter of a TwistEstimator.")
      .field("cutoff_hz", &TwistEstimatorConfig::cutoff_hz, "cut-off of the low-pass behind twist_filtered [Hz]")
      .field("dt_max_s", &TwistEstimatorConfig::dt_max_s, "longest interval that still gives a twist [s]");
  Struct<TwistEstimatorOutput>(m, "TwistEstimatorOutput", "Result of TwistEstimator.step.")
      .field("twist", &TwistEstimatorOutput::twist, "(6,) displacement / dt in the base frame [m/s, rad/s]")
      .field("twist_filtered", &TwistEstimatorOutput::twist_filtered, "(6,) low-passed, for damping and display")
      .field("status", &TwistEstimatorOutput::status, "saras.Status");
  Struct<TwistEstimatorState>(m, "TwistEstimatorState", "All that a TwistEstimator remembers.")
      .field("has_previous", &TwistEstimatorState::has_previous, "whether a pose was seen")
      .field("base_T_previous", &TwistEstimatorState::base_T_previous, "(4, 4) last pose")
      .field("twist_filtered", &TwistEstimatorState::twist_filtered, "(6,) filter state");
  py::class_<TwistEstimator>(m, "TwistEstimator",
                             "Mean twist of a moving frame over each interval, raw and low-passed.")
      .def(py::init<TwistEstimatorConfig>(), py::arg("config") = TwistEstimatorConfig{})
      .def(
          "step", [](TwistEstimator& self, const Pose& base_T_body, double dt) { return self.step({base_T_body}, dt); },
          py::arg("base_T_body"), py::arg("dt"), "One tick: the (4, 4) pose now, dt [s] since the last one.")
      .def("reset", &TwistEstimator::reset, py::arg("state") = TwistEstimatorState{})
      .def_property_readonly("state", [](const TwistEstimator& self) { return self.state(); });
}

}  // namespace saras::bindings
