// Shared by the files that bind the room `overlay`.
#pragma once

#include <string>

#include "law.hpp"
#include "saras/overlay/image_view.hpp"

namespace saras::bindings {

/// (height, width) or (height, width, channels) of uint8, rows without gaps between pixels; drawn on in place.
using Pixels = py::array_t<std::uint8_t>;

/// Refuses arrays that do not fit the encoding.
ImageView view_of(Pixels& pixels, const std::string& encoding, bool drawn_on = true);

void bind_overlay_camera(py::module_& m);
void bind_overlay_watch(py::module_& m);
void bind_overlay_tools(py::module_& m);
void bind_overlay_inset(py::module_& m);
void bind_overlay_stiffness(py::module_& m);

}  // namespace saras::bindings
