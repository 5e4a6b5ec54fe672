#include "saras/spatial/validate.hpp"

#include <cmath>
#include <sstream>

#include "saras/spatial/errors.hpp"

namespace saras::validate {
namespace {

[[noreturn]] void refuse(const std::string& field, double value, const std::string& bound) {
  std::ostringstream message;
  message.precision(12);
  message << field << " = " << value << ": must be " << bound;
  throw ConfigError(message.str());
}

std::string text(double value) {
  std::ostringstream out;
  out.precision(12);
  out << value;
  return out.str();
}

std::string element(const char* field, Eigen::Index i) { return std::string(field) + "[" + std::to_string(i) + "]"; }

template <typename Vector, typename Check>
void each(const char* field, const Vector& value, const Check& check) {
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    check(element(field, i).c_str(), value[i]);
  }
}

}  // namespace

void finite(const char* field, double value) {
  if (!std::isfinite(value)) {
    refuse(field, value, "finite");
  }
}

void positive(const char* field, double value) {
  if (!std::isfinite(value) || value <= 0.0) {
    refuse(field, value, "finite and > 0");
  }
}

void not_negative(const char* field, double value) {
  if (!std::isfinite(value) || value < 0.0) {
    refuse(field, value, "finite and >= 0");
  }
}

void in_range(const char* field, double value, double lowest, double highest) {
  if (!std::isfinite(value) || value < lowest || value > highest) {
    refuse(field, value, "in [" + text(lowest) + ", " + text(highest) + "]");
  }
}

void less(const char* lower_field, double lower, const char* higher_field, double higher) {
  finite(lower_field, lower);
  finite(higher_field, higher);
  if (!(lower < higher)) {
    refuse(lower_field, lower, std::string("< ") + higher_field + " = " + text(higher));
  }
}

void finite(const char* field, const Vector3& value) {
  each(field, value, [](const char* name, double v) { finite(name, v); });
}
void finite(const char* field, const Vector6& value) {
  each(field, value, [](const char* name, double v) { finite(name, v); });
}
void not_negative(const char* field, const Vector3& value) {
  each(field, value, [](const char* name, double v) { not_negative(name, v); });
}
void not_negative(const char* field, const Vector6& value) {
  each(field, value, [](const char* name, double v) { not_negative(name, v); });
}

void not_above(const char* lower_field, const Vector6& lower, const char* higher_field, const Vector6& higher) {
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (lower[i] > higher[i]) {
      refuse(element(lower_field, i), lower[i], "<= " + element(higher_field, i) + " = " + text(higher[i]));
    }
  }
}

void pose(const char* field, const Pose& value) {
  finite((std::string(field) + ".translation").c_str(), value.translation);
  const double norm = value.rotation.norm();
  if (!std::isfinite(norm) || std::abs(norm - 1.0) > kUnitQuaternionTolerance) {
    refuse(std::string(field) + ".rotation (norm)", norm, "1 within 1e-6 (a rotation)");
  }
}

void unit(const char* field, const Vector3& value) {
  finite(field, value);
  if (std::abs(value.norm() - 1.0) > 1e-6) {
    refuse(std::string(field) + " (norm)", value.norm(), "1 within 1e-6");
  }
}

}  // namespace saras::validate
