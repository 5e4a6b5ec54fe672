#include "law.hpp"
#include "rooms.hpp"

namespace saras::bindings {

void bind_sim(py::module_&) {}

}  // namespace saras::bindings
