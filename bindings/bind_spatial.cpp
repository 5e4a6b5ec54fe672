#include "casters.hpp"
#include "rooms.hpp"
#include "saras/calibration/calibration_error.hpp"
#include "saras/model/model_error.hpp"
#include "saras/spatial/errors.hpp"
#include "saras/spatial/rotation.hpp"
#include "saras/spatial/status.hpp"

namespace saras::bindings {

namespace py = pybind11;

void bind_spatial(py::module_& m) {
  static py::exception<Error> error(m, "Error", PyExc_RuntimeError);
  // ValueError too: who does not know our tree still catches it where Python users expect.
  const py::tuple value_bases = py::make_tuple(error, py::reinterpret_borrow<py::object>(PyExc_ValueError));
  static py::exception<ConfigError> config_error(m, "ConfigError", value_bases);
  static py::exception<ProtocolError> protocol_error(m, "ProtocolError", value_bases);
  static py::exception<KinematicsError> kinematics_error(m, "KinematicsError", value_bases);
  static py::exception<CalibrationError> calibration_error(m, "CalibrationError", value_bases);
  static py::exception<ModelError> model_error(m, "ModelError", value_bases);
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) {
        std::rethrow_exception(pointer);
      }
    } catch (const ConfigError& e) {
      py::set_error(config_error, e.what());
    } catch (const ProtocolError& e) {
      py::set_error(protocol_error, e.what());
    } catch (const CalibrationError& e) {
      py::set_error(calibration_error, e.what());
    } catch (const ModelError& e) {
      py::set_error(model_error, e.what());
    } catch (const KinematicsError& e) {
      py::set_error(kinematics_error, e.what());
    } catch (const Error& e) {
      py::set_error(error, e.what());
    }
  });

  py::enum_<Status>(m, "Status", "What a law's step says about its output.")
      .value("OK", Status::kOk)
      .value("LIMITED", Status::kLimited)
      .value("WAITING", Status::kWaiting)
      .value("STALE", Status::kStale)
      .value("INVALID_INPUT", Status::kInvalidInput)
      .value("INVALID_TIME_STEP", Status::kInvalidTimeStep)
      .value("RATE_EXCEEDED", Status::kRateExceeded);

  m.def("displacement", &displacement, py::arg("base_T_1"), py::arg("base_T_2"),
        "Displacement from one (4, 4) pose to another in the base frame: (6,) translation [m], rotation vector [rad].\n"
        "Same convention as KDL::diff; divide by the interval for the mean twist.");
  m.def("add_delta", &add_delta, py::arg("base_T_body"), py::arg("base_twist"), py::arg("dt"),
        "Moves a (4, 4) pose by a base-frame twist (6,) [m/s, rad/s] for dt [s]. Same convention as KDL::addDelta.");
}

}  // namespace saras::bindings
