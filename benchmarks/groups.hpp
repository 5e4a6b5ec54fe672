// One function a group of rows; main.cpp calls those that were asked for.
#pragma once

#include <vector>

#include "timing.hpp"

namespace saras::benchmarks {

std::vector<Row> teleop_rows();
std::vector<Row> codec_rows();

/// Tank levels [J] and set-points [m] after one pass of the scenario: script/bench compares them with the peers'.
std::vector<double> teleop_check();

}  // namespace saras::benchmarks
