// The folder table of ARCHITECTURE.md, checked against every #include of the sources.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>>& allowed() {
  static const std::map<std::string, std::set<std::string>> table{
      {"engine/core", {}},
      {"engine/gpu", {"engine/core"}},
      {"engine/graph", {"engine/core", "engine/gpu"}},
      {"engine/draw2d", {"engine/core"}},
      {"engine/scene", {"engine/core", "engine/recording"}},
      {"engine/render", {"engine/core", "engine/gpu", "engine/graph", "engine/scene", "shared"}},
      {"engine/xr", {"engine/core", "engine/gpu", "engine/graph", "engine/draw2d", "shared"}},
      {"engine/sim", {"engine/core"}},
      {"engine/net", {"engine/core"}},
      {"engine/recording", {"engine/core"}},
      {"sonar",
       {"engine/core", "engine/gpu", "engine/graph", "engine/draw2d", "engine/scene", "shared"}},
      {"diver", {"engine/core", "engine/sim", "engine/net"}},
      {"rov", {"engine/core", "engine/sim", "engine/net"}},
      {"hud",
       {"engine/core", "engine/gpu", "engine/graph", "engine/draw2d", "engine/xr", "diver", "rov"}},
      {"testbed/samples", {"engine/core", "engine/sim", "engine/recording", "rov", "diver"}},
      {"testbed/simulation",
       {"engine/core", "engine/scene", "testbed/samples", "engine/sim", "rov", "diver", "sonar"}},
      {"testbed/record",
       {"engine/core", "engine/scene", "testbed/samples", "engine/sim", "engine/recording", "rov",
        "diver", "testbed/simulation"}},
      {"testbed/motion",
       {"engine/core", "engine/scene", "testbed/samples", "engine/sim", "rov", "diver",
        "testbed/simulation"}},
      {"testbed/devices",
       {"engine/core", "engine/net", "engine/scene", "testbed/samples", "engine/sim", "rov",
        "diver", "testbed/simulation"}},
      {"testbed/simulators",
       {"engine/core", "engine/net", "engine/scene", "testbed/samples", "engine/sim", "rov",
        "diver", "testbed/simulation", "testbed/devices"}},
      {"testbed/instruments",
       {"engine/core", "engine/sim", "rov", "diver", "hud", "testbed/samples", "testbed/simulation",
        "testbed/devices"}},
      {"testbed/sensors",
       {"testbed/samples", "engine/core", "engine/gpu", "engine/graph", "engine/scene",
        "engine/render", "sonar", "shared"}},
      {"testbed/output",
       {"engine/core", "engine/gpu", "engine/graph", "engine/draw2d", "engine/scene",
        "engine/render", "engine/recording", "sonar", "shared", "testbed/sensors"}},
      {"testbed/loop",
       {"engine/core", "engine/gpu", "engine/graph", "engine/scene", "engine/sim", "engine/xr",
        "testbed/samples", "testbed/simulation", "testbed/motion", "testbed/record",
        "testbed/sensors"}},
      {"testbed/envs", {"engine/core", "engine/sim", "rov"}},
      {"testbed/world",
       {"engine/core", "engine/gpu", "engine/graph", "engine/scene", "engine/sim", "engine/xr",
        "sonar", "rov", "diver", "testbed/samples", "testbed/simulation", "testbed/motion",
        "testbed/record", "testbed/devices", "testbed/sensors", "testbed/loop",
        "testbed/instruments"}},
      {"testbed/server",
       {"engine/core", "engine/net", "hud", "testbed/world", "testbed/instruments"}},
      {"testbed/view",
       {"engine/core",
        "engine/gpu",
        "engine/graph",
        "engine/draw2d",
        "engine/scene",
        "engine/render",
        "engine/sim",
        "engine/xr",
        "sonar",
        "rov",
        "diver",
        "hud",
        "shared",
        "testbed/samples",
        "testbed/simulation",
        "testbed/motion",
        "testbed/record",
        "testbed/devices",
        "testbed/instruments",
        "testbed/sensors",
        "testbed/loop"}},
      {"shaders/shared", {"shared"}}};
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

TEST(IncludeRule, FoldersIncludeOnlyWhatTheTableAllows) {
  const std::set<std::string> ours{"engine", "shared",  "sonar", "diver", "rov",
                                   "hud",    "testbed", "tools", "tests", "shaders"};
  int files = 0;
  for (const auto& [folder, may] : allowed()) {
    const fs::path root = test::source_dir() / folder;
    if (!fs::is_directory(root)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      const std::string extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp" && extension != ".h") continue;
      ++files;
      std::istringstream text(read_text(entry.path()).value());
      for (std::string line; std::getline(text, line);) {
        const std::string path = included(line);
        if (path.empty()) continue;
        const std::string target = folder_of(path);
        if (!ours.contains(target.substr(0, target.find('/'))) || target == folder) continue;
        EXPECT_TRUE(may.contains(target)) << entry.path() << " includes " << path;
      }
    }
  }
  EXPECT_GT(files, 50);
}

}  // namespace
}  // namespace neritic
