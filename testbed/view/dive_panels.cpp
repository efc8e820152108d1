#include "testbed/view/dive_panels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/draw2d/axes.hpp"
#include "hud/numbers.hpp"
#include "testbed/view/panel_frame.hpp"

namespace neritic::testbed {
namespace {

constexpr float kLeastTimes_px = 110.0f;  // of the height of the times' panel

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
    if (named) centered_text(list, at, y + 12.0f * scale, kInk, bearing_name(bearing));
  }
  list.AddTriangleFilled(ImVec2(x - 5.0f * scale, y - 5.0f * scale),
                         ImVec2(x + 5.0f * scale, y - 5.0f * scale), ImVec2(x, y + 3.0f * scale),
                         kMark);
}

void draw_rings(ImDrawList& list, const SonarPanel& panel, ImVec2 corner, ImVec2 size,
                hud::Units units) {
  const sonar::Limits& l = panel.grid.limits;
  const LengthUnit unit = length_unit(units);
  // About this number of rings; a smaller first range has no room for its label.
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
  // From the outside in, each that meets no label before it.
  std::optional<ImVec2> last;
  const auto label = [&](double range_m) {
    const ImVec2 edge = at(range_m, l.azimuth_max_rad);
    const std::string text = fmt::format("{:.3g} {}", range_m / unit.m, unit.name);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    if (last && std::abs(last->y - edge.y) < size.y && std::abs(last->x - edge.x) < size.x + 4.0f)
      return;
    // Within the panel, rather over the arc's end than cut.
    const float most = ImGui::GetWindowPos().x + ImGui::GetWindowWidth() - size.x - 4.0f;
    list.AddText(ImVec2(std::min(edge.x + 4.0f, most), edge.y - 2.0f), kInk, text.c_str());
    last = edge;
  };
  arc(l.range_max_m, kRim);
  label(l.range_max_m);
  const double step = unit.m * draw2d::nice_step(l.range_max_m / unit.m, kRings);
  for (double range_m = step * std::ceil(l.range_max_m / step - 0.65);
       range_m > l.range_min_m + 0.5 * step && range_m > 0.5 * step; range_m -= step) {
    if (range_m > l.range_max_m - 0.35 * step) continue;
    arc(range_m, kLine);
    label(range_m);
  }
  arc(l.range_min_m, kRim);
  if (l.range_min_m > kLeastLabelled * l.range_max_m) label(l.range_min_m);
  for (const double bearing : {l.azimuth_min_rad, l.azimuth_max_rad})
    list.AddLine(at(l.range_min_m, bearing), at(l.range_max_m, bearing), kRim);
  for (const double part : {0.25, 0.5, 0.75}) {
    const double bearing = glm::mix(l.azimuth_min_rad, l.azimuth_max_rad, part);
    list.AddLine(at(l.range_min_m, bearing), at(l.range_max_m, bearing), kLine);
  }
  const ImVec2 top = at(l.range_max_m, middle);
  centered_text(list, top.x, top.y - ImGui::GetTextLineHeight() - 2.0f, kInk,
                fmt::format("{:.0f}\u00b0", degrees(middle)));
}

void draw_sonar(const SonarPanel& panel, const PanelRect& rect, double gain_db, hud::Units units,
                float scale) {
  const sonar::Limits& l = panel.grid.limits;
  begin_panel(panel.name + "###sonar " + panel.name, rect, scale, ImGuiWindowFlags_NoScrollbar);
  const std::string settings =
      fmt::format("{}  {:.0f}\u00b0 x {:.0f}\u00b0  {:g} Hz{}", range_words(l, units),
                  degrees(l.azimuth_max_rad - l.azimuth_min_rad),
                  degrees(l.elevation_max_rad - l.elevation_min_rad), panel.rate_hz,
                  gain_db == 0.0 ? "" : fmt::format("  {:+g} dB", gain_db));
  const float inner = ImGui::GetContentRegionAvail().x;
  const bool fits = ImGui::CalcTextSize(settings.c_str()).x <= inner;
  ImGui::TextDisabled(
      "%s",
      fits ? settings.c_str()
           : fmt::format("{:.3g} {}  {:.0f}\u00b0", l.range_max_m / length_unit(units).m,
                         length_unit(units).name, degrees(l.azimuth_max_rad - l.azimuth_min_rad))
                 .c_str());
  const FanFrame frame;
  const float aspect =
      static_cast<float>(panel.shape.height) / static_cast<float>(panel.shape.width);
  const float height = (rect.height - frame.above_and_below) * scale;
  const float width = std::min((rect.width - 2.0f * frame.margin_x) * scale, height / aspect);
  const ImVec2 start = ImGui::GetCursorScreenPos();
  const ImVec2 corner((rect.x + 0.5f * rect.width) * scale - 0.5f * width,
                      start.y + ImGui::GetTextLineHeight() + 2.0f * scale);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (panel.picture)
    list.AddImage(panel.picture, corner, ImVec2(corner.x + width, corner.y + height));
  draw_rings(list, panel, corner, ImVec2(width, height), units);
  ImGui::End();
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

// At the lower edge of its place, as wide as its text. Words that are wider than the place go on in
// more lines upwards, over what lies there.
void draw_hint(const std::string& text, float scale, const PanelRect& rect, float letters = 1.0f) {
  const float x = rect.x * scale, bottom = rect.bottom() * scale, pad = 8.0f * scale;
  const float most =
      rect.width > 0.0f ? rect.width * scale : ImGui::GetIO().DisplaySize.x - x - kEdge_px * scale;
  const float room = std::max(1.0f, most - 2.0f * pad);
  const float font_px = letters * ImGui::GetFontSize();
  const ImVec2 size = ImGui::GetFont()->CalcTextSizeA(font_px, std::numeric_limits<float>::max(),
                                                      room, text.c_str());
  const float top = bottom - size.y - pad;
  const bool wrapped = size.y > 1.5f * font_px;
  ImDrawList& list = wrapped ? *ImGui::GetForegroundDrawList() : *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(ImVec2(x, top), ImVec2(x + std::min(size.x + 2.0f * pad, most), bottom),
                     wrapped ? kSolidPaper : kPaper, 4.0f * scale);
  list.AddText(ImGui::GetFont(), font_px, ImVec2(x + pad, top + 0.5f * pad), kInk, text.c_str(),
               nullptr, room);
}

void draw_readout(const PanelFacts& facts, const PanelRect& rect, float scale) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float half = 0.5f * rect.width * scale, x = rect.x * scale + half, y = rect.y * scale;
  const double heading_deg = std::fmod(degrees(facts.readout.heading_rad) + 720.0, 360.0);
  draw_card(list, heading_deg, x, y, half, scale);
  std::string text = readout_words(facts.readout, facts.units);
  if (ImGui::CalcTextSize(text.c_str()).x > 2.0f * half - 8.0f * scale)
    text = text.substr(facts.readout.whose.size() + 2);
  const float top = y + 34.0f * scale, height = 28.0f * scale;
  list.AddRectFilled(ImVec2(x - half, top), ImVec2(x + half, top + height), kPaper, 4.0f * scale);
  centered_text(list, x, top + 0.5f * (height - ImGui::GetTextLineHeight()), kInk, text);
}

std::string doing_words(const ParticipantRow& row) {
  return fmt::format("{}: {}", row.name, row.doing);
}

void participants_table(const PanelFacts& facts, float scale) {
  if (facts.participants.empty() || !ImGui::BeginTable("participants", 4)) return;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
  for (const char* column : {"depth", "speed", "away"})
    ImGui::TableSetupColumn(column, ImGuiTableColumnFlags_WidthFixed, 62.0f * scale);
  ImGui::TableNextRow();
  for (const char* heading : {"name", "depth", "speed", "away"}) {
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", heading);
  }
  for (const ParticipantRow& row : facts.participants) {
    ImGui::TableNextRow();
    for (const std::string& cell :
         {row.name, length_text(row.depth_m, 1, facts.units),
          speed_text(row.speed_m_s, facts.units), length_text(row.away_m, 1, facts.units)}) {
      ImGui::TableNextColumn();
      text_line(cell);
    }
  }
  ImGui::EndTable();
  ImGui::PushTextWrapPos(0.0f);
  for (const ParticipantRow& row : facts.participants)
    if (!row.doing.empty()) ImGui::TextDisabled("%s", doing_words(row).c_str());
  ImGui::PopTextWrapPos();
}

// A red light and what is recorded, in the current window.
void recording_line(const std::string& text) {
  const float height = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddCircleFilled(ImVec2(at.x + 0.45f * height, at.y + 0.5f * height),
                                              0.42f * height, kAlarm);
  ImGui::SetCursorScreenPos(ImVec2(at.x + 1.3f * height, at.y));
  text_line(text);
}

// Long lines are wrapped: they count as those that they take in a panel of the usual width.
std::size_t status_lines(const PanelFacts& facts, float scale) {
  constexpr float kInside_px = 296.0f;
  const auto& all = facts.participants;
  std::size_t lines = 3 + (facts.recording.empty() ? 0 : 1) + (all.empty() ? 0 : all.size() + 1);
  const auto add = [&](const std::string& text) {
    const float high = ImGui::CalcTextSize(text.c_str(), nullptr, false, kInside_px * scale).y;
    lines += static_cast<std::size_t>(std::lround(high / ImGui::GetTextLineHeight()));
  };
  for (const std::vector<std::string>* texts : {&facts.given_up, &facts.troubles, &facts.devices})
    std::ranges::for_each(*texts, add);
  for (const ParticipantRow& row : all)
    if (!row.doing.empty()) add(doing_words(row));
  return lines;
}

void draw_status(const PanelFacts& facts, const PanelsShown& shown, const PanelRect& rect,
                 float scale) {
  begin_panel(facts.title + "###status", rect, scale);
  if (!facts.recording.empty()) recording_line(facts.recording);
  const double frame_ms = shown.frames->frame().smooth_ms;
  const std::string rate =
      frame_ms > 0.0 ? fmt::format("{:.1f} FPS   {:.1f} ms a frame", 1000.0 / frame_ms, frame_ms)
                     : "first frame";
  text_line(fmt::format("{}   {} x {}", rate, facts.width, facts.height));
  text_line(fmt::format("time {:.1f} s{}{}", facts.time_s,
                        facts.pace.empty() ? "" : "   " + facts.pace,
                        facts.water.empty() ? "" : "   water " + facts.water));
  text_line(
      fmt::format("view {}{}", facts.view,
                  facts.view == "free" ? ", " + speed_text(facts.speed_m_s, facts.units) : ""));
  ImGui::PushTextWrapPos(0.0f);
  for (const std::string& line : facts.given_up) text_line(line);
  ImGui::PopTextWrapPos();
  participants_table(facts, scale);
  ImGui::PushTextWrapPos(0.0f);
  for (const std::string& line : facts.troubles) text_line(line);
  for (const std::string& line : facts.devices) text_line(line);
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void draw_inset(const InsetPanel& inset, const PanelRect& rect, float scale) {
  begin_panel(inset.name + "###inset", rect, scale, ImGuiWindowFlags_NoScrollbar);
  const ImVec2 from = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const float width = std::min(room.x, room.y / inset.aspect);
  const float x = from.x + 0.5f * (room.x - width);
  if (inset.picture)
    ImGui::GetWindowDrawList()->AddImage(inset.picture, ImVec2(x, from.y),
                                         ImVec2(x + width, from.y + width * inset.aspect));
  ImGui::End();
}

void draw_times(const PanelsShown& shown, const PanelRect& rect, TimeNs now_ns, float scale) {
  begin_panel("GPU passes###times", rect, scale);
  ImGui::TextDisabled("%s", shown.device.c_str());
  timings_table(*shown.frames, now_ns, scale);
  ImGui::End();
}

// The panels on demand, in the order of what an operator needs first.
struct Demand {
  std::vector<PanelWish> wishes;
  std::vector<std::string> names;                                // of each wish, for an operator
  std::optional<std::size_t> times, gauges, inset, map, graphs;  // their places in it
};

Demand demand_of(const PanelFacts& facts, const PanelsShown& shown, float scale) {
  constexpr float kInsetWidth_px = 300.0f, kInsetFrame_px = 40.0f, kLeastInset_px = 130.0f;
  Demand out;
  const auto add = [&](const char* name, bool wanted,
                       const PanelWish& wish) -> std::optional<std::size_t> {
    if (!wanted) return std::nullopt;
    out.wishes.push_back(wish);
    out.names.push_back(name);
    return out.wishes.size() - 1;
  };
  const std::size_t passes = shown.frames ? shown.frames->passes().size() : 0;
  out.times = add("times", !shown.device.empty(),
                  {.wanted = height_of_lines(passes + 4, scale), .least = kLeastTimes_px});
  out.gauges = add("gauges", facts.gauges.has_value(),
                   facts.gauges ? gauges_wish(*facts.gauges) : PanelWish{});
  const float aspect = facts.inset ? facts.inset->aspect : 1.0f;
  out.inset = add("inset", facts.inset.has_value(),
                  {.wanted = kInsetWidth_px * aspect + kInsetFrame_px, .least = kLeastInset_px});
  out.map = add("map", shown.trails != nullptr, kMapWish);
  out.graphs = add("graphs", shown.numbers != nullptr,
                   shown.graphs ? graphs_wish(*shown.graphs) : PanelWish{});
  return out;
}

void draw_on_demand(const PanelFacts& facts, const PanelsShown& shown, const Demand& demand,
                    const std::vector<PanelRect>& places, TimeNs now_ns, float scale) {
  const auto place = [&](std::optional<std::size_t> at) { return at ? places[*at] : PanelRect{}; };
  if (const PanelRect at = place(demand.times); !at.empty()) draw_times(shown, at, now_ns, scale);
  if (const PanelRect at = place(demand.gauges); !at.empty())
    draw_gauges(*facts.gauges, at, facts.units, scale);
  if (const PanelRect at = place(demand.inset); !at.empty()) draw_inset(*facts.inset, at, scale);
  if (const PanelRect at = place(demand.map); !at.empty())
    draw_map(facts.marks, facts.eye, *shown.trails, at, facts.units, scale);
  if (const PanelRect at = place(demand.graphs); !at.empty())
    draw_graphs(*shown.numbers, *shown.graphs, at, facts.units, scale);
}

}  // namespace

std::string hint_words(const std::string& hint, const std::vector<std::string>& wished,
                       const PanelLayout& layout, std::size_t sonars,
                       const std::string& next_sonar) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < wished.size(); ++i)
    if (layout.extras[i].empty()) out.push_back(wished[i]);
  const std::size_t more = sonars - layout.fans.size();
  if (layout.fans.empty() && more > 0) out.push_back(more > 1 ? "sonars" : "sonar");
  std::string words = hint;
  if (!out.empty()) words = fmt::format("no room: {}   {}", fmt::join(out, ", "), hint);
  if (!layout.fans.empty() && more > 0)
    words += fmt::format("   {}{}{} more sonar{}", next_sonar, next_sonar.empty() ? "" : "  ", more,
                         more > 1 ? "s" : "");
  return words;
}

std::string range_words(const sonar::Limits& limits, hud::Units units) {
  const LengthUnit unit = length_unit(units);
  return fmt::format("{:.3g} to {:.3g} {}", limits.range_min_m / unit.m,
                     limits.range_max_m / unit.m, unit.name);
}

std::string readout_words(const Readout& readout, hud::Units units) {
  const double depth_m = readout.depth_m;
  const std::string length = length_text(std::abs(depth_m), readout.decimals, units);
  const std::string depth =
      depth_m >= 0.0 ? fmt::format("depth {}", length) : fmt::format("{} above water", length);
  return fmt::format("{}  {}  heading {}\u00b0", readout.whose, depth,
                     hud::heading_text(readout.heading_rad).view());
}

void draw_panels(const PanelFacts& facts, const PanelsShown& shown, TimeNs now_ns, float scale) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  std::vector<const SonarPanel*> sonars;  // the first one to show leads
  std::vector<float> aspects;
  for (std::size_t i = 0; i < facts.sonars.size(); ++i) {
    sonars.push_back(&facts.sonars[(shown.first_sonar + i) % facts.sonars.size()]);
    aspects.push_back(static_cast<float>(sonars.back()->shape.height) /
                      static_cast<float>(sonars.back()->shape.width));
  }
  const Demand demand = demand_of(facts, shown, scale);
  std::vector<PanelRect> taken;
  for (const PanelRect& r : shown.taken)
    taken.push_back({r.x / scale, r.y / scale, r.width / scale, r.height / scale});
  const PanelLayout layout =
      lay_out(display.x / scale, display.y / scale,
              height_of_lines(status_lines(facts, scale), scale), aspects, demand.wishes, taken);
  if (!layout.readout.empty()) draw_readout(facts, layout.readout, scale);
  if (!layout.status.empty()) draw_status(facts, shown, layout.status, scale);
  for (std::size_t i = 0; i < layout.fans.size(); ++i)
    draw_sonar(*sonars[i], layout.fans[i], facts.sonar_gain_db, facts.units, scale);
  draw_on_demand(facts, shown, demand, layout.extras, now_ns, scale);
  if (!layout.hint.empty())
    draw_hint(hint_words(shown.hint, demand.names, layout, sonars.size(), shown.next_sonar), scale,
              layout.hint);
}

void draw_recording_light(const std::string& text, float scale) {
  ImGui::SetNextWindowPos(ImVec2(kEdge_px * scale, kEdge_px * scale));
  ImGui::Begin("###light", nullptr,
               kFixedPanel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoInputs);
  recording_line(text);
  ImGui::End();
}

void draw_hint(const std::string& text, float scale) {
  draw_hint(text, scale, {kEdge_px, ImGui::GetIO().DisplaySize.y / scale - 42.0f, 0.0f, 30.0f});
}

void draw_task(const std::string& text, float scale) {
  constexpr float kLetters = 1.4f;
  draw_hint(text, scale, {kEdge_px, ImGui::GetIO().DisplaySize.y / scale - 42.0f, 0.0f, 30.0f},
            kLetters);
}

}  // namespace neritic::testbed
