#include "tools/common/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace neritic::tools {

Box inside(const Box& box) {
  return {box.left + 72, box.top + 34, box.right - 18, box.bottom - 52};
}

double place(const Axis& axis, double value, double from, double to) {
  const double t = axis.log ? std::log(value / axis.min) / std::log(axis.max / axis.min)
                            : (value - axis.min) / (axis.max - axis.min);
  return from + t * (to - from);
}

std::vector<double> ticks(const Axis& axis) {
  std::vector<double> out;
  if (axis.log) {
    for (int e = static_cast<int>(std::floor(std::log10(axis.min))); std::pow(10.0, e) <= axis.max;
         ++e)
      for (const double m : {1.0, 2.0, 5.0}) {
        const double v = m * std::pow(10.0, e);
        if (v >= axis.min * 0.999 && v <= axis.max * 1.001) out.push_back(v);
      }
    return out.size() >= 3 ? out : ticks({axis.label, axis.min, axis.max});
  }
  if (axis.max < axis.min) return ticks({axis.label, axis.max, axis.min});
  const double raw = (axis.max - axis.min) / 6.0,
               power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double m : {5.0, 2.0, 1.0})
    if (m * power >= raw * 0.999) step = m * power;
  for (double v = std::ceil(axis.min / step - 1e-9) * step; v <= axis.max + 1e-9 * step; v += step)
    out.push_back(std::abs(v) < 1e-9 * step ? 0.0 : v);
  return out;
}

namespace {

using draw2d::Align;
using draw2d::Canvas;
using draw2d::Color;

constexpr double kTextPx = 10.0, kTitlePx = 13.0;

void draw_axes(Canvas& canvas, const Box& box, const std::string& title, const Axis& x,
               const Axis& y, bool x_ticks) {
  const Box in = inside(box);
  const Color grid = kInk.with_alpha(0.10f), line = kInk.with_alpha(0.7f);
  canvas.text(in.left, box.top + 20, kTitlePx, title, kInk, Align::kLeft, draw2d::Face::kBold);
  for (const double v : ticks(y)) {
    const double py = place(y, v, in.bottom, in.top);
    canvas.segment(in.left, py, in.right, py, 1.0, grid);
    canvas.text(in.left - 8, py + 4, kTextPx, fmt::format("{:g}", v), kInk, Align::kRight);
  }
  if (x_ticks)
    for (const double v : ticks(x)) {
      const double px = place(x, v, in.left, in.right);
      canvas.segment(px, in.top, px, in.bottom, 1.0, grid);
      canvas.text(px, in.bottom + 18, kTextPx, fmt::format("{:g}", v), kInk, Align::kCenter);
    }
  canvas.segment(in.left, in.bottom, in.right, in.bottom, 1.4, line);
  canvas.segment(in.left, in.top, in.left, in.bottom, 1.4, line);
  canvas.text((in.left + in.right) / 2, in.bottom + 40, kTextPx, x.label, kInk, Align::kCenter);
  canvas.text(in.left + 8, in.top + 2, kTextPx, y.label, kInk.with_alpha(0.8f));
}

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

// Notes beside their points: each at the first of four corners where it hides no other; left out
// where all four are taken.
void draw_notes(Canvas& canvas, const Box& in, const Series& s, const Axis& x, const Axis& y,
                std::vector<Box>& taken) {
  constexpr double kNotePx = 8.0, kOff = 6.0;
  for (std::size_t i = 0; i < std::min(s.notes.size(), s.x.size()); ++i) {
    const double px = place(x, s.x[i], in.left, in.right), py = place(y, s.y[i], in.bottom, in.top);
    const double width = draw2d::Font().width(kNotePx, s.notes[i]);
    for (const auto& [right, above] :
         {std::pair{true, true}, {true, false}, {false, true}, {false, false}}) {
      const double left = right ? px + kOff : px - kOff - width;
      const double bottom = above ? py - kOff : py + kOff + kNotePx;
      const Box box{left - 1.0, bottom - kNotePx - 1.0, left + width + 1.0, bottom + 1.0};
      if (std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return overlap(b, box); }))
        continue;
      canvas.text(left, bottom, kNotePx, s.notes[i], kInk.with_alpha(0.7f));
      taken.push_back(box);
      break;
    }
  }
}

constexpr double kLegendLine_px = 18.0;

// Over the lines, so that none runs through a name where no place is free.
void draw_legend(Canvas& canvas, const Box& box, const std::vector<Series>& series) {
  canvas.fill_rectangle(box.left, box.top, box.right, box.bottom, kPaper.with_alpha(0.8f));
  double y = box.top + 0.5 * kLegendLine_px;
  for (const Series& s : series) {
    if (s.name.empty()) continue;
    const double width = draw2d::Font().width(kTextPx, s.name);
    canvas.text(box.right - 4 - width, y + 4, kTextPx, s.name, kInk);
    const double mark = box.right - (s.joined ? 38.0 : 26.0) - width;
    canvas.segment(mark, y, s.joined ? box.right - 14 - width : mark, y, s.joined ? 2.4 : 4.0,
                   s.color);
    y += kLegendLine_px;
  }
}

struct PlotPoint {
  double x = 0.0, y = 0.0;  // pixels
};

// Whether a straight line from a to b runs through a box: what is left of it after each edge has
// cut off its own side (Liang and Barsky 1984).
bool runs_through(const Box& box, const PlotPoint& a, const PlotPoint& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  double from = 0.0, to = 1.0;
  for (const auto& [along, room] : {std::pair{-dx, a.x - box.left},
                                    {dx, box.right - a.x},
                                    {-dy, a.y - box.top},
                                    {dy, box.bottom - a.y}}) {
    if (along == 0.0 && room < 0.0) return false;
    if (along < 0.0) from = std::max(from, room / along);
    if (along > 0.0) to = std::min(to, room / along);
  }
  return from <= to;
}

// How many pieces of the lines lie under a box.
std::size_t pieces_under(const Box& box, const Box& in, const Axis& x, const Axis& y,
                         const std::vector<Series>& series) {
  std::size_t pieces = 0;
  for (const Series& s : series) {
    PlotPoint before;
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      const PlotPoint at{place(x, s.x[i], in.left, in.right), place(y, s.y[i], in.bottom, in.top)};
      if (!s.joined || s.x.size() == 1) pieces += runs_through(box, at, at);
      if (s.joined && i > 0) pieces += runs_through(box, before, at);
      before = at;
    }
  }
  return pieces;
}

}  // namespace

Box legend_box(const Box& box, const Axis& x, const Axis& y, const std::vector<Series>& series,
               bool below) {
  constexpr double kMargin_px = 6.0;
  const Box in = inside(box);
  double wide = 42.0, high = 0.0;
  for (const Series& s : series) {
    if (s.name.empty()) continue;
    wide = std::max(wide, 42.0 + draw2d::Font().width(kTextPx, s.name));
    high += kLegendLine_px;
  }
  const double highest = in.top + kTextPx;  // under the axis's own words
  const double room = std::max(in.bottom - highest - high, 0.0);
  Box best;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const double across : {1.0, 0.0, 0.5})
    for (int step = 0; step <= 10 && least > 0; ++step) {
      const double left = in.left + kMargin_px + across * (in.right - in.left - wide - kMargin_px);
      const double top = highest + 0.1 * (below ? 10 - step : step) * room;
      const Box at{left, top, left + wide, top + high};
      const Box clear{at.left - kMargin_px, at.top - kMargin_px, at.right + kMargin_px,
                      at.bottom + kMargin_px};
      const std::size_t pieces = pieces_under(clear, in, x, y, series);
      if (pieces < least) least = pieces, best = at;
    }
  return best;
}

Axis axis_for(const std::string& label, const std::vector<double>& values, bool log) {
  Axis axis{label, 0.0, 1.0, log};
  if (values.empty()) return log ? Axis{label, 0.1, 1.0, true} : axis;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (log) {
    axis.min = std::max(*low, 1e-9) / 1.25;
    axis.max = std::max(*high, 1e-9) * 1.5;
  } else {
    axis.min = std::min(0.0, *low * 1.1);
    axis.max = std::max(*high * 1.15, axis.min + 1e-9);
  }
  return axis;
}

void draw_lines(Canvas& canvas, const Box& box, const std::string& title, const Axis& x,
                const Axis& y, const std::vector<Series>& series, bool legend_below) {
  draw_axes(canvas, box, title, x, y, true);
  const Box in = inside(box);
  std::vector<Box> taken;
  for (const Series& s : series) {
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      const double px = place(x, s.x[i], in.left, in.right),
                   py = place(y, s.y[i], in.bottom, in.top);
      if (i > 0 && s.joined)
        canvas.segment(place(x, s.x[i - 1], in.left, in.right),
                       place(y, s.y[i - 1], in.bottom, in.top), px, py, 1.8,
                       s.color.with_alpha(0.8f));
      if (s.marked) canvas.segment(px, py, px, py, s.joined ? 7.0 : 4.0, s.color);
    }
    draw_notes(canvas, in, s, x, y, taken);
  }
  draw_legend(canvas, legend_box(box, x, y, series, legend_below), series);
}

void draw_mark(Canvas& canvas, const Box& box, const Axis& x, const Axis& y, double at_x,
               double at_y, const std::string& words) {
  const Box in = inside(box);
  const double px = place(x, at_x, in.left, in.right), py = place(y, at_y, in.bottom, in.top);
  canvas.arc(px, py, 10.0, -3.1416, 3.1416, 2.0, {0.75f, 0.1f, 0.1f});
  canvas.segment(px + 7, py - 7, px + 26, py - 34, 1.2, {0.75f, 0.1f, 0.1f});
  // On paper of its own: lines and notes crowd where a curve bends.
  canvas.fill_rectangle(px + 24, py - 36 - kTextPx - 3,
                        px + 32 + draw2d::Font().width(kTextPx, words), py - 32, kPaper);
  canvas.text(px + 28, py - 36, kTextPx, words, {0.75f, 0.1f, 0.1f});
}

void draw_bars(Canvas& canvas, const Box& box, const std::string& title, const std::string& label,
               const std::vector<Bar>& bars) {
  std::vector<double> values;
  for (const Bar& bar : bars) values.push_back(bar.value);
  const Axis y = axis_for(label, values, false);
  draw_axes(canvas, box, title, {"", 0, 1, false}, y, false);
  const Box in = inside(box);
  const double slot =
      (in.right - in.left) / static_cast<double>(std::max<std::size_t>(bars.size(), 1));
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double left = in.left + (static_cast<double>(i) + 0.2) * slot;
    const double top = place(y, bars[i].value, in.bottom, in.top);
    canvas.fill_rectangle(left, top, left + 0.6 * slot, in.bottom, bars[i].color);
    canvas.text(left + 0.3 * slot, top - 6, 9.0, fmt::format("{:.3g}", bars[i].value), kInk,
                Align::kCenter);
    canvas.text(left + 0.3 * slot, in.bottom + 18, 9.0, bars[i].name, kInk, Align::kCenter);
  }
}

}  // namespace neritic::tools
