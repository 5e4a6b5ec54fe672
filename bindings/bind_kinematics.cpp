#include "law.hpp"
#include "rooms.hpp"

namespace saras::bindings {

void bind_kinematics(py::module_&) {}

}  // namespace saras::bindings
