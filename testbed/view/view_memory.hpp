// The look of a person's window at the end of the last dive: its size, the panels that were
// shown, the graphs' numbers. A small file of the user's state folder. Plain value; any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::testbed {

struct ViewMemory {
  std::uint32_t width = 1280, height = 720;
  bool panels = true, times = false, map = false, graphs = false;
  std::vector<std::string> numbers;  // of the graphs
  double sonar_gain_db = 0.0, sonar_range_part = 1.0;
  bool operator==(const ViewMemory&) const = default;
};

// $XDG_STATE_HOME/neritic/window.json, else in ~/.local/state; empty: there is no such folder.
std::filesystem::path view_memory_file();
// A file that is not there gives the defaults; one that does not read kBadInput in one line.
Result<ViewMemory> read_view_memory(const std::filesystem::path& file);
Status write_view_memory(const std::filesystem::path& file, const ViewMemory& memory);

}  // namespace neritic::testbed
