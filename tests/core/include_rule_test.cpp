// The folder tables of ARCHITECTURE.md and testbed/README.md, checked against every #include of the
// sources: no folder includes what its row does not name, and no row names what it does not need.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

using Folders = std::set<std::string>;
using Table = std::map<std::string, Folders>;  // what a folder may include

constexpr const char* kEverything = "everything";

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) {
    const auto first = part.find_first_not_of(" `"), last = part.find_last_not_of(" `");
    parts.push_back(first == part.npos ? "" : part.substr(first, last - first + 1));
  }
  return parts;
}

// A name in a table as the beginning of an include: "gpu" is engine/gpu, "samples" in the testbed's
// table testbed/samples, and the headers of shaders are included as "shared/...".
std::string folder_named(const std::string& name, const std::string& parent) {
  if (name == "shaders" || name == "shaders/shared") return "shared";
  if (fs::is_directory(test::source_dir() / parent / name)) return parent + "/" + name;
  EXPECT_TRUE(fs::is_directory(test::source_dir() / name)) << "a table names the folder " << name;
  return name;
}

// The rows of the file's first table whose heading begins with "| folder |". parent: of names that
// are no path from the top.
Table table_of(const char* file, const std::string& parent) {
  Table table;
  std::istringstream lines(read_text(test::source_dir() / file).value());
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| folder |")) {
      inside = true;
    } else if (inside && !line.starts_with("|")) {
      break;
    } else if (inside && !line.starts_with("|---")) {
      const auto cells = split(line, '|');  // the first is empty
      EXPECT_GE(cells.size(), 4u) << file << ": " << line;
      if (cells.size() < 4 || cells[3] == kEverything || cells[1].ends_with('*')) continue;
      Folders may;
      for (const std::string& name : split(cells[3], ','))
        if (!name.empty() && name != "-") may.insert(folder_named(name, parent));
      for (const std::string& row : split(cells[1], ','))
        table[row == "shaders" ? row : folder_named(row, parent)] = may;
    }
  }
  return table;
}

// "engine/gpu/device.hpp" is in "engine/gpu"; "shared/types.h" in "shared"; "tools/..." in "tools".
std::string folder_of(const std::string& include) {
  const auto first = include.find('/');
  if (first == std::string::npos) return "";
  const std::string top = include.substr(0, first);
  if (top != "engine" && top != "testbed") return top;
  return include.substr(0, include.find('/', first + 1));
}

// The path that a line includes in quotes; empty if there is none.
std::string included(const std::string& line) {
  const std::string word = "#include \"";
  const auto at = line.find_first_not_of(" \t");
  if (at == line.npos || line.compare(at, word.size(), word) != 0) return "";
  const auto from = at + word.size();
  return line.substr(from, line.find('"', from) - from);
}

// The other folders of ours that the folder's sources include, each with one file that does.
std::map<std::string, std::string> includes_of(const std::string& folder, int& files) {
  const Folders ours{"engine", "shared",  "sonar", "diver", "rov",
                     "hud",    "testbed", "tools", "tests", "shaders"};
  std::map<std::string, std::string> found;
  const fs::path root = test::source_dir() / (folder == "shared" ? "shaders/shared" : folder);
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension();
    if (extension != ".hpp" && extension != ".cpp" && extension != ".h") continue;
    ++files;
    std::istringstream text(read_text(entry.path()).value());
    for (std::string line; std::getline(text, line);) {
      const std::string path = included(line), target = folder_of(path);
      if (ours.contains(target.substr(0, target.find('/'))) && target != folder)
        found.emplace(target, entry.path().string() + " includes " + path);
    }
  }
  return found;
}

int check(const Table& table, const Folders& all_may) {
  int files = 0;
  for (const auto& [folder, may] : table) {
    const auto includes = includes_of(folder, files);
    for (const auto& [target, where] : includes)
      EXPECT_TRUE(may.contains(target) || all_may.contains(target)) << where;
    for (const std::string& target : may)
      EXPECT_TRUE(includes.contains(target) || target == folder)
          << "the row of " << folder << " names " << target << ", which it does not include";
  }
  return files;
}

void expect_rows(const Table& table, const std::string& parent) {
  for (const auto& entry : fs::directory_iterator(test::source_dir() / parent))
    if (entry.is_directory()) {
      const std::string folder = parent + "/" + entry.path().filename().string();
      EXPECT_TRUE(table.contains(folder)) << "no row for " << folder;
    }
}

TEST(IncludeRule, FoldersIncludeWhatTheTableOfTheArchitectureNames) {
  const Table table = table_of("ARCHITECTURE.md", "engine");
  expect_rows(table, "engine");
  for (const char* folder : {"sonar", "rov", "diver", "hud", "shared"})
    EXPECT_TRUE(table.contains(folder)) << "no row for " << folder;
  EXPECT_GT(check(table, {}), 300);
}

TEST(IncludeRule, FoldersOfTheTestbedIncludeWhatItsTableNames) {
  const Table table = table_of("testbed/README.md", "testbed");
  expect_rows(table, "testbed");
  EXPECT_GT(check(table, {"engine/core"}), 300);
}

}  // namespace
}  // namespace neritic
