#include "testbed/view/map_panel.hpp"

#include <algorithm>
#include <cmath>

#include "engine/draw2d/axes.hpp"
#include "testbed/view/panel_frame.hpp"

namespace neritic::testbed {
namespace {

constexpr double kLeastSide_m = 20.0, kMargin = 1.25;

Vec2 east_north(const Vec3& position_m) {
  return {position_m.x, -position_m.z};
}

bool on_a_map(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.z) && std::abs(p.x) < 1e7 && std::abs(p.z) < 1e7;
}

// A dart that points along its course.
void draw_dart(ImDrawList& list, ImVec2 at, double course_rad, float size, ImU32 color) {
  const auto corner = [&](double angle, float far) {
    return ImVec2(at.x + far * static_cast<float>(std::sin(course_rad + angle)),
                  at.y - far * static_cast<float>(std::cos(course_rad + angle)));
  };
  list.AddTriangleFilled(corner(0.0, 1.3f * size), corner(2.5, size), corner(-2.5, size), color);
}

}  // namespace

void MapTrails::add(const std::vector<MapMark>& marks, double time_s) {
  if (time_s < time_s_) trails_.clear();  // the run went back
  time_s_ = time_s;
  for (const MapMark& mark : marks) {
    if (!on_a_map(mark.position_m)) continue;
    Trail& trail = trails_[mark.name];
    const Vec2 at = east_north(mark.position_m);
    if (!trail.points.empty() && glm::distance(trail.points.back(), at) < trail.least_m) continue;
    trail.points.push_back(at);
    if (trail.points.size() <= kMostPoints) continue;
    for (std::size_t i = 1; 2 * i < trail.points.size(); ++i) trail.points[i] = trail.points[2 * i];
    trail.points.resize((trail.points.size() + 1) / 2);
    trail.least_m *= 2.0;
  }
}

const std::vector<Vec2>& MapTrails::of(const std::string& name) const {
  static const std::vector<Vec2> kNone;
  const auto found = trails_.find(name);
  return found == trails_.end() ? kNone : found->second.points;
}

MapFrame map_frame(const std::vector<MapMark>& marks, const MapTrails& trails) {
  Vec2 low(1e300), high(-1e300);
  const auto add = [&](const Vec2& p) { low = glm::min(low, p), high = glm::max(high, p); };
  for (const MapMark& mark : marks) {
    if (on_a_map(mark.position_m)) add(east_north(mark.position_m));
    for (const Vec2& p : trails.of(mark.name)) add(p);
  }
  if (!(low.x <= high.x)) return {};
  return {0.5 * (low + high),
          std::max(kLeastSide_m, kMargin * std::max(high.x - low.x, high.y - low.y))};
}

PanelRect label_place(const Vec2& at, float off, const Vec2& size, const PanelRect& room,
                      const std::vector<PanelRect>& taken) {
  constexpr int kLines = 5;  // as far up and down as it is still seen whose label it is
  const auto x = static_cast<float>(at.x), y = static_cast<float>(at.y);
  const auto width = static_cast<float>(size.x), height = static_cast<float>(size.y);
  for (int line = 0; line < kLines; ++line)
    for (const float top :
         {y - static_cast<float>(line + 1) * height, y + static_cast<float>(line) * height})
      for (const float left : {x + off, x - off - width}) {
        const PanelRect rect{left, top, width, height};
        const bool inside = rect.x >= room.x && rect.y >= room.y && rect.right() <= room.right() &&
                            rect.bottom() <= room.bottom();
        if (inside &&
            std::ranges::none_of(taken, [&](const PanelRect& t) { return overlap(rect, t); }))
          return rect;
      }
  return {};
}

std::string grid_words(double step_m, hud::Units units) {
  const LengthUnit unit = length_unit(units);
  return fmt::format("grid {:g} {}", step_m / unit.m, unit.name);
}

void draw_map(const std::vector<MapMark>& marks, const MapMark& eye, const MapTrails& trails,
              const PanelRect& rect, hud::Units units, float scale) {
  begin_panel("Map, north up###map", rect, scale, ImGuiWindowFlags_NoScrollbar);
  const MapFrame frame = map_frame(marks, trails);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 from = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const ImVec2 to(from.x + room.x, from.y + room.y);
  list.AddRectFilled(from, to, kPaper, 3.0f * scale);
  list.PushClipRect(from, to, true);
  const double px_per_m = std::min(room.x, room.y) / frame.side_m;
  const auto place = [&](const Vec2& p) {
    return ImVec2(from.x + 0.5f * room.x + static_cast<float>((p.x - frame.middle.x) * px_per_m),
                  from.y + 0.5f * room.y - static_cast<float>((p.y - frame.middle.y) * px_per_m));
  };
  const double unit_m = length_unit(units).m;
  const double step = unit_m * draw2d::nice_step(frame.side_m / unit_m, 4.0);
  const auto lines = [&](double middle, double half, auto draw) {
    for (double at = step * std::ceil((middle - half) / step); at <= middle + half; at += step)
      draw(at);
  };
  lines(frame.middle.x, 0.5 * room.x / px_per_m, [&](double east) {
    const float x = place({east, 0.0}).x;
    list.AddLine(ImVec2(x, from.y), ImVec2(x, to.y), kLine);
  });
  lines(frame.middle.y, 0.5 * room.y / px_per_m, [&](double north) {
    const float y = place({0.0, north}).y;
    list.AddLine(ImVec2(from.x, y), ImVec2(to.x, y), kLine);
  });
  const std::string grid = grid_words(step, units);
  const ImVec2 grid_size = ImGui::CalcTextSize(grid.c_str());
  std::vector<PanelRect> labels{
      {from.x + 4.0f * scale, to.y - grid_size.y - 2.0f * scale, grid_size.x, grid_size.y}};
  // No label lies on a dart, which a label's own is beside.
  const auto keep_free = [&](const MapMark& mark, float half) {
    if (!on_a_map(mark.position_m)) return;
    const ImVec2 at = place(east_north(mark.position_m));
    labels.push_back({at.x - half, at.y - half, 2.0f * half, 2.0f * half});
  };
  for (const MapMark& mark : marks) keep_free(mark, 7.8f * scale);
  draw_dart(list, place(east_north(eye.position_m)), eye.course_rad, 5.0f * scale, kFaint);
  for (const MapMark& mark : marks) {
    for (const Vec2& p : trails.of(mark.name)) list.PathLineTo(place(p));
    list.PathStroke(kRim, ImDrawFlags_None, 1.5f * scale);
    if (!on_a_map(mark.position_m)) continue;
    const ImVec2 at = place(east_north(mark.position_m));
    draw_dart(list, at, mark.course_rad, 6.0f * scale, kMark);
    const ImVec2 size = ImGui::CalcTextSize(mark.name.c_str());
    const PanelRect label = label_place({at.x, at.y}, 8.0f * scale, {size.x, size.y},
                                        {from.x, from.y, room.x, room.y}, labels);
    if (label.empty()) continue;
    labels.push_back(label);
    list.AddText(ImVec2(label.x, label.y), kInk, mark.name.c_str());
  }
  list.AddText(ImVec2(labels[0].x, labels[0].y), kFaint, grid.c_str());
  list.PopClipRect();
  ImGui::End();
}

}  // namespace neritic::testbed
