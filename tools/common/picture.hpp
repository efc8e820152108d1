// Pictures of curves. The program writes their data as JSON; tools/plot, a Python module, draws
// them with matplotlib. If Python, matplotlib or the module is missing, the data is written all
// the same, and one line on stderr says what to install: that is no failure. One thread at a time.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/core/result.hpp"

namespace neritic::tools {

// Debian's own Python comes first: that is where its packages are.
inline constexpr const char* kPythons[] = {"/usr/bin/python3", "python3"};

// A Python module of ours in a folder above the program: tools/NAME beside the sources, or
// installed in share/neritic/NAME. Empty: nowhere.
std::filesystem::path find_python_module(const std::string& name);

// The data lies beside its picture: dive.plot.json beside dive.png.
std::filesystem::path picture_data_path(const std::filesystem::path& picture);

// Draws a data file that has the key "picture" (tools/plot/README.md). False: nothing here can
// draw, which has been said. kIo: the picture could not be drawn or written.
Result<bool> draw_picture(const std::filesystem::path& data, const std::filesystem::path& picture);

// Writes the data beside the picture, then draws it.
Result<bool> write_picture(const std::filesystem::path& picture, const nlohmann::json& data);

// The version of the matplotlib that draws, by asking the first Python here that has it ("3.6.3 of
// /usr/bin/python3"); empty: none has.
std::string matplotlib_here();
// The advice for that.
inline constexpr const char* kHowToGetMatplotlib =
    "tools/setup plots installs it (Debian's python3-matplotlib)";

// Six significant digits, which are more than a picture shows: the data stays small.
double six_digits(double value);

}  // namespace neritic::tools
