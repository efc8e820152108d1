// Definitions of the ROS 2 messages that recordings have, as `ros2msg` schemas say them: a
// message's own lines, then those of each type that it uses. Facts of the packages
// common_interfaces (Humble) and marine_acoustic_msgs 2.0.2. Pure functions; any thread.
#pragma once

#include <string>
#include <string_view>

#include "engine/recording/mcap.hpp"

namespace neritic::recording {

// type: "sensor_msgs/msg/Imu". Precondition: it is one of ours (ros_types.cpp).
McapSchema ros_schema(std::string_view type);
// A message of our own: its lines may use the types of ros_types.cpp by "geometry_msgs/Pose".
McapSchema own_schema(std::string_view type, std::string_view lines);

}  // namespace neritic::recording
