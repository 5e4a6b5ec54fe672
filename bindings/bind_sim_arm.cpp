#include "law.hpp"

namespace saras::bindings {

void bind_sim_arm(py::module_&) {}

}  // namespace saras::bindings
