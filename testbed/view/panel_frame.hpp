// The common parts of panels: their window, colours and lines of text. Dear ImGui calls. Rendering
// thread.
#pragma once

#include <imgui.h>

#include <string>

#include "hud/numbers.hpp"
#include "testbed/view/panel_layout.hpp"

namespace neritic::testbed {

inline constexpr ImGuiWindowFlags kFixedPanel =
    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
    ImGuiWindowFlags_NoFocusOnAppearing;
inline constexpr ImU32 kInk = IM_COL32(230, 242, 247, 255);
inline constexpr ImU32 kFaint = IM_COL32(230, 242, 247, 150);
inline constexpr ImU32 kLine = IM_COL32(158, 204, 219, 80);
inline constexpr ImU32 kRim = IM_COL32(158, 204, 219, 170);
inline constexpr ImU32 kPaper = IM_COL32(5, 12, 17, 190);
inline constexpr ImU32 kSolidPaper = IM_COL32(5, 12, 17, 235);  // over other panels
inline constexpr ImU32 kMark = IM_COL32(255, 190, 80, 255);
inline constexpr ImU32 kAlarm = IM_COL32(255, 84, 66, 255);
inline constexpr float kEdge_px = 12.0f;  // between panels and the window's edges, at scale 1

// A panel of just that place; ImGui::End() ends it. title: an ImGui name, what is shown before its
// "###".
void begin_panel(const std::string& title, const PanelRect& rect, float scale, int flags = 0);
// The height of a panel with that many lines of text below its title, at scale 1.
float height_of_lines(std::size_t lines, float scale);
void text_line(const std::string& text);
// "4.20 m" with that many decimals; a depth that rounds to nothing has no sign.
std::string metres_text(double m, int decimals);
// The same, in feet with a decimal less where units are imperial.
std::string length_text(double m, int decimals, hud::Units units);
// "0.80 m/s" or "2.6 ft/s".
std::string speed_text(double m_s, hud::Units units);
// "12 N" or "3 lbf"; "28 l/min" or "1.00 cu ft/min".
std::string force_text(double n, hud::Units units);
std::string flow_text(double l_min, hud::Units units);
// The metres of a unit of length, and its name.
struct LengthUnit {
  double m = 1.0;
  const char* name = "m";
};
LengthUnit length_unit(hud::Units units);
// Its middle is at x, its top at y.
void centered_text(ImDrawList& list, float x, float y, ImU32 color, const std::string& text);

}  // namespace neritic::testbed
