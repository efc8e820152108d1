#include "testbed/view/panel_layout.hpp"

#include <algorithm>
#include <functional>
#include <optional>

namespace neritic::testbed {
namespace {

constexpr float kEdge = 12.0f, kGap = 8.0f;
constexpr float kStatusWidth = 320.0f, kLeastStatusHeight = 70.0f;
constexpr float kLeastStatusWidth = 200.0f, kStatusStep = 20.0f;
constexpr float kLeastReadoutWidth = 250.0f, kLeastHintWidth = 130.0f, kGoodHintWidth = 200.0f;
constexpr float kReadoutWidth = 340.0f, kReadoutHeight = 62.0f, kHintHeight = 30.0f;
constexpr float kWidestFan = 380.0f, kNarrowestFan = 190.0f, kFanStep = 10.0f;
constexpr float kLeastPicture = 0.5f;  // of the width: what fans beside a wide picture leave
constexpr float kOneColumn = 1024.0f;  // a narrower window has one, and the compass below

struct Interval {
  float from = 0.0f, to = 0.0f;
  float length() const { return to - from; }
};

// The window while it is filled: what is placed keeps kGap to what comes after it.
class Board {
 public:
  Board(float width, float height, std::span<const PanelRect> taken)
      : width_(width), height_(height) {
    for (const PanelRect& rect : taken) take(rect);
  }
  const PanelRect& take(const PanelRect& rect) {
    if (!rect.empty()) taken_.push_back(rect);
    return rect;
  }
  const std::vector<PanelRect>& taken() const { return taken_; }

  // The free parts of a column, and of a row, from its start on.
  std::vector<Interval> down(float x, float width) const {
    std::vector<Interval> blocks;
    for (const PanelRect& r : taken_)
      if (r.x - kGap < x + width && x < r.right() + kGap)
        blocks.push_back({r.y - kGap, r.bottom() + kGap});
    return between({kEdge, height_ - kEdge}, std::move(blocks));
  }
  std::vector<Interval> across(float y, float height) const {
    std::vector<Interval> blocks;
    for (const PanelRect& r : taken_)
      if (r.y - kGap < y + height && y < r.bottom() + kGap)
        blocks.push_back({r.x - kGap, r.right() + kGap});
    return between({kEdge, width_ - kEdge}, std::move(blocks));
  }

 private:
  static std::vector<Interval> between(Interval all, std::vector<Interval> blocks) {
    std::ranges::sort(blocks, {}, &Interval::from);
    std::vector<Interval> out;
    for (const Interval& block : blocks) {
      if (block.from > all.from) out.push_back({all.from, std::min(block.from, all.to)});
      all.from = std::max(all.from, block.to);
    }
    if (all.to > all.from) out.push_back(all);
    std::erase_if(out, [](const Interval& s) { return !(s.length() > 0.0f); });
    return out;
  }

  float width_, height_;
  std::vector<PanelRect> taken_;
};

// The first that is so long, else the longest; nothing where that is shorter than least.
std::optional<Interval> pick_interval(const std::vector<Interval>& spans, float wanted,
                                      float least) {
  const auto enough =
      std::ranges::find_if(spans, [&](const Interval& s) { return s.length() >= wanted; });
  if (enough != spans.end()) return *enough;
  const auto longest = std::ranges::max_element(spans, {}, &Interval::length);
  if (longest == spans.end() || longest->length() < least) return std::nullopt;
  return *longest;
}

// In the middle where that is free, else where the row has room.
PanelRect readout_on(const Board& board, float width, float height, bool narrow) {
  const float wide = std::min(kReadoutWidth, width - 2.0f * kEdge);
  if (!(height > kReadoutHeight + 2.0f * kEdge) || wide < kLeastReadoutWidth) return {};
  const float y = narrow ? height - kEdge - kReadoutHeight : kEdge;
  const auto spans = board.across(y, kReadoutHeight);
  const float x = 0.5f * (width - wide);
  for (const Interval& span : spans)
    if (span.from <= x && x + wide <= span.to) return {x, y, wide, kReadoutHeight};
  const auto span = pick_interval(spans, wide, kLeastReadoutWidth);
  if (!span) return {};
  return {span->from, y, std::min(wide, span->length()), kReadoutHeight};
}

// Above the window's lower edge, else above what lies there.
PanelRect hint_on(const Board& board, float width, float height, bool narrow) {
  std::vector<float> floors{height - kEdge};
  for (const PanelRect& rect : board.taken()) floors.push_back(rect.y - kGap);
  std::ranges::sort(floors, std::greater<>());
  const float wanted = (narrow ? 1.0f : 0.5f) * (width - 2.0f * kEdge);
  for (const float least : {kGoodHintWidth, kLeastHintWidth})
    for (const float floor : floors) {
      const float y = floor - kHintHeight;
      if (y < kEdge) continue;
      const auto span = pick_interval(board.across(y, kHintHeight), least, least);
      if (span) return {span->from, y, std::min(wanted, span->length()), kHintHeight};
    }
  return {};
}

// At the left edge, else at the right one; narrower where that gives it room for all of its lines.
PanelRect status_on(const Board& board, float width, float wanted) {
  PanelRect best;
  for (float wide = std::min(kStatusWidth, width - 2.0f * kEdge); wide >= kLeastStatusWidth;
       wide -= kStatusStep)
    for (const float x : {kEdge, width - kEdge - wide}) {
      const auto span = pick_interval(board.down(x, wide), wanted, kLeastStatusHeight);
      if (!span) continue;
      const PanelRect rect{x, span->from, wide, std::min(wanted, span->length())};
      if (rect.height >= wanted) return rect;
      if (rect.height > best.height) best = rect;
    }
  return best;
}

// A wish below the status, else from the right column's lower end. One that fits at its least
// height leaves the others what remains.
PanelRect extra_on(const Board& board, const Interval& left, const Interval& right,
                   const PanelWish& wish) {
  const auto at = [](const Interval& column, float y, float height) {
    return PanelRect{column.from, y, column.length(), height};
  };
  const auto in = [&](const Interval& column) {
    return column.length() < kNarrowestFan ? std::vector<Interval>()
                                           : board.down(column.from, column.length());
  };
  const auto lefts = in(left), rights = in(right);
  for (const Interval& s : lefts)
    if (s.length() >= wish.wanted) return at(left, s.from, wish.wanted);
  for (auto s = rights.rbegin(); s != rights.rend(); ++s)
    if (s->length() >= wish.wanted) return at(right, s->to - wish.wanted, wish.wanted);
  if (const auto s = pick_interval(lefts, wish.wanted, wish.least))
    return at(left, s->from, s->length());
  if (const auto s = pick_interval(rights, wish.wanted, wish.least))
    return at(right, s->from, s->length());
  return {};
}

// The first fans in columns from the right, each of that width; fewer where they do not fit.
std::vector<PanelRect> in_columns(const Board& board, const Interval& room, float width,
                                  std::span<const float> aspects) {
  std::vector<PanelRect> out;
  for (float x = room.to - width; x >= room.from - 0.01f; x -= width + kGap)
    for (Interval free : board.down(x, width))
      while (out.size() < aspects.size()) {
        const float height = fan_panel_height(width, aspects[out.size()]);
        if (height > free.length()) break;
        out.push_back({x, free.from, width, height});
        free.from += height + kGap;
      }
  return out;
}

// As many as fit, and those as wide as they can be.
std::vector<PanelRect> fans_in(const Board& board, const Interval& room,
                               std::span<const float> aspects) {
  std::vector<PanelRect> best;
  for (float width = kWidestFan; width >= kNarrowestFan; width -= kFanStep) {
    auto fans = in_columns(board, room, std::min(width, room.length()), aspects);
    if (fans.size() > best.size()) best = std::move(fans);
  }
  return best;
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
                    std::span<const PanelRect> taken) {
  PanelLayout out;
  Board board(width, height, taken);
  const bool narrow = width < kOneColumn;
  out.readout = board.take(readout_on(board, width, height, narrow));
  out.hint = board.take(hint_on(board, width, height, narrow));
  out.status = board.take(status_on(board, width, status_height));
  const Interval left{kEdge, kEdge + std::min(kStatusWidth, width - 2.0f * kEdge)};
  const float most = narrow ? width : (1.0f - kLeastPicture) * width;
  float beside = left.to;
  if (!narrow && !out.readout.empty()) beside = std::max(beside, out.readout.right());
  const float right_edge = width - kEdge;
  const Interval room{std::max(right_edge - most, beside + kGap), right_edge};
  const Interval right{std::max(room.from, right_edge - kStatusWidth), right_edge};
  for (const PanelWish& wish : wishes)
    out.extras.push_back(board.take(extra_on(board, left, right, wish)));
  if (room.length() >= kNarrowestFan) out.fans = fans_in(board, room, fan_aspects);
  return out;
}

}  // namespace neritic::testbed
