// One bind_teleop_<law>.cpp a law.
#include "rooms.hpp"

namespace saras::bindings {

namespace py = pybind11;

void bind_twist_estimator(py::module_& m);
void bind_frame_mapping(py::module_& m);
void bind_transparency(py::module_& m);
void bind_energy_tank(py::module_& m);
void bind_velocity_integrator(py::module_& m);
void bind_disturbance_observer(py::module_& m);

void bind_teleop(py::module_& m) {
  bind_twist_estimator(m);
  bind_frame_mapping(m);
  bind_transparency(m);
  bind_energy_tank(m);
  bind_velocity_integrator(m);
  bind_disturbance_observer(m);
}

}  // namespace saras::bindings
