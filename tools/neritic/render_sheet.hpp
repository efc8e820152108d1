// `neritic render --sheet`: a frame's images as pictures for a person. Any thread.
#pragma once

#include <filesystem>

#include "tools/session/session.hpp"

namespace neritic::tools {

// OUT/sheet/SENSOR_color.png, SENSOR_sonar.png and the first camera's other images, and all of them
// on OUT/sheet.png. Motion is left out where nothing moves. kIo where they can't be written.
Status write_sheet(const std::filesystem::path& out, const FrameResult& result);

}  // namespace neritic::tools
