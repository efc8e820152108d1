#include "testbed/view/panel_layout.hpp"

#include <algorithm>

namespace neritic::testbed {
namespace {

constexpr float kEdge = 12.0f, kGap = 8.0f;
constexpr float kStatusWidth = 320.0f, kLeastStatusHeight = 70.0f;
constexpr float kReadoutWidth = 340.0f, kReadoutHeight = 62.0f, kHintHeight = 30.0f;
constexpr float kWidestFan = 380.0f, kNarrowestFan = 190.0f, kFanStep = 10.0f;
constexpr float kLeastPicture = 0.5f;  // of the width: what fans beside a wide picture leave
constexpr float kOneColumn = 1024.0f;  // a narrower window has one, and the compass below

struct Room {
  float right, top, width, height;
};

// The first fans in columns from the right, each of that width; fewer where they do not fit.
std::vector<PanelRect> in_columns(const Room& room, float width, std::span<const float> aspects) {
  std::vector<PanelRect> out;
  float x = room.right - width, y = room.top;
  for (const float aspect : aspects) {
    const float height = fan_panel_height(width, aspect);
    if (height > room.height) return out;
    if (y + height > room.top + room.height) {
      x -= width + kGap;
      y = room.top;
    }
    if (x < room.right - room.width) return out;
    out.push_back({x, y, width, height});
    y += height + kGap;
  }
  return out;
}

// As many as fit, and those as wide as they can be.
std::vector<PanelRect> fans_in(const Room& room, std::span<const float> aspects) {
  std::vector<PanelRect> best;
  for (float width = kWidestFan; width >= kNarrowestFan; width -= kFanStep) {
    auto fans = in_columns(room, std::min(width, room.width), aspects);
    if (fans.size() > best.size()) best = std::move(fans);
  }
  return best;
}

// A column that panels fill from one end.
struct Column {
  float x, width, top, bottom;

  float room() const { return bottom - top; }
  PanelRect take_top(float height) {
    const PanelRect out{x, top, width, height};
    top += height + kGap;
    return out;
  }
  PanelRect take_bottom(float height) {
    const PanelRect out{x, bottom - height, width, height};
    bottom -= height + kGap;
    return out;
  }
};

// Each wish below the status, else from the right column's lower end. One that fits at its least
// height leaves the others what remains.
std::vector<PanelRect> extras_in(Column& left, Column& right, std::span<const PanelWish> wishes) {
  std::vector<PanelRect> out;
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    const PanelWish& wish = wishes[i];
    if (left.width > 0.0f && left.room() >= wish.wanted)
      out.push_back(left.take_top(wish.wanted));
    else if (right.width > 0.0f && right.room() >= wish.wanted)
      out.push_back(right.take_bottom(wish.wanted));
    else if (left.width > 0.0f && left.room() >= wish.least)
      out.push_back(left.take_top(left.room()));
    else if (right.width > 0.0f && right.room() >= wish.least)
      out.push_back(right.take_bottom(right.room()));
    else
      out.push_back({});
  }
  return out;
}

}  // namespace

bool overlap(const PanelRect& a, const PanelRect& b) {
  return !a.empty() && !b.empty() && a.x < b.right() && b.x < a.right() && a.y < b.bottom() &&
         b.y < a.bottom();
}

float fan_panel_height(float width, float aspect, const FanFrame& frame) {
  const float fan = std::min((width - 2.0f * frame.margin_x) * aspect, width);
  return frame.above_and_below + fan;
}

PanelLayout lay_out(float width, float height, float status_height,
                    std::span<const float> fan_aspects, std::span<const PanelWish> wishes,
                    const TakenCorner& taken) {
  PanelLayout out;
  const bool narrow = width < kOneColumn;
  const float inner = width - 2.0f * kEdge;
  const float readout_width = std::min(kReadoutWidth, inner);
  float floor = height - kEdge;  // of the side columns
  if (height > kReadoutHeight + 2.0f * kEdge && inner > 0.0f)
    out.readout = {0.5f * (width - readout_width), narrow ? floor - kReadoutHeight : kEdge,
                   readout_width, kReadoutHeight};
  if (out.readout.bottom() > taken.top) {  // beside the instrument
    out.readout.x = kEdge;
    out.readout.width = std::min(readout_width, inner - taken.width - kGap);
  }
  if (narrow) floor = std::min(floor, out.readout.y - kGap);
  const float above = narrow ? kEdge : out.readout.bottom() + kGap;
  if (floor - kHintHeight > above && inner > 0.0f)
    out.hint = {kEdge, floor - kHintHeight, narrow ? inner : 0.5f * inner, kHintHeight};
  if (out.hint.bottom() > taken.top)
    out.hint.width = std::min(out.hint.width, inner - taken.width - kGap);
  const float left_floor = out.hint.empty() ? floor : out.hint.y - kGap;
  const float status_width = std::min(kStatusWidth, inner);
  if (left_floor - kEdge >= kLeastStatusHeight && status_width > 0.0f)
    out.status = {kEdge, kEdge, status_width, std::min(status_height, left_floor - kEdge)};
  const float beside = narrow ? out.status.right() : out.readout.right();
  const float fan_floor = std::min(narrow ? left_floor : floor, taken.top - kGap);
  const float most = narrow ? width : (1.0f - kLeastPicture) * width;
  Room room{width - kEdge, kEdge,
            std::min(most, width - kEdge - kGap - std::max(beside, out.status.right())),
            fan_floor - kEdge};
  const float right_width = std::min(kStatusWidth, room.width);
  Column left{kEdge, out.status.width, out.status.bottom() + kGap, left_floor};
  Column right{room.right - right_width, right_width < kNarrowestFan ? 0.0f : right_width, kEdge,
               fan_floor};
  out.extras = extras_in(left, right, wishes);
  room.height = right.bottom - kEdge;
  if (room.width >= kNarrowestFan) out.fans = fans_in(room, fan_aspects);
  return out;
}

}  // namespace neritic::testbed
