#include "law.hpp"
#include "saras/teleop/disturbance_observer.hpp"

namespace saras::bindings {

void bind_disturbance_observer(py::module_& m) {
  using Config = DisturbanceObserverConfig;
  using State = DisturbanceObserverState;
  Struct<Config>(m, "DisturbanceObserverConfig", "Servo model and filter of a DisturbanceObserver.")
      .field("natural_frequency_rad_s", &Config::natural_frequency_rad_s, "of the arm's servo [rad/s]")
      .field("damping_ratio", &Config::damping_ratio, "of the arm's servo, [0.1, 10]")
      .field("mass_kg", &Config::mass_kg, "effective mass at the tip [kg]")
      .field("cutoff_hz", &Config::cutoff_hz, "of the second-order low-pass on the force [Hz]")
      .field("deadband_N", &Config::deadband_N, "below it none, exact above twice it [N]")
      .field("settle_s", &Config::settle_s, "no estimate for this long after a (re)start [s]")
      .field("dt_max_s", &Config::dt_max_s, "a longer gap restarts the observer [s]");
  Struct<DisturbanceObserverOutput>(m, "DisturbanceObserverOutput", "Result of DisturbanceObserver.step.")
      .field("has_wrench", &DisturbanceObserverOutput::has_wrench, "otherwise the wrench is unknown, not zero")
      .field("wrench", &DisturbanceObserverOutput::wrench, "(6,) exerted on the tissue [N, 0]")
      .field("status", &DisturbanceObserverOutput::status, "saras.Status");
  Struct<State>(m, "DisturbanceObserverState", "All that a DisturbanceObserver remembers.")
      .field("started", &State::started, "whether an input was seen")
      .field("free_position", &State::free_position, "(3,) tip of the model in free motion [m]")
      .field("free_velocity", &State::free_velocity, "(3,) its velocity [m/s]")
      .field("error", &State::error, "(3,) measured - free_position [m]")
      .field("error_filtered", &State::error_filtered, "(3,) low-passed [m]")
      .field("error_rate_filtered", &State::error_rate_filtered, "(3,) its rate [m/s]")
      .field("elapsed_s", &State::elapsed_s, "time since the last good input [s]")
      .field("settled_s", &State::settled_s, "time since the (re)start, up to settle_s [s]");
  py::class_<DisturbanceObserver>(m, "DisturbanceObserver",
                                  "Wrench on the tissue from the arm's servo model, without the lag of free motion.")
      .def(py::init<Config>(), py::arg("config") = Config{})
      .def(
          "step",
          [](DisturbanceObserver& self, const Vector3& set_point, const Vector3& measured, double dt, bool stale) {
            return self.step({set_point, measured, stale}, dt);
          },
          py::arg("set_point"), py::arg("measured"), py::arg("dt"), py::arg("stale") = false,
          "One tick; base frame of the arm.\n\n"
          "set_point: (3,) tip position that the arm followed since the previous step [m]. measured: (3,) tip now "
          "[m].\n"
          "dt: since the previous step [s]. stale: either of them is older than its limit.")
      .def("reset", &DisturbanceObserver::reset, py::arg("state") = State{})
      .def_property_readonly("config", [](const DisturbanceObserver& self) { return self.config(); })
      .def_property_readonly("state", [](const DisturbanceObserver& self) { return self.state(); });
}

}  // namespace saras::bindings
