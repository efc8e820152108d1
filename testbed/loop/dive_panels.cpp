#include "testbed/loop/dive_panels.hpp"

#include <algorithm>
#include <cmath>

#include "engine/draw2d/axes.hpp"

namespace neritic::testbed {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoNav |
                                    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoFocusOnAppearing;
constexpr ImU32 kInk = IM_COL32(230, 242, 247, 255);
constexpr ImU32 kFaint = IM_COL32(230, 242, 247, 150);
constexpr ImU32 kPaper = IM_COL32(5, 12, 17, 190);
// Pixels at scale 1.
constexpr float kEdge_px = 12.0f;  // between panels and the window's edges
constexpr float kGap_px = 8.0f;    // between panels
constexpr float kStatusWidth_px = 330.0f, kSonarWidth_px = 360.0f, kReadoutWidth_px = 340.0f;
constexpr float kNarrowSonarWidth_px = 280.0f;  // below the status, above the readout of 640 x 480
// Room beside and above a fan for its ranges and its bearing: "12.5 m" is 40 pixels wide.
constexpr float kFanMargin_px = 44.0f;

// Whether status and sonars stand side by side, each with its edge and its window's padding.
bool side_by_side(float scale) {
  const float sonar = kSonarWidth_px * scale + 2.0f * ImGui::GetStyle().WindowPadding.x;
  const float wanted = sonar + (kStatusWidth_px + 2.0f * kEdge_px + kGap_px) * scale;
  return ImGui::GetIO().DisplaySize.x >= wanted;
}

void text_line(const std::string& text) {
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
}

void centered(ImDrawList& list, float x, float y, ImU32 color, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddText(ImVec2(std::floor(x - size.x * 0.5f), std::floor(y)), color, text.c_str());
}

std::string bearing_name(int degrees) {
  switch (degrees) {
    case 0:
      return "N";
    case 90:
      return "E";
    case 180:
      return "S";
    case 270:
      return "W";
    default:
      return fmt::format("{:03}", degrees);
  }
}

// The compass card: 120 degrees around the heading, a mark every 5, a number every 30.
void draw_card(ImDrawList& list, double heading_deg, float x, float y, float half_width,
               float scale) {
  constexpr double kHalfSpan_deg = 60.0;
  const float height = 30.0f * scale;
  list.AddRectFilled(ImVec2(x - half_width, y), ImVec2(x + half_width, y + height), kPaper,
                     4.0f * scale);
  const int first = static_cast<int>(std::ceil((heading_deg - kHalfSpan_deg) / 5.0)) * 5;
  for (int mark = first; mark <= heading_deg + kHalfSpan_deg; mark += 5) {
    const auto off = static_cast<float>((mark - heading_deg) / kHalfSpan_deg);
    const float at = x + off * (half_width - 14.0f * scale);
    const int bearing = (mark % 360 + 360) % 360;
    const bool named = bearing % 30 == 0;
    list.AddLine(ImVec2(at, y + 2.0f * scale), ImVec2(at, y + (named ? 9.0f : 6.0f) * scale),
                 named ? kInk : kFaint, scale);
    if (named) centered(list, at, y + 12.0f * scale, kInk, bearing_name(bearing));
  }
  list.AddTriangleFilled(ImVec2(x - 5.0f * scale, y - 5.0f * scale),
                         ImVec2(x + 5.0f * scale, y - 5.0f * scale), ImVec2(x, y + 3.0f * scale),
                         IM_COL32(255, 190, 80, 255));
}

void draw_rings(ImDrawList& list, const SonarPanel& panel, ImVec2 corner, ImVec2 size) {
  const sonar::Limits& l = panel.grid.limits;
  constexpr ImU32 kLine = IM_COL32(158, 204, 219, 80), kRim = IM_COL32(158, 204, 219, 170);
  // Rings about so many; a smaller first range has no room for its label.
  constexpr double kRings = 6.0, kLeastLabelled = 0.06;
  const auto at = [&](double range_m, double bearing_rad) {
    const Vec2 p = panel.shape.place(range_m, bearing_rad);
    return ImVec2(corner.x + static_cast<float>(p.x) * size.x,
                  corner.y + static_cast<float>(p.y) * size.y);
  };
  const auto arc = [&](double range_m, ImU32 color) {
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i)
      list.PathLineTo(
          at(range_m, glm::mix(l.azimuth_min_rad, l.azimuth_max_rad, double(i) / kSteps)));
    list.PathStroke(color, ImDrawFlags_None, 1.0f);
  };
  const double middle = 0.5 * (l.azimuth_min_rad + l.azimuth_max_rad);
  const auto label = [&](double range_m) {
    const ImVec2 edge = at(range_m, l.azimuth_max_rad);
    list.AddText(ImVec2(edge.x + 4.0f, edge.y - 2.0f), kInk,
                 fmt::format("{:.3g} m", range_m).c_str());
  };
  arc(l.range_min_m, kRim);
  if (l.range_min_m > kLeastLabelled * l.range_max_m) label(l.range_min_m);
  const double step = draw2d::nice_step(l.range_max_m, kRings);
  for (double range_m = step; range_m < l.range_max_m - 0.35 * step; range_m += step) {
    if (range_m <= l.range_min_m + 0.5 * step) continue;  // its label would meet the first one
    arc(range_m, kLine);
    label(range_m);
  }
  arc(l.range_max_m, kRim);
  label(l.range_max_m);
  for (const double bearing : {l.azimuth_min_rad, l.azimuth_max_rad})
    list.AddLine(at(l.range_min_m, bearing), at(l.range_max_m, bearing), kRim);
  for (const double part : {0.25, 0.5, 0.75}) {
    const double bearing = glm::mix(l.azimuth_min_rad, l.azimuth_max_rad, part);
    list.AddLine(at(l.range_min_m, bearing), at(l.range_max_m, bearing), kLine);
  }
  const ImVec2 top = at(l.range_max_m, middle);
  centered(list, top.x, top.y - ImGui::GetTextLineHeight() - 2.0f, kInk,
           fmt::format("{:.0f}\u00b0", degrees(middle)));
}

void draw_sonar(const SonarPanel& panel, float width, float scale) {
  const sonar::Limits& l = panel.grid.limits;
  ImGui::TextDisabled(
      "%s", fmt::format("{:.3g} to {:.3g} m   {:.0f}\u00b0 x {:.0f}\u00b0   {:g} Hz", l.range_min_m,
                        l.range_max_m, degrees(l.azimuth_max_rad - l.azimuth_min_rad),
                        degrees(l.elevation_max_rad - l.elevation_min_rad), panel.rate_hz)
                .c_str());
  const float margin_x = kFanMargin_px * scale,
              margin_y = ImGui::GetTextLineHeight() + 6.0f * scale;
  const float fan_width = width - 2.0f * margin_x;
  const ImVec2 size(fan_width, fan_width * static_cast<float>(panel.shape.height) /
                                   static_cast<float>(panel.shape.width));
  const ImVec2 start = ImGui::GetCursorScreenPos();
  const ImVec2 corner(start.x + margin_x, start.y + margin_y);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (panel.picture)
    list.AddImage(panel.picture, corner, ImVec2(corner.x + size.x, corner.y + size.y));
  draw_rings(list, panel, corner, size);
  ImGui::Dummy(ImVec2(width, size.y + margin_y + 8.0f * scale));
}

// "W  S", "mouse wheel": the keys and the mouse's controls, without the gamepad's.
std::string desktop_controls(const xr::ActionDesc& action) {
  std::string text;
  for (std::string binding : action.bindings) {
    if (binding.starts_with('-')) binding.erase(0, 1);
    if (binding.starts_with("pad ")) continue;
    if (binding.starts_with("key ")) binding.erase(0, 4);
    if (const auto at = binding.find(" while "); at != std::string::npos)
      binding = "hold " + binding.substr(at + 7);
    text += (text.empty() ? "" : "  ") + binding;
  }
  return text;
}

void timings_table(const DiveTimes& times, TimeNs now_ns, float scale) {
  double gpu_ms = 0.0;
  for (const TimeRow& pass : times.passes())
    if (pass.name != "record" && times.recent(pass, now_ns)) gpu_ms += pass.smooth_ms;
  if (!(gpu_ms > 0.0)) {  // the first frames are still under way, or the device measures none
    ImGui::TextDisabled("no pass measured yet");
    return;
  }
  const auto row = [&](const std::string& name, double ms) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    text_line(name);
    ImGui::TableNextColumn();
    const auto part = static_cast<float>(std::min(1.0, ms / gpu_ms));
    ImGui::ProgressBar(part, ImVec2(-1.0f, ImGui::GetTextLineHeight()),
                       fmt::format("{:.2f}", ms).c_str());
  };
  if (!ImGui::BeginTable("passes", 2)) return;
  ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("ms", ImGuiTableColumnFlags_WidthFixed, 110.0f * scale);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("GPU pass");
  ImGui::TableNextColumn();
  ImGui::TextDisabled("ms");
  for (const TimeRow& pass : times.passes())
    if (times.recent(pass, now_ns))
      row(pass.name == "record" ? "(record, host)" : pass.name, pass.smooth_ms);
  row("all passes", gpu_ms);
  ImGui::EndTable();
}

}  // namespace

void draw_readout(const FreeCamera& camera, float scale) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float x = display.x * 0.5f, half = 0.5f * kReadoutWidth_px * scale;
  // At the top, or at the bottom where the panels leave no room between them.
  const float between = 0.5f * display.x - (kSonarWidth_px + 4.0f * kEdge_px) * scale;
  const float y = between > half ? kEdge_px * scale : display.y - 70.0f * scale;
  draw_card(list, camera.heading_deg(), x, y, half, scale);
  const double depth_m = -camera.position_m().y;
  const std::string text =
      depth_m >= 0.0 ? fmt::format("depth {:5.2f} m    heading {:03.0f}\u00b0", depth_m,
                                   std::fmod(std::round(camera.heading_deg()), 360.0))
                     : fmt::format("{:.2f} m above water    heading {:03.0f}\u00b0", -depth_m,
                                   std::fmod(std::round(camera.heading_deg()), 360.0));
  const float top = y + 34.0f * scale, height = ImGui::GetTextLineHeight() + 8.0f * scale;
  list.AddRectFilled(ImVec2(x - half, top), ImVec2(x + half, top + height), kPaper, 4.0f * scale);
  centered(list, x, top + 4.0f * scale, kInk, text);
}

float draw_status(const PanelFacts& facts, const FreeCamera& camera, const DiveTimes& times,
                  TimeNs now_ns, float scale) {
  ImGui::SetNextWindowPos(ImVec2(kEdge_px * scale, kEdge_px * scale), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints(ImVec2(kStatusWidth_px * scale, 0.0f),
                                      ImVec2(kStatusWidth_px * scale, 1e6f));
  const std::string title = facts.title + "###status";
  ImGui::Begin(title.c_str(), nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoSavedSettings);
  const double frame_ms = times.frame().smooth_ms;
  const std::string rate =
      frame_ms > 0.0 ? fmt::format("{:.1f} FPS   {:.1f} ms a frame", 1000.0 / frame_ms, frame_ms)
                     : "first frame";
  text_line(fmt::format("{}   {} x {}", rate, facts.width, facts.height));
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextDisabled("%s", facts.device.c_str());
  ImGui::PopTextWrapPos();
  const Vec3& p = camera.position_m();
  text_line(fmt::format("x {:.2f}  y {:.2f}  z {:.2f} m   pitch {:.0f}\u00b0", p.x, p.y, p.z,
                        degrees(camera.pitch_rad())));
  text_line(fmt::format("speed {:.2f} m/s   time {:.1f} s{}", camera.speed_m_s(), facts.time_s,
                        facts.water.empty() ? "" : "   water " + facts.water));
  ImGui::PushTextWrapPos(0.0f);
  for (const std::string& line : facts.vehicles) text_line(line);
  ImGui::PopTextWrapPos();
  // Where the sonars stand below, there is no room for the times.
  if (facts.sonars.empty() || side_by_side(scale)) {
    ImGui::Separator();
    timings_table(times, now_ns, scale);
  }
  const float height = ImGui::GetWindowHeight();
  ImGui::End();
  return height;
}

void draw_sonars(const PanelFacts& facts, float status_height_px, float scale) {
  const bool beside = side_by_side(scale);
  const float width = (beside ? kSonarWidth_px : kNarrowSonarWidth_px) * scale;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  float y = kEdge_px * scale;
  if (!beside) y += status_height_px + kGap_px * scale;
  for (const SonarPanel& panel : facts.sonars) {
    ImGui::SetNextWindowPos(ImVec2(display.x - kEdge_px * scale, y), ImGuiCond_Always,
                            ImVec2(1.0f, 0.0f));
    const std::string title = panel.name + "###sonar " + panel.name;
    ImGui::Begin(title.c_str(), nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove);
    if (!ImGui::IsWindowCollapsed()) draw_sonar(panel, width, scale);
    y += ImGui::GetWindowHeight() + kGap_px * scale;
    ImGui::End();
  }
}

bool help_leaves_room(std::span<const xr::ActionDesc> actions, float scale) {
  float controls = 0.0f, helps = 0.0f;
  for (const xr::ActionDesc& action : actions) {
    if (action.help.empty()) continue;
    controls = std::max(controls, ImGui::CalcTextSize(desktop_controls(action).c_str()).x);
    helps = std::max(helps, ImGui::CalcTextSize(action.help.c_str()).x);
  }
  const ImGuiStyle& style = ImGui::GetStyle();
  const float list = controls + helps + 4.0f * style.CellPadding.x + 2.0f * style.WindowPadding.x;
  // The wider of the side panels on each side, since the list stands in the middle.
  const float side = (kSonarWidth_px + kEdge_px + kGap_px) * scale + 2.0f * style.WindowPadding.x;
  return ImGui::GetIO().DisplaySize.x >= list + 2.0f * side;
}

void draw_help(std::span<const xr::ActionDesc> actions, float scale) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(display.x * 0.5f, display.y * 0.5f), ImGuiCond_Always,
                          ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::Begin("Keys", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse);
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const xr::ActionDesc& action : actions) {
      if (action.help.empty()) continue;
      ImGui::TableNextRow(ImGuiTableRowFlags_None, ImGui::GetTextLineHeight() + 6.0f * scale);
      ImGui::TableNextColumn();
      text_line(desktop_controls(action));
      ImGui::TableNextColumn();
      ImGui::TextDisabled("%s", action.help.c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void draw_hint(const std::string& text, float scale) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(kEdge_px * scale, display.y - kEdge_px * scale), ImGuiCond_Always,
                          ImVec2(0.0f, 1.0f));
  ImGui::SetNextWindowBgAlpha(0.6f);
  ImGui::Begin("hint", nullptr,
               kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  text_line(text);
  ImGui::End();
}

}  // namespace neritic::testbed
