// Files that come with the program. Any thread; reads folders.
#pragma once

#include <filesystem>
#include <initializer_list>

namespace neritic::tools {

// The first of these places, relative paths, that exists in a folder above the program, the nearest
// folder first: "assets/NAME" beside the sources, "share/neritic/assets/NAME" installed. Empty:
// none.
std::filesystem::path find_shipped(std::initializer_list<std::filesystem::path> places);

}  // namespace neritic::tools
