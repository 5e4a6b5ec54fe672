// The nodelet endoscope_capture in a process of its own.
#include <nodelet/loader.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "endoscope_capture");
  nodelet::Loader loader;
  const nodelet::M_string remappings(ros::names::getRemappings());
  const nodelet::V_string arguments(argv + 1, argv + argc);
  if (!loader.load(ros::this_node::getName(), "saras_ros1/EndoscopeCapture", remappings, arguments)) {
    return 2;  // it has said why
  }
  ros::spin();
  return 0;
}
