// `neritic render --sheet`: a frame's images as pictures for a person. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "testbed/sensors/session.hpp"

namespace neritic::tools {

using ClassNames = std::map<std::uint16_t, std::string>;  // by class

// OUT/sheet/SENSOR_color.png, SENSOR_sonar.png and the first camera's other images, and all of them
// on OUT/sheet.png. Motion is left out where nothing moves. kIo where they can't be written.
// The names say what the labels' colours mean.
Status write_sheet(const std::filesystem::path& out, const testbed::FrameResult& result,
                   const ClassNames& names);

}  // namespace neritic::tools
