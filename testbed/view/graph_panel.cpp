#include "testbed/view/graph_panel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "testbed/view/panel_frame.hpp"

namespace neritic::testbed {
namespace {

constexpr float kGraph_px = 74.0f, kLeastGraph_px = 44.0f, kAround_px = 76.0f;

const RunNumber* number_named(const RunNumbers& numbers, const std::string& name) {
  const auto found = std::ranges::find(numbers.all(), name, &RunNumber::name);
  return found == numbers.all().end() ? nullptr : &*found;
}

struct Span {
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  bool empty() const { return low > high; }
};

Span span_of(const RunNumbers& numbers, const RunNumber& number) {
  Span out;
  for (std::size_t i = 0; i < numbers.count(); ++i) {
    const float value = numbers.at(number, i);
    if (!std::isfinite(value)) continue;
    out.low = std::min(out.low, value);
    out.high = std::max(out.high, value);
  }
  return out;
}

// The curve in its box, the newest at the right edge; a constant lies in the middle.
void draw_curve(ImDrawList& list, const RunNumbers& numbers, const RunNumber& number, ImVec2 from,
                ImVec2 size, float scale) {
  list.AddRectFilled(from, ImVec2(from.x + size.x, from.y + size.y), kPaper, 3.0f * scale);
  const Span span = span_of(numbers, number);
  if (span.empty()) return;
  const float room = std::max(span.high - span.low, 1e-6f * std::max(1.0f, std::abs(span.high)));
  const auto at = [&](std::size_t i, float value) {
    float up = span.high > span.low ? (value - span.low) / room : 0.5f;
    if (number.down) up = 1.0f - up;
    const auto age = static_cast<float>(numbers.age_s(i) / kNumbersShown_s);
    return ImVec2(from.x + size.x * (1.0f - age), from.y + size.y * (0.94f - 0.88f * up));
  };
  for (std::size_t i = 0; i <= numbers.count(); ++i) {
    const float value =
        i < numbers.count() ? numbers.at(number, i) : std::numeric_limits<float>::quiet_NaN();
    if (std::isfinite(value))
      list.PathLineTo(at(i, value));
    else
      list.PathStroke(kMark, ImDrawFlags_None, 1.5f * scale);
  }
}

// The list of what is not shown yet.
void choose(const RunNumbers& numbers, GraphChoice& choice) {
  if (choice.names.size() >= kMostGraphs) return;
  ImGui::SetNextItemWidth(-1.0f);
  if (!ImGui::BeginCombo("##add", "add a number", ImGuiComboFlags_HeightLarge)) return;
  for (const RunNumber& number : numbers.all()) {
    if (std::ranges::find(choice.names, number.name) != choice.names.end()) continue;
    if (ImGui::Selectable(number.name.c_str())) choice.names.push_back(number.name);
  }
  ImGui::EndCombo();
}

}  // namespace

std::string caption(const RunNumber& number, double low, double high, hud::Units units) {
  const NumberUnit& unit = number.unit;
  const std::string newest =
      std::isfinite(number.newest)
          ? fmt::format("{:.4g} {}", unit.shown(number.newest, units), unit.name(units))
          : "not known";
  return low > high ? fmt::format("{}   {}", number.name, newest)
                    : fmt::format("{}   {}   ({:.3g} to {:.3g})", number.name, newest,
                                  unit.shown(low, units), unit.shown(high, units));
}

PanelWish graphs_wish(const GraphChoice& choice) {
  const auto count = static_cast<float>(std::max<std::size_t>(1, choice.names.size()));
  return {.wanted = kAround_px + count * kGraph_px, .least = kAround_px + kLeastGraph_px};
}

void draw_graphs(const RunNumbers& numbers, GraphChoice& choice, const PanelRect& rect,
                 hud::Units units, float scale) {
  begin_panel("Last 2 minutes###graphs", rect, scale);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const float below = choice.names.size() < kMostGraphs ? ImGui::GetFrameHeightWithSpacing() : 0.0f;
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const auto count = static_cast<float>(std::max<std::size_t>(1, choice.names.size()));
  const float each = std::max(8.0f * scale, (room.y - below) / count - line);
  std::string removed;
  for (const std::string& name : choice.names) {
    const RunNumber* const number = number_named(numbers, name);
    if (!number) continue;
    ImGui::PushID(name.c_str());
    if (ImGui::SmallButton("x")) removed = name;
    ImGui::SameLine();
    const Span span = span_of(numbers, *number);
    text_line(caption(*number, span.low, span.high, units));
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const ImVec2 size(room.x, each - ImGui::GetStyle().ItemSpacing.y);
    draw_curve(list, numbers, *number, from, size, scale);
    ImGui::Dummy(size);
    ImGui::PopID();
  }
  choose(numbers, choice);
  std::erase(choice.names, removed);
  ImGui::End();
}

}  // namespace neritic::testbed
