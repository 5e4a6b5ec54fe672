#include "bind_model.hpp"
#include "saras/model/cross_entropy.hpp"

namespace saras::bindings {

void bind_model_search(py::module_& m) {
  using S = CrossEntropy;
  const CrossEntropyConfig defaults;
  py::class_<S>(m, "CrossEntropy",
                "Minimum of a cost by the cross-entropy method: ask for candidates, tell their costs.")
      .def(py::init([](const Eigen::VectorXd& mean, const Eigen::VectorXd& deviation, const Eigen::VectorXd& low,
                       const Eigen::VectorXd& high, int candidates, int elites, double smoothing,
                       double least_deviation, std::uint64_t seed) {
             return S({candidates, elites, smoothing, least_deviation, seed}, mean, deviation, low, high);
           }),
           py::arg("mean"), py::arg("deviation"), py::arg("low"), py::arg("high"), py::kw_only(),
           py::arg("candidates") = defaults.candidates, py::arg("elites") = defaults.elites,
           py::arg("smoothing") = defaults.smoothing, py::arg("least_deviation") = defaults.least_deviation,
           py::arg("seed") = defaults.seed,
           "mean, deviation, low, high: (d,) of the first candidates, and bounds. Raises ConfigError.")
      .def(
          "ask", [](S& self) { return Eigen::MatrixXd(self.ask().transpose()); },
          "(candidates, d), the first one is the mean")
      .def("tell", &S::tell, py::arg("costs"),
           "(candidates,) costs; not finite: no candidate. False: none was finite, nothing changed.")
      .def_property_readonly(
          "best", [](const S& self) { return self.best(); }, "(d,) the cheapest so far")
      .def_property_readonly("best_cost", &S::best_cost, "infinite: none yet")
      .def_property_readonly(
          "mean", [](const S& self) { return self.mean(); }, "(d,)")
      .def_property_readonly("deviation", &S::deviation, "(d,)")
      .def_property_readonly("rounds", &S::rounds)
      .def_property_readonly("settled", &S::settled, "every deviation is below least_deviation of its first one");
}

}  // namespace saras::bindings
