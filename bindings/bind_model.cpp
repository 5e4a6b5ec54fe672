#include "bind_model.hpp"

#include "rooms.hpp"

namespace saras::bindings {

void bind_model_search(py::module_& m);

std::vector<Vector3> load_rows(const py::object& source, const char* what) {
  const Array array = Array::ensure(source);
  if (!array || array.ndim() != 2 || array.shape(1) != 3) {
    PyErr_Clear();
    throw py::value_error(std::string(what) + ": expected shape (n, 3), got " +
                          (array ? shape_text(array) : std::string("no array")));
  }
  std::vector<Vector3> rows;
  rows.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    rows.emplace_back(Eigen::Map<const Vector3>(array.data() + 3 * i));
  }
  return rows;
}

Array store_rows(const std::vector<Vector3>& rows) {
  Array array({static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Eigen::Map<Vector3>(array.mutable_data() + 3 * i) = rows[i];
  }
  return array;
}

py::dict store_estimates(const std::vector<SurfaceEstimate>& estimates) {
  const auto count = static_cast<py::ssize_t>(estimates.size());
  const auto numbers = [&](double SurfaceEstimate::*member) {
    Array array(count);
    for (py::ssize_t i = 0; i < count; ++i) {
      array.mutable_data()[i] = estimates[static_cast<std::size_t>(i)].*member;
    }
    return array;
  };
  const auto vectors = [&](Vector3 SurfaceEstimate::*member) {
    Array array({count, py::ssize_t{3}});
    for (py::ssize_t i = 0; i < count; ++i) {
      Eigen::Map<Vector3>(array.mutable_data() + 3 * i) = estimates[static_cast<std::size_t>(i)].*member;
    }
    return array;
  };
  py::array_t<std::int32_t> samples(count);
  py::array_t<std::uint8_t> status(count);
  for (py::ssize_t i = 0; i < count; ++i) {
    samples.mutable_data()[i] = estimates[static_cast<std::size_t>(i)].samples;
    status.mutable_data()[i] = static_cast<std::uint8_t>(estimates[static_cast<std::size_t>(i)].status);
  }
  py::dict result;
  result["surface_point"] = vectors(&SurfaceEstimate::surface_point);
  result["surface_std_m"] = numbers(&SurfaceEstimate::surface_std_m);
  result["stiffness_N_m"] = numbers(&SurfaceEstimate::stiffness_N_m);
  result["stiffness_std_N_m"] = numbers(&SurfaceEstimate::stiffness_std_N_m);
  result["force_N"] = numbers(&SurfaceEstimate::force_N);
  result["force_std_N"] = numbers(&SurfaceEstimate::force_std_N);
  result["normal"] = vectors(&SurfaceEstimate::normal);
  result["samples"] = samples;
  result["status"] = status;
  return result;
}

void bind_model(py::module_& m) {
  bind_model_grid(m);
  bind_model_process(m);
  bind_model_stiffness(m);
  bind_model_registration(m);
  bind_model_search(m);
  bind_model_deformation(m);
#ifdef SARAS_WITH_CERES
  bind_model_learning(m);
#endif
}

}  // namespace saras::bindings
