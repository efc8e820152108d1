// The panels that `dive` draws over the picture: compass and depth, participants, the live sonars,
// times of passes. Dear ImGui calls between Overlay::begin and Overlay::declare.
// Rendering thread.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "sonar/beam_grid.hpp"
#include "testbed/view/dive_camera.hpp"
#include "testbed/view/dive_fan.hpp"
#include "testbed/view/dive_times.hpp"
#include "testbed/view/gauge_panel.hpp"
#include "testbed/view/graph_panel.hpp"
#include "testbed/view/map_panel.hpp"
#include "testbed/view/panel_layout.hpp"

namespace neritic::testbed {

struct SonarPanel {
  std::string name;
  ImTextureID picture{};
  FanShape shape;
  sonar::BeamGrid grid;
  double rate_hz = 0.0;
};

struct ParticipantRow {
  std::string name, doing;  // doing: one line more; empty: none
  double depth_m = 0.0, speed_m_s = 0.0, away_m = 0.0;
};

// The depth and heading that stand below the compass, and whose they are: the participant's that
// carries the view or is chased, else the camera's.
struct Readout {
  std::string whose = "camera";
  double depth_m = 0.0, heading_rad = 0.0;
  int decimals = 2;  // of the depth
};

// Another camera's live picture.
struct InsetPanel {
  std::string name;
  ImTextureID picture{};
  float aspect = 0.75f;  // height over width
};

struct PanelFacts {
  std::string title, water, view, pace;  // water empty: none; pace: that of the clock
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> given_up;     // a line each, where the machine is too slow
  double time_s = 0.0, speed_m_s = 0.0;  // of the scene; of the free view
  std::vector<SonarPanel> sonars;        // that have pinged
  std::vector<ParticipantRow> participants;
  std::vector<std::string> troubles;  // a line each
  std::vector<std::string> devices;   // of the lab, up to two lines each
  std::string recording;              // "REC 0:12  FILE"; empty: nothing is recorded
  double sonar_gain_db = 0.0;
  Readout readout;
  hud::Units units = hud::Units::kMetric;
  // On demand; those that are absent are not drawn.
  std::optional<VehicleGauges> gauges;
  std::optional<InsetPanel> inset;
  std::vector<MapMark> marks;  // of the map
  MapMark eye;
};

// The panels of the picture, laid out for the display: compass with depth, status with
// participants, sonars from `first_sonar` on. times: those of the passes are shown; nullptr: not.
// hint: one line at the lower edge.
struct PanelsShown {
  std::size_t first_sonar = 0;
  std::string next_sonar;  // the key to the next one; empty: none
  const DiveTimes* frames = nullptr;
  std::string device;  // of the passes' times; empty: they are not shown
  std::string hint;
  const MapTrails* trails = nullptr;    // nullptr: no map
  const RunNumbers* numbers = nullptr;  // nullptr: no graphs
  std::span<const PanelRect> taken;     // by a diver's instruments, pixels
  GraphChoice* graphs = nullptr;        // with numbers
};
// The line at the lower edge: what was asked for and has no room first. wished: names of the
// layout's extras; sonars: how many there are to show; next_sonar: the key to the next one.
std::string hint_words(const std::string& hint, const std::vector<std::string>& wished,
                       const PanelLayout& layout, std::size_t sonars,
                       const std::string& next_sonar);
void draw_panels(const PanelFacts& facts, const PanelsShown& shown, TimeNs now_ns, float scale);
// "0.5 to 10 m"
std::string range_words(const sonar::Limits& limits, hud::Units units);
// "diver  depth 12.3 m  heading 091°"
std::string readout_words(const Readout& readout, hud::Units units);
// Where the panels are hidden: one line at the lower edge; the light of a recording.
void draw_hint(const std::string& text, float scale);
// The same in larger letters: what the person is to do.
void draw_task(const std::string& text, float scale);
void draw_recording_light(const std::string& text, float scale);

}  // namespace neritic::testbed
