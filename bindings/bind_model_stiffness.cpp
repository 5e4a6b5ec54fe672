#include "bind_model.hpp"
#include "saras/model/stiffness_gp.hpp"

namespace saras::bindings {
namespace {

void bind_config(py::module_& m) {
  using C = StiffnessGpConfig;
  Struct<C>(m, "StiffnessGpConfig", "Bounds and gates of StiffnessGp.")
      .field("grid", &C::grid, "HashGridConfig")
      .field("local", &C::local, "LocalModelConfig")
      .field("recenter_m", &C::recenter_m, "the local model is built anew this far from its centre [m]")
      .field("contact_force_N", &C::contact_force_N, "below it nothing is touched [N]")
      .field("force_limit_N", &C::force_limit_N, "above it no tissue was meant [N]")
      .field("workspace_m", &C::workspace_m, "greatest |coordinate| of a tip [m]")
      .field("speed_limit_m_s", &C::speed_limit_m_s, "of a tip between two samples [m/s]")
      .field("outlier_sigma", &C::outlier_sigma, "further from the prediction is an outlier; infinite: nothing is")
      .field("outlier_patience", &C::outlier_patience, "so many in a row: the tissue is another one")
      .field("bias_time_constant_s", &C::bias_time_constant_s, "of the sensor's offset, taken in free air [s]")
      .field("bias_limit_N", &C::bias_limit_N, "a greater offset is a sensor that drifted [N]")
      .field("agreement_time_constant_s", &C::agreement_time_constant_s, "over which disagreement is averaged [s]")
      .field("agreement_limit", &C::agreement_limit, "mean deviation [sigma] above which map and tissue disagree")
      .field("dt_max_s", &C::dt_max_s, "longest time step [s]");
  py::enum_<TouchBelief>(m, "TouchBelief", "What somebody else knows of the tip.")
      .value("UNKNOWN", TouchBelief::kUnknown)
      .value("FREE", TouchBelief::kFree)
      .value("TOUCHING", TouchBelief::kTouching);
  py::enum_<SampleVerdict>(m, "SampleVerdict", "What became of a sample.")
      .value("LEARNED", SampleVerdict::kLearned)
      .value("NOT_TOUCHING", SampleVerdict::kNotTouching)
      .value("OUTLIER", SampleVerdict::kOutlier)
      .value("RELEARNED", SampleVerdict::kRelearned)
      .value("SENSOR_DRIFT", SampleVerdict::kSensorDrift)
      .value("IMPLAUSIBLE_POSITION", SampleVerdict::kImplausiblePosition)
      .value("IMPLAUSIBLE_FORCE", SampleVerdict::kImplausibleForce)
      .value("INVALID", SampleVerdict::kInvalid);
}

void bind_results(py::module_& m) {
  using O = StiffnessGpOutput;
  Struct<O>(m, "StiffnessGpOutput", "Result of StiffnessGp.step.")
      .field("estimate", &O::estimate, "SurfaceEstimate under the tip")
      .field("verdict", &O::verdict, "SampleVerdict")
      .field("disagrees", &O::disagrees, "the tissue is not, or no longer, what the map says")
      .field("disagreement", &O::disagreement, "mean deviation of the samples from the map [sigma]")
      .field("bias_N", &O::bias_N, "(3,) the sensor's offset that was subtracted [N]")
      .field("status", &O::status, "WAITING: nothing known here; LIMITED: known, this sample was not learned");
  using S = StiffnessGpState;
  py::class_<S>(m, "StiffnessGpState", "All that StiffnessGp remembers; copyable.")
      .def(py::init<const S&>(), py::arg("other"))
      .def_property_readonly(
          "grid", [](const S& self) { return self.grid; }, "a copy of the HashGrid")
      .def_readonly("bias_N", &S::bias_N)
      .def_readonly("disagreement", &S::disagreement)
      .def_readonly("refused", &S::refused, "samples that should have been learned and were not");
}

}  // namespace

void bind_model_stiffness(py::module_& m) {
  bind_config(m);
  bind_results(m);
  using L = StiffnessGp;
  py::class_<L>(m, "StiffnessGp", "Stiffness and surface from what the tool feels, one sample at a time.")
      .def(py::init<StiffnessGpConfig>(), py::arg("config") = StiffnessGpConfig{}, "Raises ConfigError.")
      .def(
          "step",
          [](L& self, const Vector3& tip_position, const Vector3& force, Seconds dt, const Vector3& tip_velocity,
             TouchBelief belief) {
            return self.step({tip_position, force, tip_velocity, belief}, dt);
          },
          py::arg("tip_position"), py::arg("force"), py::arg("dt"), py::arg("tip_velocity") = Vector3(Vector3::Zero()),
          py::arg("belief") = TouchBelief::kUnknown,
          "One sample: (3,) tip [m], (3,) force that the tool exerts on the tissue [N], (3,) velocity [m/s] (zero: "
          "not\n"
          "known), in the base frame.")
      .def(
          "steps",
          [](L& self, const py::object& positions, const py::object& forces, Seconds dt, const py::object& velocities) {
            const auto x = load_rows(positions, "positions");
            const auto f = load_rows(forces, "forces");
            const auto v = velocities.is_none() ? std::vector<Vector3>(x.size(), Vector3::Zero())
                                                : load_rows(velocities, "velocities");
            if (x.size() != f.size() || x.size() != v.size()) {
              throw py::value_error("positions, forces, velocities: expected as many rows, got " +
                                    std::to_string(x.size()) + ", " + std::to_string(f.size()) + ", " +
                                    std::to_string(v.size()));
            }
            std::vector<SurfaceEstimate> estimates(x.size());
            py::array_t<std::uint8_t> verdicts(static_cast<py::ssize_t>(x.size()));
            std::uint8_t* verdict = verdicts.mutable_data();
            {
              const py::gil_scoped_release release;
              for (std::size_t i = 0; i < x.size(); ++i) {
                const StiffnessGpOutput output = self.step({x[i], f[i], v[i], TouchBelief::kUnknown}, dt);
                estimates[i] = output.estimate;
                verdict[i] = static_cast<std::uint8_t>(output.verdict);
              }
            }
            return py::make_tuple(verdicts, store_estimates(estimates));
          },
          py::arg("positions"), py::arg("forces"), py::arg("dt"), py::arg("velocities") = py::none(),
          "A recording at a fixed rate, (n, 3) each: verdicts (n,) as numbers of SampleVerdict, and estimates as\n"
          "estimate_surfaces gives them.")
      .def("reset", py::overload_cast<>(&L::reset))
      .def("reset", py::overload_cast<const StiffnessGpState&>(&L::reset), py::arg("state"))
      .def("adopt", &L::adopt, py::arg("hyperparameters"),
           "Takes over what was learned off the control thread. Raises ConfigError.")
      .def_property_readonly("config", [](const L& self) { return self.config(); })
      .def_property_readonly(
          "work", [](const L& self) { return self.state().local.process().work(); },
          "covariances and multiplications so far")
      .def_property_readonly(
          "grid", [](const L& self) -> const HashGrid& { return self.state().grid; },
          py::return_value_policy::reference_internal, "the live HashGrid, not a copy")
      .def_property_readonly(
          "state", [](const L& self) { return self.state(); }, "a copy");
}

}  // namespace saras::bindings
