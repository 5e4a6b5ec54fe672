// Typed parameters of a nodelet: what is missing, of another kind, out of range or unknown refuses the start by name.
#pragma once

#include <ros/node_handle.h>

#include <set>
#include <string>
#include <vector>

namespace saras_ros1 {

/// Reads one namespace key by key. Errors are saras::ConfigError naming parameter, value and bound.
class Parameters {
 public:
  explicit Parameters(const ros::NodeHandle& handle) : handle_(handle) {}
  double number(const std::string& name, double low, double high);
  int integer(const std::string& name, int low, int high);
  bool flag(const std::string& name);
  std::string text(const std::string& name);
  std::string text_or_empty(const std::string& name);
  std::string choice(const std::string& name, const std::set<std::string>& choices);
  std::vector<std::string> texts(const std::string& name);
  /// Refuses keys that nobody has read, nested ones too: a typo, mostly.
  void finish() const;

 private:
  XmlRpc::XmlRpcValue value(const std::string& name, const char* kind);
  void refuse_unread(XmlRpc::XmlRpcValue& section, const std::string& prefix) const;
  std::string path(const std::string& name) const { return handle_.getNamespace() + "/" + name; }

  ros::NodeHandle handle_;
  std::set<std::string> read_;  // a/b for b in the section a
};

}  // namespace saras_ros1
