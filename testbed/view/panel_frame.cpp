#include "testbed/view/panel_frame.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {

void begin_panel(const std::string& title, const PanelRect& rect, float scale, int flags) {
  ImGui::SetNextWindowPos(ImVec2(rect.x * scale, rect.y * scale));
  ImGui::SetNextWindowSize(ImVec2(rect.width * scale, rect.height * scale));
  ImGui::Begin(title.c_str(), nullptr, kFixedPanel | flags);
}

float height_of_lines(std::size_t lines, float scale) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float text = static_cast<float>(lines) * ImGui::GetTextLineHeightWithSpacing();
  return (ImGui::GetFrameHeight() + 2.0f * style.WindowPadding.y + text) / scale;
}

std::string metres_text(double m, int decimals) {
  const double steps = std::pow(10.0, decimals);
  return fmt::format("{:.{}f} m", std::round(steps * m) / steps + 0.0, decimals);
}

std::string length_text(double m, int decimals, hud::Units units) {
  if (units == hud::Units::kMetric) return metres_text(m, decimals);
  std::string text = metres_text(m / hud::kFoot_m, std::max(0, decimals - 1));
  text.replace(text.size() - 1, 1, "ft");
  return text;
}

std::string speed_text(double m_s, hud::Units units) {
  return units == hud::Units::kMetric ? fmt::format("{:.2f} m/s", m_s)
                                      : fmt::format("{:.1f} ft/s", m_s / hud::kFoot_m);
}

std::string force_text(double n, hud::Units units) {
  return units == hud::Units::kMetric ? fmt::format("{:.0f} N", n)
                                      : fmt::format("{:.0f} lbf", n / hud::kPoundForce_n);
}

std::string flow_text(double l_min, hud::Units units) {
  return units == hud::Units::kMetric ? fmt::format("{:.0f} l/min", l_min)
                                      : fmt::format("{:.2f} cu ft/min", l_min / hud::kCubicFoot_l);
}

LengthUnit length_unit(hud::Units units) {
  return units == hud::Units::kMetric ? LengthUnit{} : LengthUnit{hud::kFoot_m, "ft"};
}

void text_line(const std::string& text) {
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
}

void centered_text(ImDrawList& list, float x, float y, ImU32 color, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddText(ImVec2(std::floor(x - size.x * 0.5f), std::floor(y)), color, text.c_str());
}

}  // namespace neritic::testbed
