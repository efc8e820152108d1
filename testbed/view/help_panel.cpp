#include "testbed/view/help_panel.hpp"

#include <algorithm>

#include "testbed/view/key_words.hpp"
#include "testbed/view/panel_frame.hpp"

namespace neritic::testbed {
namespace {

constexpr float kColumnGap_px = 24.0f, kKeyGap_px = 14.0f;

// The height of rows in the current font.
struct Fit {
  float keys = 0.0f, column = 0.0f;  // widths, pixels
  std::size_t columns = 1, rows = 1;
  std::size_t a_page() const { return columns * rows; }
};

Fit fit(const std::vector<HelpRow>& rows, float scale) {
  Fit out;
  float help = 0.0f;
  for (const HelpRow& row : rows) {
    out.keys = std::max(out.keys, ImGui::CalcTextSize(row.controls.c_str()).x);
    help = std::max(help, ImGui::CalcTextSize(row.help.c_str()).x);
  }
  out.keys += kKeyGap_px * scale;
  out.column = out.keys + help;
  const ImVec2 display = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const float width = display.x - kEdge_px * scale - 2.0f * padding.x;
  const float height = display.y - kEdge_px * scale - 2.0f * padding.y - ImGui::GetFrameHeight();
  const auto whole = [](float room, float each) {
    return static_cast<std::size_t>(std::max(1.0f, room / each));
  };
  out.rows = whole(height, ImGui::GetTextLineHeightWithSpacing());
  out.columns = whole(width + kColumnGap_px * scale, out.column + kColumnGap_px * scale);
  out.columns = std::min(out.columns, (rows.size() + out.rows - 1) / out.rows);
  out.rows = std::min(out.rows, (rows.size() + out.columns - 1) / out.columns);
  return out;
}

// Where one column is wider than the window: each action's controls with its help below, both
// wrapped; the first rows of each page, and the number of all.
std::vector<std::size_t> stacked_pages(const std::vector<HelpRow>& rows, const ImVec2& room) {
  std::vector<std::size_t> first{0};
  float used = 0.0f;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    float height = 0.0f;
    for (const std::string* text : {&rows[i].controls, &rows[i].help})
      height += ImGui::CalcTextSize(text->c_str(), nullptr, false, room.x).y +
                ImGui::GetStyle().ItemSpacing.y;
    if (used > 0.0f && used + height > room.y) {
      first.push_back(i);
      used = 0.0f;
    }
    used += height;
  }
  first.push_back(rows.size());
  return first;
}

std::size_t draw_stacked(const std::vector<HelpRow>& rows, std::size_t page, float scale) {
  const ImVec2 display = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const float edge = kEdge_px * scale;
  const ImVec2 size(display.x - edge, display.y - edge);
  const ImVec2 room(size.x - 2.0f * padding.x, size.y - 2.0f * padding.y - ImGui::GetFrameHeight());
  const std::vector<std::size_t> first = stacked_pages(rows, room);
  const std::size_t pages = first.size() - 1, shown = std::min(page, pages - 1);
  ImGui::SetNextWindowPos(ImVec2(0.5f * edge, 0.5f * edge));
  ImGui::SetNextWindowSize(size);
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::Begin(fmt::format("Keys {}/{}###keys", shown + 1, pages).c_str(), nullptr,
               kFixedPanel | ImGuiWindowFlags_NoScrollbar);
  ImGui::PushTextWrapPos(0.0f);
  for (std::size_t i = first[shown]; i < first[shown + 1]; ++i) {
    ImGui::TextUnformatted(rows[i].controls.c_str());
    ImGui::TextDisabled("%s", rows[i].help.c_str());
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
  return pages;
}

}  // namespace

std::vector<HelpRow> help_rows(std::span<const xr::ActionDesc> actions) {
  std::vector<HelpRow> rows;
  for (const xr::ActionDesc& action : actions)
    if (std::string controls = control_words(action); !action.help.empty() && !controls.empty())
      rows.push_back({std::move(controls), action.help});
  return rows;
}

std::size_t draw_help(std::span<const xr::ActionDesc> actions, std::size_t page, float scale) {
  const std::vector<HelpRow> rows = help_rows(actions);
  const Fit fits = fit(rows, scale);
  if (fits.column >
      ImGui::GetIO().DisplaySize.x - kEdge_px * scale - 2.0f * ImGui::GetStyle().WindowPadding.x)
    return draw_stacked(rows, page, scale);
  const std::size_t pages = (rows.size() + fits.a_page() - 1) / fits.a_page();
  const std::size_t first = std::min(page, pages - 1) * fits.a_page();
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(display.x * 0.5f, display.y * 0.5f), ImGuiCond_Always,
                          ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowBgAlpha(0.92f);
  const std::string title = pages > 1 ? fmt::format("Keys, page {} of {}   {}###keys", page + 1,
                                                    pages, with_key(actions, "help", "on"))
                                      : "Keys###keys";
  ImGui::Begin(title.c_str(), nullptr, kFixedPanel | ImGuiWindowFlags_AlwaysAutoResize);
  const ImVec2 start = ImGui::GetCursorPos();
  for (std::size_t i = 0; i < fits.a_page() && first + i < rows.size(); ++i) {
    const HelpRow& row = rows[first + i];
    const ImVec2 at(
        start.x + static_cast<float>(i / fits.rows) * (fits.column + kColumnGap_px * scale),
        start.y + static_cast<float>(i % fits.rows) * ImGui::GetTextLineHeightWithSpacing());
    ImGui::SetCursorPos(at);
    text_line(row.controls);
    ImGui::SetCursorPos(ImVec2(at.x + fits.keys, at.y));
    ImGui::TextDisabled("%s", row.help.c_str());
  }
  ImGui::End();
  return pages;
}

}  // namespace neritic::testbed
