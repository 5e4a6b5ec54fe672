// Messages to the values of the overlay room. No node, no time: ages come from the caller.
#pragma once

#include <saras_ros1/CollisionState.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Float64MultiArray.h>

#include <map>
#include <string>
#include <vector>

#include "saras/overlay/overlay_painter.hpp"

namespace saras_ros1 {

/// Throws saras::ConfigError: no calibration, another lens model, binning or a region of interest.
saras::CameraConfig camera_config(const sensor_msgs::CameraInfo& info, bool rectified, double near_m);

/// False: an encoding that cannot be drawn on, or fewer bytes than the size says. data stays the message's.
bool view_of(sensor_msgs::Image& image, saras::ImageView& view);

/// Metres by tool, as the label of the first dimension names them; without one, in the source's order.
std::map<std::string, double> distances_by_tool(const std_msgs::Float64MultiArray& message);

/// The tools that are to be shown, in this order; those that are not in the message stay unknown.
/// state: the newest, for the colours. places: the one of the image's time, for positions; null: not known.
void fill_tools(const std::vector<std::string>& names, const CollisionState* state, const CollisionState* places,
                const std::map<std::string, double>& distances, saras::ToolOverlayInput& input);

}  // namespace saras_ros1
