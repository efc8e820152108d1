#include "tools/common/shipped.hpp"

namespace neritic::tools {

namespace fs = std::filesystem;

fs::path find_shipped(std::initializer_list<fs::path> places) {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  for (fs::path folder = program.parent_path(); !folder.empty(); folder = folder.parent_path()) {
    for (const fs::path& place : places)
      if (fs::exists(folder / place, none)) return folder / place;
    if (folder == folder.root_path()) break;
  }
  return {};
}

}  // namespace neritic::tools
