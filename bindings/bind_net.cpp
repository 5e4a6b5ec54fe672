#include "law.hpp"
#include "rooms.hpp"

namespace saras::bindings {

void bind_net(py::module_&) {}

}  // namespace saras::bindings
