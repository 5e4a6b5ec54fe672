#include <pybind11/stl.h>

#include "bind_model_mesh.hpp"
#include "saras/runtime/model_host.hpp"

namespace saras::bindings {
namespace {

using ReleaseGil = py::call_guard<py::gil_scoped_release>;

std::shared_ptr<IndexedMesh> shown(const IndexedMeshPointer& mesh) {
  return std::const_pointer_cast<IndexedMesh>(mesh);  // Python's class changes nothing
}

py::tuple store_estimates_of(const std::vector<VertexEstimate>& estimates) {
  Array stiffness(static_cast<py::ssize_t>(estimates.size()));
  Array deviation(static_cast<py::ssize_t>(estimates.size()));
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    stiffness.mutable_data()[i] = estimates[i].stiffness_N_m;
    deviation.mutable_data()[i] = estimates[i].stiffness_std_N_m;
  }
  return py::make_tuple(stiffness, deviation);
}

std::uint64_t push(ModelHost& host, const py::object& stamps, const py::object& positions, const py::object& forces,
                   const py::object& velocities) {
  const Array times = Array::ensure(stamps);
  const auto x = load_rows(positions, "positions");
  const auto f = load_rows(forces, "forces");
  const auto v = load_rows(velocities, "velocities");
  if (!times || times.ndim() != 1 || static_cast<std::size_t>(times.size()) != x.size() || f.size() != x.size() ||
      v.size() != x.size()) {
    PyErr_Clear();
    throw py::value_error("stamps, positions, forces, velocities: expected as many rows, (n,) and (n, 3)");
  }
  const py::gil_scoped_release release;
  std::uint64_t dropped = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    dropped += host.push({times.data()[i], x[i], f[i], v[i]}) ? 0 : 1;
  }
  return dropped;
}

void bind_config(py::module_& m) {
  using V = VertexMapConfig;
  Struct<V>(m, "VertexMapConfig", "Which vertices share a local model, and when they are asked again.")
      .field("patch_m", &V::patch_m, "edge of the cells whose vertices share one [m]")
      .field("normal_cosine", &V::normal_cosine, "vertices whose normals differ by more share none")
      .field("move_tolerance_m", &V::move_tolerance_m, "a vertex that has moved no further is not asked again [m]");
  using C = ModelHostConfig;
  Struct<C> config(m, "ModelHostConfig", "The live map's law, rates and room.");
  nested(config, "law", &C::law, "saras.model.StiffnessGpConfig");
  nested(config, "vertices", &C::vertices, "VertexMapConfig");
  config
      .field("free_m", &C::free_m, "so far outside the mesh nothing is touched: the sensor's offset is taken then [m]")
      .field("near_m", &C::near_m, "vertices this near to the tip are asked at touched_hz [m]")
      .field("touched_hz", &C::touched_hz, "[1/s]")
      .field("map_hz", &C::map_hz, "a vertex that is out of date waits for no more than its inverse [1/s]")
      .field("room", &C::room, "samples that may wait to be learned; older ones are dropped and counted");
}

void bind_statistics(py::module_& m) {
  using S = ModelHostStatistics;
  py::class_<S>(m, "ModelHostStatistics", "Counters, and how long things took.")
      .def_property_readonly(
          "verdicts",
          [](const S& s) {
            py::dict verdicts;
            for (std::size_t i = 0; i < s.verdicts.size(); ++i) {
              verdicts[to_string(static_cast<SampleVerdict>(i))] = s.verdicts[i];
            }
            return verdicts;
          },
          "samples since the last reset, by name of their SampleVerdict")
      .def_readonly("dropped", &S::dropped, "samples that found no room")
      .def_readonly("waiting", &S::waiting, "samples")
      .def_readonly("places", &S::places, "of samples that are remembered")
      .def_readonly("bias_N", &S::bias_N, "(3,) the force sensor's offset [N]")
      .def_readonly("disagreement", &S::disagreement, "mean deviation of the samples from the map [sigma]")
      .def_readonly("refreshes", &S::refreshes, "of the vertices near the tip")
      .def_readonly("asked", &S::asked, "vertices")
      .def_readonly("stale", &S::stale, "patches out of date")
      .def_readonly("learning", &S::learning, "Histogram of one sample")
      .def_readonly("refreshing", &S::refreshing, "Histogram of a refresh")
      .def_readonly("waits", &S::waits, "Histogram over refreshes of the longest time that a vertex was out of date");
}

}  // namespace

void bind_runtime_model(py::module_& m) {
  bind_config(m);
  bind_statistics(m);
  using H = ModelHost;
  py::class_<H>(m, "ModelHost", "The live map in C++ threads: nobody who brings samples or looks waits for learning.")
      .def(py::init([](const std::shared_ptr<IndexedMesh>& prior, const ModelHostConfig& config) {
             return std::make_unique<H>(prior, config);
           }),
           py::arg("prior"), py::arg("config") = ModelHostConfig{}, "prior: saras.model.Mesh. Raises ConfigError.")
      .def("start", &H::start, ReleaseGil(), "Starts both threads. Raises Error when they run.")
      .def("stop", &H::stop, ReleaseGil(), "After what the threads are at; safe to repeat.")
      .def_property_readonly("failure", &H::failure, "why a thread ended by itself; empty when none did")
      .def(
          "push", &push, py::arg("stamps"), py::arg("positions"), py::arg("forces"), py::arg("velocities"),
          "Samples for the learning thread: stamps (n,) [s], (n, 3) tips [m], (n, 3) forces that the tool exerts [N],\n"
          "(n, 3) velocities [m/s]. How many waiting ones were dropped for want of room.")
      .def("learn_waiting", &H::learn_waiting, ReleaseGil(), "The learning thread's work, in the caller's thread.")
      .def("refresh", &H::refresh, py::arg("all") = true, ReleaseGil(),
           "The refreshing thread's work: all that is out of date, or one turn's share.")
      .def(
          "view",
          [](const H& self) {
            const ModelView view = self.view();
            return py::make_tuple(shown(view.laid), store_estimates_of(view.estimates), view.generation);
          },
          "(Mesh, (stiffness (n,) [N/m], its deviation (n,)), generation); NaN and infinite: not known.")
      .def(
          "take_touched",
          [](H& self) {
            const TouchedVertices taken = self.take_touched();
            py::array_t<std::int32_t> vertices(static_cast<py::ssize_t>(taken.vertices.size()));
            std::copy(taken.vertices.begin(), taken.vertices.end(), vertices.mutable_data());
            return py::make_tuple(shown(taken.laid), vertices, store_estimates_of(taken.estimates));
          },
          "(Mesh, numbers (k,) of the vertices near the tip that were asked since the last call, (stiffness (k,),\n"
          "its deviation (k,))).")
      .def("wait_touched", &H::wait_touched, py::arg("timeout_s"), ReleaseGil(),
           "Until there is something for take_touched; False: there was nothing in timeout_s.")
      .def(
          "snapshot",
          [](const H& self) {
            LocalModelConfig local;
            std::uint64_t generation = 0;
            std::unique_ptr<HashGrid> grid;
            {
              const py::gil_scoped_release release;
              grid = std::make_unique<HashGrid>(self.grid(local, generation));
            }
            return py::make_tuple(std::move(grid), local, generation);
          },
          "(a copy of the HashGrid, its LocalModelConfig, generation)")
      .def("statistics", &H::statistics, ReleaseGil())
      .def(
          "lay",
          [](H& self, const std::shared_ptr<IndexedMesh>& mesh, std::uint64_t generation) {
            return self.lay(mesh, generation);
          },
          py::arg("mesh"), py::arg("generation"),
          "The mesh lies so from now on. False: all was forgotten since that generation. Raises ModelError.")
      .def("adopt", &H::adopt, py::arg("hyperparameters"), py::arg("generation"),
           "Takes over hyper-parameters; False as `lay`. Raises ConfigError.")
      .def(
          "reset", [](H& self, const std::shared_ptr<IndexedMesh>& prior) { self.reset(prior); }, py::arg("prior"),
          ReleaseGil(), "Forgets what was learned, and begins with this mesh.")
      .def_property_readonly("config", [](const H& self) { return self.config(); });
}

}  // namespace saras::bindings
