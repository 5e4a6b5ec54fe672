#include "parameters.hpp"

#include <cmath>
#include <sstream>

#include "saras/spatial/errors.hpp"

namespace saras_ros1 {
namespace {

std::string text_of(const XmlRpc::XmlRpcValue& value) {
  std::ostringstream text;
  value.write(text);
  return text.str();
}

}  // namespace

XmlRpc::XmlRpcValue Parameters::value(const std::string& name, const char* kind) {
  XmlRpc::XmlRpcValue value;
  if (!handle_.getParam(name, value)) {
    throw saras::ConfigError(path(name) + ": missing (" + kind + ")");
  }
  read_.insert(name);
  return value;
}

double Parameters::number(const std::string& name, double low, double high) {
  XmlRpc::XmlRpcValue found = value(name, "a number");
  const bool whole = found.getType() == XmlRpc::XmlRpcValue::TypeInt;
  if (!whole && found.getType() != XmlRpc::XmlRpcValue::TypeDouble) {
    throw saras::ConfigError(path(name) + " = " + text_of(found) + ": must be a number");
  }
  const double number = whole ? static_cast<double>(static_cast<int>(found)) : static_cast<double>(found);
  if (!(number >= low && number <= high)) {
    std::ostringstream bounds;
    bounds << path(name) << " = " << number << ": must be in [" << low << ", " << high << "]";
    throw saras::ConfigError(bounds.str());
  }
  return number;
}

int Parameters::integer(const std::string& name, int low, int high) {
  const double found = number(name, low, high);
  if (found != std::floor(found)) {
    throw saras::ConfigError(path(name) + " = " + std::to_string(found) + ": must be a whole number");
  }
  return static_cast<int>(found);
}

bool Parameters::flag(const std::string& name) {
  XmlRpc::XmlRpcValue found = value(name, "true or false");
  if (found.getType() != XmlRpc::XmlRpcValue::TypeBoolean) {
    throw saras::ConfigError(path(name) + " = " + text_of(found) + ": must be true or false");
  }
  return static_cast<bool>(found);
}

std::string Parameters::text(const std::string& name) {
  XmlRpc::XmlRpcValue found = value(name, "text");
  if (found.getType() != XmlRpc::XmlRpcValue::TypeString || static_cast<std::string>(found).empty()) {
    throw saras::ConfigError(path(name) + " = " + text_of(found) + ": must be text");
  }
  return static_cast<std::string>(found);
}

std::string Parameters::text_or_empty(const std::string& name) {
  XmlRpc::XmlRpcValue found = value(name, "text");
  if (found.getType() != XmlRpc::XmlRpcValue::TypeString) {
    throw saras::ConfigError(path(name) + " = " + text_of(found) + ": must be text");
  }
  return static_cast<std::string>(found);
}

std::string Parameters::choice(const std::string& name, const std::set<std::string>& choices) {
  const std::string found = text(name);
  if (choices.count(found) == 0) {
    std::string all;
    for (const std::string& choice : choices) {
      all += (all.empty() ? "" : ", ") + choice;
    }
    throw saras::ConfigError(path(name) + " = " + found + ": must be one of " + all);
  }
  return found;
}

std::vector<std::string> Parameters::texts(const std::string& name) {
  XmlRpc::XmlRpcValue found = value(name, "a list of texts");
  std::vector<std::string> texts;
  bool good = found.getType() == XmlRpc::XmlRpcValue::TypeArray;
  for (int i = 0; good && i < found.size(); ++i) {
    good = found[i].getType() == XmlRpc::XmlRpcValue::TypeString;
    if (good) {
      texts.push_back(static_cast<std::string>(found[i]));
    }
  }
  if (!good || texts.empty()) {
    throw saras::ConfigError(path(name) + " = " + text_of(found) + ": must be a list of texts");
  }
  return texts;
}

void Parameters::refuse_unread(XmlRpc::XmlRpcValue& section, const std::string& prefix) const {
  for (auto& [key, entry] : section) {
    const std::string name = prefix + key, inside = name + "/";
    if (read_.count(name) != 0) {
      continue;
    }
    const auto first = read_.lower_bound(inside);
    const bool read_inside = first != read_.end() && first->compare(0, inside.size(), inside) == 0;
    if (!read_inside || entry.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
      throw saras::ConfigError(path(name) + ": unknown parameter");
    }
    refuse_unread(entry, inside);
  }
}

void Parameters::finish() const {
  XmlRpc::XmlRpcValue all;
  if (handle_.getParam(handle_.getNamespace(), all) && all.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    refuse_unread(all, "");
  }
}

}  // namespace saras_ros1
