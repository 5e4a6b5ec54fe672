#include <pybind11/stl.h>

#include "law.hpp"
#include "saras/runtime/clock.hpp"
#include "saras/runtime/flight_recorder.hpp"

namespace saras::bindings {

void bind_runtime_flight(py::module_& m);

namespace {

/// (n, 2, width) of a value a side.
template <typename Get>
Array side_columns(const FlightRecord& record, std::size_t n, int width, Get get) {
  Array array({static_cast<py::ssize_t>(n), static_cast<py::ssize_t>(kSides), static_cast<py::ssize_t>(width)});
  double* out = array.mutable_data();
  for (const auto& chunk : record.chunks) {
    for (const FlightTick& tick : chunk.ticks) {
      for (std::size_t side = 0; side < kSides; ++side, out += width) {
        get(tick, side, out);
      }
    }
  }
  return array;
}

template <typename Get>
Array columns(const FlightRecord& record, std::size_t n, Get get) {
  Array array(static_cast<py::ssize_t>(n));
  double* out = array.mutable_data();
  for (const auto& chunk : record.chunks) {
    for (const FlightTick& tick : chunk.ticks) {
      *out++ = get(tick);
    }
  }
  return array;
}

auto vector_of(const Vector3& v, double* out) { std::copy(v.data(), v.data() + 3, out); }

py::dict arrays(const FlightRecord& r) {
  std::size_t n = 0;
  for (const auto& chunk : r.chunks) {
    n += chunk.ticks.size();
  }
  using T = FlightTick;
  py::dict all;
  all["index"] = columns(r, n, [](const T& t) { return static_cast<double>(t.index); });
  all["time_s"] = columns(r, n, [](const T& t) { return 1e-9 * static_cast<double>(t.now_ns); });
  all["stamp_s"] = columns(r, n, [](const T& t) { return 1e-9 * static_cast<double>(t.stamp_ns); });
  all["dt_s"] = columns(r, n, [](const T& t) { return t.dt_s; });
  all["overrun"] = columns(r, n, [](const T& t) { return t.input.overrun ? 1.0 : 0.0; });
  all["hold"] = columns(r, n, [](const T& t) { return t.input.hold ? 1.0 : 0.0; });
  all["tank_master_J"] = columns(r, n, [](const T& t) { return t.output.tank_master.energy_J; });
  all["tank_slave_J"] = columns(r, n, [](const T& t) { return t.output.tank_slave.energy_J; });
  const auto add = [&](const char* name, int width, auto get) { all[name] = side_columns(r, n, width, get); };
  add("state", 1, [](const T& t, std::size_t i, double* o) { *o = static_cast<double>(t.output.sides[i].state); });
  add("handle_age_s", 1, [](const T& t, std::size_t i, double* o) { *o = t.input.sides[i].handle.age_s; });
  add("arm_age_s", 1, [](const T& t, std::size_t i, double* o) { *o = t.input.sides[i].arm.age_s; });
  add("handle", 3,
      [](const T& t, std::size_t i, double* o) { vector_of(t.input.sides[i].handle.simball_T_handle.translation, o); });
  add("tip", 3,
      [](const T& t, std::size_t i, double* o) { vector_of(t.input.sides[i].arm.base_T_tip.translation, o); });
  add("set_point", 3,
      [](const T& t, std::size_t i, double* o) { vector_of(t.output.sides[i].set_point.translation, o); });
  add("hand_force", 3,
      [](const T& t, std::size_t i, double* o) { vector_of(t.output.sides[i].touch_wrench.force, o); });
  add("tissue_force", 3,
      [](const T& t, std::size_t i, double* o) { vector_of(t.output.sides[i].tissue_wrench.force, o); });
  return all;
}

}  // namespace

void bind_runtime_flight(py::module_& m) {
  using R = FlightRecord;
  py::class_<R>(m, "FlightRecord", "A flight record read back.")
      .def_readonly("reason", &R::reason, "why it was written")
      .def_readonly("config", &R::config, "saras.pipeline.PipelineConfig")
      .def_property_readonly("chunks", [](const R& r) { return r.chunks.size(); })
      .def(
          "ticks", [](const R& r, std::size_t chunk) { return r.chunks.at(chunk).ticks; }, py::arg("chunk"),
          "The FlightTicks of one chunk.")
      .def("arrays", &arrays,
           "Arrays over all n steps: index, time_s, stamp_s, dt_s, overrun, hold, tank_master_J, tank_slave_J (n,);\n"
           "state, handle_age_s, arm_age_s (n, 2, 1); handle, tip, set_point, hand_force, tissue_force (n, 2, 3).");
  using P = FlightReplay;
  py::class_<P>(m, "FlightReplay", "What a replay found.")
      .def_readonly("ticks", &P::ticks, "steps")
      .def_readonly("exact", &P::exact, "of those, with outputs equal to the bit")
      .def_readonly("states", &P::states, "states in the record that follow without a gap")
      .def_readonly("states_exact", &P::states_exact, "of those, equal to what the replay reached")
      .def_readonly("first_difference", &P::first_difference, "index of the first step that differs; -1: none");
  m.def("read_flight", &read_flight, py::arg("path"), "Reads a record. Raises ProtocolError, Error.");
  m.def("replay_flight", &replay_flight, py::arg("record"), py::call_guard<py::gil_scoped_release>(),
        "Steps a pipeline through the record and compares.");
  m.def("monotonic_ns", &monotonic_ns, "The loop's clock [ns].");
}

}  // namespace saras::bindings
