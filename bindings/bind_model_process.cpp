#include "bind_model.hpp"

namespace saras::bindings {
namespace {

void bind_local_gp(py::module_& m) {
  using P = GpPrediction;
  py::class_<P>(m, "GpPrediction", "Posterior of the force and its gradient at a point.")
      .def_readonly("mean", &P::mean, "[N]")
      .def_readonly("variance", &P::variance, "without the noise of a sample [N^2]")
      .def_readonly("gradient", &P::gradient, "(3,) [N/m]")
      .def_readonly("gradient_covariance", &P::gradient_covariance, "(3, 3) [N^2/m^2]");
  using G = LocalGp;
  py::class_<G>(m, "LocalGp", "Gaussian process that grows and shrinks one sample at a time, up to its capacity.")
      .def(py::init<int, GpHyperparameters>(), py::arg("capacity") = 64,
           py::arg("hyperparameters") = GpHyperparameters{}, "Raises ConfigError.")
      .def("restart", &G::restart, py::arg("origin"), py::arg("normal"),
           "Empties it; origin (3,) [m], normal (3,) unit, outward.")
      .def(
          "append",
          [](G& self, const Vector3& position, double value_N, double noise_variance_N2, double power_W) {
            return self.append({position, power_W, value_N, noise_variance_N2});
          },
          py::arg("position"), py::arg("value_N"), py::arg("noise_variance_N2"), py::arg("power_W") = 0.0,
          "One sample at (3,) [m]. False, and nothing changed: full, or no number.")
      .def(
          "remove",
          [](G& self, int i) {
            if (i < 0 || i >= self.size()) {
              throw py::index_error("i = " + std::to_string(i) + ": must be in 0.." + std::to_string(self.size() - 1));
            }
            self.remove(i);
          },
          py::arg("i"))
      .def("predict", &G::predict, py::arg("at"), py::arg("power_W") = 0.0,
           "GpPrediction at (3,) [m]; power_W: 0 for tissue at rest.")
      .def(
          "mean_and_slope",
          [](const G& self, const Vector3& at) {
            const auto value = self.mean_and_slope(at);
            return py::make_tuple(value.mean, value.slope);
          },
          py::arg("at"), "mean [N] and its derivative along the normal [N/m] at (3,) [m]")
      .def_property_readonly("log_marginal_likelihood", &G::log_marginal_likelihood)
      .def_property_readonly("work", &G::work, "covariances and multiplications so far")
      .def_property_readonly("capacity", &G::capacity)
      .def("__len__", &G::size);
}

}  // namespace

void bind_model_process(py::module_& m) {
  using H = GpHyperparameters;
  Struct<H>(m, "GpHyperparameters", "Prior and noise of the normal force.")
      .field("force_scale_N", &H::force_scale_N, "standard deviation of the prior of the force [N]")
      .field("stiffness_scale_N_m", &H::stiffness_scale_N_m, "standard deviation of the prior of the stiffness [N/m]")
      .field("bend_scale_N_m2", &H::bend_scale_N_m2, "of half the second derivative of the force over depth [N/m^2]")
      .field("tangential_length_m", &H::tangential_length_m, "over which the tissue changes along its surface [m]")
      .field("damping_s_m", &H::damping_s_m, "share of the force that goes with the speed of pressing [s/m]")
      .field("damping_scale_s_m", &H::damping_scale_s_m, "standard deviation of damping_s_m [s/m]")
      .field("noise_N", &H::noise_N, "standard deviation of one sample's error, all other causes [N]");
  using C = LocalModelConfig;
  Struct<C>(m, "LocalModelConfig", "The samples around a point, and what is asked of them.")
      .field("hyperparameters", &C::hyperparameters, "GpHyperparameters")
      .field("neighbours", &C::neighbours, "places in one Gaussian process")
      .field("min_samples", &C::min_samples, "fewer places: unknown")
      .field("radius_m", &C::radius_m, "places further away are left out [m]")
      .field("surface_force_N", &C::surface_force_N, "the surface is where the mean force falls to this [N]")
      .field("search_m", &C::search_m, "farthest from the samples that a surface is looked for [m]")
      .field("model_error_share", &C::model_error_share, "of stiffness and of extrapolated depth, always added");
  py::enum_<EstimateStatus>(m, "EstimateStatus", "What is known at a point.")
      .value("OK", EstimateStatus::kOk)
      .value("TOO_FEW_SAMPLES", EstimateStatus::kTooFewSamples)
      .value("NO_SURFACE", EstimateStatus::kNoSurface);
  using E = SurfaceEstimate;
  Struct<E>(m, "SurfaceEstimate", "Surface and stiffness at a point; NaN with an infinite deviation: not known.")
      .field("surface_point", &E::surface_point, "(3,) along the normal through the point, base frame [m]")
      .field("surface_std_m", &E::surface_std_m, "along the normal [m]")
      .field("stiffness_N_m", &E::stiffness_N_m, "[N/m]")
      .field("stiffness_std_N_m", &E::stiffness_std_N_m, "[N/m]")
      .field("force_N", &E::force_N, "normal force at the point itself [N]")
      .field("force_std_N", &E::force_std_N, "[N]")
      .field("normal", &E::normal, "(3,) outward, base frame")
      .field("samples", &E::samples, "places in the Gaussian process")
      .field("status", &E::status, "EstimateStatus");
  bind_local_gp(m);
  m.def(
      "estimate_surfaces",
      [](const HashGrid& grid, const C& config, const py::object& points, const py::object& normals) {
        const auto at = load_rows(points, "points");
        std::vector<Vector3> outward;
        if (!normals.is_none()) {
          outward = load_rows(normals, "normals");
          if (outward.size() != at.size()) {
            throw py::value_error("normals: expected " + std::to_string(at.size()) + " rows, got " +
                                  std::to_string(outward.size()));
          }
        }
        std::vector<SurfaceEstimate> estimates(at.size());
        {
          const py::gil_scoped_release release;
          LocalModel workspace(config, grid.config());
          estimate_surfaces(grid, workspace, at.data(), outward.empty() ? nullptr : outward.data(), at.size(),
                            estimates.data());
        }
        return store_estimates(estimates);
      },
      py::arg("grid"), py::arg("config"), py::arg("points"), py::arg("normals") = py::none(),
      "What is known at (n, 3) points [m]: a dict of arrays by the names of SurfaceEstimate. normals: (n, 3) outward, "
      "or\n"
      "None for the mean reaction of the samples around. The grid must not change meanwhile. Raises ConfigError.");
}

}  // namespace saras::bindings
