// camera_info out of a file as `saras calibrate camera` and camera_calibration write it.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <string>

namespace saras_ros1 {

/// Read by camera_calibration_parsers, which takes much for good: what cannot be drawn with throws saras::ConfigError
/// that names file, entry and bound. Header: not set.
sensor_msgs::CameraInfo read_camera_file(const std::string& path);

}  // namespace saras_ros1
