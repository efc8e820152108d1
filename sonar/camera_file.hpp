// The camera of one image from a .json or .yaml file: ROS camera_info, OpenCV's
// FileStorage, lists of frames. Any thread.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/core/result.hpp"

namespace neritic::sonar {

// The file as one object; of "frames" the one whose "id" stands in the depth file's name, else in
// its folders: whole, so that 1 is not found in 10. kBadInput with the path.
Result<nlohmann::json> read_camera_file(const std::filesystem::path& path,
                                        const std::string& depth_path);

// The value in short, for messages.
std::string quoted_json(const nlohmann::json& json);

// Numbers in a row, in lists of rows, or either as the "data" of a table (OpenCV, ROS); empty where
// something else stands there.
std::vector<double> numbers_in(const nlohmann::json& matrix);

}  // namespace neritic::sonar
