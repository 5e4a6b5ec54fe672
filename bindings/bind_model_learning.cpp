#include "bind_model.hpp"
#include "saras/model/gp_learning.hpp"

namespace saras::bindings {

void bind_model_learning(py::module_& m) {
  using R = GpLearning;
  py::class_<R>(m, "GpLearning", "Result of learn_hyperparameters.")
      .def_readonly("hyperparameters", &R::hyperparameters, "GpHyperparameters")
      .def_readonly("log_likelihood_before", &R::log_likelihood_before, "of all neighbourhoods, without the prior")
      .def_readonly("log_likelihood", &R::log_likelihood)
      .def_readonly("neighbourhoods", &R::neighbourhoods)
      .def_readonly("samples", &R::samples, "places used, with repetition")
      .def_readonly("converged", &R::converged);
  const GpLearningOptions defaults;
  m.def(
      "learn_hyperparameters",
      [](const HashGrid& grid, const LocalModelConfig& config, int neighbourhoods, double prior_log_std,
         int max_iterations, std::uint64_t seed) {
        GpLearningOptions options;
        options.neighbourhoods = neighbourhoods;
        options.prior_log_std = prior_log_std;
        options.max_iterations = max_iterations;
        options.seed = seed;
        const py::gil_scoped_release release;
        return learn_hyperparameters(grid, config, options);
      },
      py::arg("grid"), py::arg("config"), py::kw_only(), py::arg("neighbourhoods") = defaults.neighbourhoods,
      py::arg("prior_log_std") = defaults.prior_log_std, py::arg("max_iterations") = defaults.max_iterations,
      py::arg("seed") = defaults.seed,
      "Most probable hyper-parameters over neighbourhoods drawn from the grid, from those of config. Tenths of a "
      "second\n"
      "without the GIL; the grid must not change meanwhile. Raises ModelError when nothing can be learned from.");
}

}  // namespace saras::bindings
