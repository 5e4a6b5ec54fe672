// How a law's structs become Python classes: keyword constructors, a field table, repr, pickle by fields.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "casters.hpp"
#include "numbers.hpp"
#include "saras/spatial/errors.hpp"

namespace saras::bindings {

namespace py = pybind11;

/// A plain struct whose members are set by keyword: Config(field=…). Unknown names are refused.
/// Use: Struct<XConfig>(m, "XConfig", "doc").field("name", &XConfig::name, "doc [unit]")…;
/// A struct with validate() is validated when it is built.
template <typename T>
class Struct {
 public:
  Struct(py::module_& m, const char* name, const char* doc) : class_(m, name, doc), name_(name) {
    auto cls = py::object(class_);
    class_.def(py::init([cls, type_name = name_](const py::kwargs& fields) {
                 T value;
                 py::object self = py::cast(&value, py::return_value_policy::reference);
                 for (const auto& [key, field] : fields) {
                   if (!py::hasattr(cls, key)) {
                     throw py::type_error(type_name + ": no field named " + py::str(key).cast<std::string>());
                   }
                   py::setattr(self, key, field);
                 }
                 check(value);
                 return value;
               }),
               doc);
    class_.def("__repr__", [cls, type_name = name_](const py::object& self) {
      std::string text;
      for (const auto& field : cls.attr("_fields")) {
        text += (text.empty() ? "" : ", ") + py::str(field).cast<std::string>() + "=" +
                py::repr(py::getattr(self, field)).template cast<std::string>();
      }
      return type_name + "(" + text + ")";
    });
    class_.def(
        "_numbers",
        [fields = numbers_](const T& self) {
          std::vector<double> numbers;
          for (const auto& append : *fields) {
            append(self, numbers);
          }
          return numbers;
        },
        "All numbers in field order, as saras.law_trace records them.");
    class_.def("__copy__", [](const T& self) { return T(self); });
    class_.def("__deepcopy__", [](const T& self, const py::dict&) { return T(self); });
  }

  template <typename Member>
  Struct& field(const char* name, Member T::*member, const char* doc) {
    class_.def_property(
        name, [member](const T& self) -> Member { return self.*member; },
        [member](T& self, const Member& value) { self.*member = value; }, doc);
    numbers_->push_back(
        [member](const T& self, std::vector<double>& numbers) { append_numbers(self.*member, numbers); });
    return finish(name);
  }
  /// A field under another type, by getter and setter.
  template <typename Get, typename Set>
  Struct& field(const char* name, Get get, Set set, const char* doc) {
    class_.def_property(name, get, set, doc);
    if constexpr (std::is_invocable_v<Get, const T&>) {
      numbers_->push_back([get](const T& self, std::vector<double>& numbers) { append_numbers(get(self), numbers); });
    }  // else: a field that Python changes in place; no law's input, output or state has one
    return finish(name);
  }

  py::class_<T>& cls() { return class_; }

 private:
  template <typename U>
  static auto validate_if(const U& value, int) -> decltype(value.validate(), void()) {
    value.validate();
  }
  template <typename U>
  static void validate_if(const U&, long) {}
  static void check(const T& value) { validate_if(value, 0); }

  Struct& finish(const char* name) {
    names_.emplace_back(name);
    py::list names;
    for (const auto& field_name : names_) {
      names.append(field_name);
    }
    class_.attr("_fields") = names;
    return *this;
  }

  py::class_<T> class_;
  std::string name_;
  std::vector<std::string> names_;
  using AppendField = std::function<void(const T&, std::vector<double>&)>;
  std::shared_ptr<std::vector<AppendField>> numbers_ = std::make_shared<std::vector<AppendField>>();
};

/// Nested structs are handed out by reference, so that packet.left.grip = 0.5 sets the packet.
template <typename Owner, typename Member, typename S>
void nested(S& bound, const char* name, Member Owner::*member, const char* doc) {
  bound.field(
      name, [member](Owner& self) -> Member& { return self.*member; },
      [member](Owner& self, const Member& value) { self.*member = value; }, doc);
}

}  // namespace saras::bindings
