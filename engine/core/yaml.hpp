// The part of YAML that calibration files are written in (ROS camera_info, OpenCV's FileStorage),
// as JSON: maps and lists by indentation or in brackets, plain and quoted scalars on one line,
// comments, tags (ignored), one document. Anchors, aliases, merge keys and blocks of text are
// refused. Source: YAML 1.2. Any thread.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "engine/core/result.hpp"

namespace neritic {

// kBadInput: "line N: found X; accepted: Y".
Result<nlohmann::json> parse_yaml(std::string_view text);

}  // namespace neritic
