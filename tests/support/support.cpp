#include "tests/support/support.hpp"

#include <unistd.h>

#include <atomic>
#include <cctype>
#include <cstdlib>

#include "engine/core/memory.hpp"

namespace neritic::test {
namespace fs = std::filesystem;
namespace {

// As the programs begin.
[[maybe_unused]] const bool kept = (keep_freed_memory(), true);

}  // namespace

fs::path source_dir() {
  return NERITIC_SOURCE_DIR;
}

std::optional<fs::path> shared_dir() {
  const char* named = std::getenv("NERITIC_SHARED");
  const fs::path folder = named ? fs::path(named) : source_dir().parent_path() / "shared";
  if (!fs::is_directory(folder / "reference")) return std::nullopt;
  return folder;
}

std::string test_name(std::size_t index, std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string name = std::to_string(index) + "_";
  for (const char c : text.substr(0, kLongest)) {
    const bool word = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (word || name.back() != '_') name += word ? c : '_';
  }
  if (name.back() == '_') name.pop_back();
  return name;
}

ScratchFolder::ScratchFolder() {
  static std::atomic<int> counter{0};
  path_ = fs::temp_directory_path() /
          ("neritic-test-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
  fs::remove_all(path_);
  fs::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace neritic::test
