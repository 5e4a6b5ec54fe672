// Checks for Config::validate(): each refusal names the field, its value and the bound.
#pragma once

#include <string>

#include "saras/spatial/types.hpp"

namespace saras::validate {

void finite(const char* field, double value);
void positive(const char* field, double value);
void not_negative(const char* field, double value);
/// lowest <= value <= highest
void in_range(const char* field, double value, double lowest, double highest);
/// lower < higher, naming both fields
void less(const char* lower_field, double lower, const char* higher_field, double higher);
void finite(const char* field, const Vector3& value);
void finite(const char* field, const Vector6& value);
/// each component >= 0
void not_negative(const char* field, const Vector3& value);
void not_negative(const char* field, const Vector6& value);
/// each component lower <= higher, naming both fields
void not_above(const char* lower_field, const Vector6& lower, const char* higher_field, const Vector6& higher);
/// finite translation and unit quaternion
void pose(const char* field, const Pose& value);
/// unit length within 1e-6
void unit(const char* field, const Vector3& value);

}  // namespace saras::validate
