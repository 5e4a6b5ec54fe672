#include <optional>

#include "bind_model.hpp"
#include "saras/model/hash_grid.hpp"

namespace saras::bindings {

void bind_model_grid(py::module_& m) {
  using C = HashGridConfig;
  Struct<C>(m, "HashGridConfig", "Cells of the samples, and how many of them.")
      .field("cell_m", &C::cell_m, "edge of a cell [m]")
      .field("samples_per_cell", &C::samples_per_cell, "places in a cell; further samples are merged")
      .field("max_cells", &C::max_cells, "then the cell that was touched longest ago is forgotten")
      .field("max_weight", &C::max_weight, "of a place; above it the oldest part is forgotten");
  using G = HashGrid;
  py::class_<G>(m, "HashGrid", "Touch samples in a hash grid of bounded size.")
      .def(py::init<C>(), py::arg("config") = C{}, "Raises ConfigError.")
      .def(
          "insert",
          [](G& self, const py::object& positions, const py::object& forces, const std::optional<Array>& speeds) {
            const auto x = load_rows(positions, "positions");
            const auto f = load_rows(forces, "forces");
            if (x.size() != f.size()) {
              throw py::value_error("forces: expected " + std::to_string(x.size()) + " rows, got " +
                                    std::to_string(f.size()));
            }
            if (speeds && (speeds->ndim() != 1 || speeds->shape(0) != static_cast<py::ssize_t>(x.size()))) {
              throw py::value_error("speeds: expected " + std::to_string(x.size()) + " numbers");
            }
            const double* speed = speeds ? speeds->data() : nullptr;
            std::vector<int> places(x.size());
            {
              const py::gil_scoped_release release;
              for (std::size_t i = 0; i < x.size(); ++i) {
                places[i] = self.insert(x[i], f[i], speed != nullptr ? speed[i] : 0.0);
              }
            }
            return py::array_t<int>(static_cast<py::ssize_t>(places.size()), places.data());
          },
          py::arg("positions"), py::arg("forces"), py::arg("speeds") = py::none(),
          "Takes (n, 3) positions [m], (n, 3) forces that the tool exerts [N] and (n,) speeds along them [m/s].\n"
          "(n,) places; -1: not finite, too far.")
      .def(
          "within",
          [](const G& self, const Vector3& point, double radius_m) {
            std::vector<int> places(static_cast<std::size_t>(self.config().candidates_within(radius_m)));
            places.resize(
                static_cast<std::size_t>(self.within(point, radius_m, places.data(), static_cast<int>(places.size()))));
            return places;
          },
          py::arg("point"), py::arg("radius_m"), "Places within radius_m of the point (3,), in no order.")
      .def("forget", &G::forget, py::arg("point"), py::arg("radius_m"), "Forgets the cells around the point (3,).")
      .def("clear", &G::clear)
      .def_property_readonly(
          "samples",
          [](const G& self) {
            const std::vector<int> used = self.used();
            std::vector<Vector3> positions;
            std::vector<Vector3> forces;
            Array weights(static_cast<py::ssize_t>(used.size()));
            for (std::size_t i = 0; i < used.size(); ++i) {
              const TouchSample& sample = self.place(used[i]);
              positions.push_back(sample.position);
              forces.push_back(sample.force);
              weights.mutable_data()[i] = sample.weight;
            }
            return py::make_tuple(store_rows(positions), store_rows(forces), weights);
          },
          "positions (n, 3) [m], forces (n, 3) [N], weights (n,) of all places")
      .def_property_readonly("places", &G::places)
      .def_property_readonly("cells", &G::cells)
      .def_property_readonly("evicted", &G::evicted, "cells forgotten for want of room")
      .def_property_readonly("taken", &G::taken, "samples taken")
      .def_property_readonly("config", [](const G& self) { return self.config(); })
      .def("__len__", &G::places);
}

}  // namespace saras::bindings
