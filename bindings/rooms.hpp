// One function a room; module.cpp calls them in order.
#pragma once

#include <pybind11/pybind11.h>

namespace saras::bindings {

void bind_spatial(pybind11::module_& m);
void bind_teleop(pybind11::module_& m);
void bind_kinematics(pybind11::module_& m);
void bind_collision(pybind11::module_& m);
void bind_calibration(pybind11::module_& m);
void bind_sim(pybind11::module_& m);
void bind_net(pybind11::module_& m);
void bind_safety(pybind11::module_& m);
void bind_console(pybind11::module_& m);
void bind_pipeline(pybind11::module_& m);
void bind_overlay(pybind11::module_& m);
void bind_contact(pybind11::module_& m);
void bind_model(pybind11::module_& m);
void bind_runtime(pybind11::module_& m);  ///< where the core has it: Linux, OpenSSL

}  // namespace saras::bindings
