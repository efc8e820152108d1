// A message of a picture as a .png: sensor_msgs/Image, marine_acoustic_msgs/ProjectedSonarImage.
#pragma once

#include <filesystem>

#include "engine/recording/ros_message.hpp"

namespace neritic::tools {

bool is_picture(const std::string& type_name);
// Colours and 8-bit as they are; 16-bit as 16-bit; depth in metres as 16-bit millimetres; sonar
// intensities as 8-bit, 60 dB below the brightest to it. kBadInput for another encoding.
Status write_message_picture(const std::filesystem::path& path, const std::string& topic,
                             const std::string& type_name, const recording::RosMessage& type,
                             std::span<const std::byte> message);

}  // namespace neritic::tools
