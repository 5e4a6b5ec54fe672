// saras._visp: GPL-2.0-or-later by what it links. Nothing else of saras needs it.
#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "hand_eye_visp.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_visp, m) {
  m.doc() = "ViSP's hand-eye solver (GPL-2.0-or-later).";
  m.def("hand_eye", &saras::hand_eye_visp, py::arg("base_T_gripper"), py::arg("camera_T_target"),
        "gripper_T_camera (4, 4) by ViSP, from lists of (4, 4). Raises ValueError when ViSP refuses the poses.");
}
