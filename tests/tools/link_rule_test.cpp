// The simulation part of the testbed links no Vulkan, plot, window or panel: by CMake's graph of
// targets (written when the build is configured), and by what is in the programs.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using Graph = std::map<std::string, std::set<std::string>>;

std::filesystem::path build() {
  return NERITIC_BINARY_DIR;
}

// Lines "target: library library ...", private libraries included.
Graph link_graph() {
  Graph graph;
  std::istringstream lines(read_text(build() / "link_graph.txt").value());
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string target;
    words >> target;
    auto& linked = graph[target.substr(0, target.find(':'))];
    for (std::string library; words >> library;) linked.insert(library);
  }
  return graph;
}

// Everything that a target links, over all steps.
std::set<std::string> all_linked(const Graph& graph, const std::string& target) {
  std::set<std::string> out;
  std::vector<std::string> left{target};
  while (!left.empty()) {
    const auto at = graph.find(left.back());
    left.pop_back();
    if (at == graph.end()) continue;
    for (const std::string& library : at->second)
      if (out.insert(library).second) left.push_back(library);
  }
  return out;
}

// Libraries that have a GPU, a window, a plot or a panel.
const std::set<std::string> kPictures{
    "neritic_gpu",     "neritic_graph", "neritic_draw2d",   "neritic_render",    "neritic_xr",
    "neritic_desktop", "neritic_sonar", "neritic_hud",      "neritic_shaders",   "neritic_sensors",
    "neritic_output",  "neritic_loop",  "neritic_view",     "neritic_picture",   "Vulkan::Headers",
    "Vulkan::Vulkan",  "glfw",          "PkgConfig::IMGUI", "Freetype::Freetype"};

TEST(LinkRule, TheSimulationPartLinksNoPicture) {
  const Graph graph = link_graph();
  for (const char* target :
       {"neritic_samples", "neritic_simulation", "neritic_motion", "neritic_record", "neritic_rov",
        "neritic_diver", "neritic_sim", "neritic_envs", "neritic_devices", "neritic_simulators"}) {
    ASSERT_TRUE(graph.contains(target)) << target;
    const auto linked = all_linked(graph, target);
    EXPECT_TRUE(linked.contains("neritic_core")) << target;
    for (const std::string& library : linked)
      EXPECT_FALSE(kPictures.contains(library)) << target << " links " << library;
  }
}

// The pictures of instruments are drawn on the CPU.
TEST(LinkRule, InstrumentsNeedNoGpu) {
  const auto linked = all_linked(link_graph(), "neritic_instruments");
  EXPECT_TRUE(linked.contains("neritic_hud"));
  for (const std::string& library : linked)
    if (library != "neritic_hud" && library != "neritic_draw2d" &&
        library != "Freetype::Freetype") {
      EXPECT_FALSE(kPictures.contains(library)) << library;
    }
}

TEST(LinkRule, TheViewAloneLinksTheWindowAndTheLoopDoesNot) {
  const Graph graph = link_graph();
  const auto loop = all_linked(graph, "neritic_loop"), view = all_linked(graph, "neritic_view");
  for (const char* library : {"neritic_gpu", "neritic_sonar", "neritic_simulation", "neritic_xr",
                              "Freetype::Freetype", "Vulkan::Headers"}) {
    EXPECT_TRUE(loop.contains(library)) << library;
    EXPECT_TRUE(view.contains(library)) << library;
  }
  for (const char* library : {"neritic_desktop", "glfw", "PkgConfig::IMGUI"}) {
    EXPECT_FALSE(loop.contains(library)) << library;
    EXPECT_TRUE(view.contains(library)) << library;
  }
}

// Vulkan is loaded by its file's name, which stands in every program that can load it; what is
// linked at the start is named alike.
TEST(LinkRule, NoSimulationProgramNamesVulkanOrAWindow) {
  const auto names = [](const std::string& program, const std::string& library) {
    return read_text(build() / program).value().find(library) != std::string::npos;
  };
  for (const char* library : {"libvulkan.so", "libglfw.so"}) {
    EXPECT_TRUE(names("tools/neritic", library)) << library;
    for (const char* program : {"tests/test_simulation", "tests/test_samples"})
      EXPECT_FALSE(names(program, library)) << program << " names " << library;
  }
}

}  // namespace
}  // namespace neritic
