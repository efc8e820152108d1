// The panels that `dive` draws over the picture: compass and depth, facts and timings, the live
// sonars, the keys. Dear ImGui calls between Overlay::begin and Overlay::declare. Rendering thread.
#pragma once

#include <imgui.h>

#include <span>
#include <string>
#include <vector>

#include "sonar/beam_grid.hpp"
#include "testbed/loop/dive_camera.hpp"
#include "testbed/loop/dive_fan.hpp"
#include "testbed/loop/dive_times.hpp"

namespace neritic::testbed {

struct SonarPanel {
  std::string name;
  ImTextureID picture{};
  FanShape shape;
  sonar::BeamGrid grid;
  double rate_hz = 0.0;
};

struct PanelFacts {
  std::string title, device, water;  // water empty: none
  std::uint32_t width = 0, height = 0;
  double time_s = 0.0;
  std::vector<SonarPanel> sonars;
  std::vector<std::string> vehicles;  // a line each
};

void draw_readout(const FreeCamera& camera, float scale);
// Returns the panel's height in pixels. In a window too narrow for status and sonars side by side
// it leaves out the times of the passes, and the sonars stand below it.
float draw_status(const PanelFacts& facts, const FreeCamera& camera, const DiveTimes& times,
                  TimeNs now_ns, float scale);
void draw_sonars(const PanelFacts& facts, float status_height_px, float scale);
// Whether the list of keys fits between the side panels; else it is shown instead of them.
bool help_leaves_room(std::span<const xr::ActionDesc> actions, float scale);
// actions: whose controls are listed.
void draw_help(std::span<const xr::ActionDesc> actions, float scale);
// One line at the lower edge.
void draw_hint(const std::string& text, float scale);

}  // namespace neritic::testbed
