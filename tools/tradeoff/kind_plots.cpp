#include "tools/tradeoff/kind_plots.hpp"

#include <algorithm>

#include "tools/common/plot.hpp"

namespace neritic::tools {
namespace {

using draw2d::Align;
using draw2d::Canvas;
using draw2d::Color;

constexpr double kWidth = 1920, kTop = 70, kCurves = 560, kRow = 24;
const Color kRing{0.75f, 0.1f, 0.1f};

std::vector<const KindPoint*> of_sweep(const KindResult& k, const std::string& sweep) {
  std::vector<const KindPoint*> out;
  for (const KindPoint& p : k.points)
    if (p.sweep == sweep) out.push_back(&p);
  return out;
}

Series series_of(const KindResult& k, const std::string& sweep, const std::string& name,
                 const Color& color, bool joined) {
  Series s{name, color, {}, {}, {}, joined};
  for (const KindPoint* p : of_sweep(k, sweep)) {
    s.x.push_back(p->ms());
    s.y.push_back(p->error);
  }
  return s;
}

Axis axis_over(const std::string& label, const std::vector<Series>& series, bool of_x) {
  std::vector<double> values;
  for (const Series& s : series) {
    const auto& from = of_x ? s.x : s.y;
    values.insert(values.end(), from.begin(), from.end());
  }
  return axis_for(label, values, true);
}

// What each setting of the joint sweep gives, the knobs' own curves over it, and the levels.
void draw_cost(Canvas& canvas, const Box& box, const KindResult& k, bool levels) {
  const std::vector<Series> series{
      series_of(k, "joint", "all settings", Color{0.72f, 0.72f, 0.72f}, false),
      series_of(k, "gbuffer_scale", "pixels a cell", kSeriesColors[0], true),
      series_of(k, "columns", "columns a beam", kSeriesColors[1], true),
      series_of(k, "rows", "rows", kSeriesColors[2], true)};
  const Axis x = axis_over("ms a ping: raster, gather, receiver", series, true);
  Axis y = axis_over("error, with the point spread", series, false);
  y.min = std::min(y.min, 0.008);
  draw_lines(canvas, box, "error over cost", x, y, series);
  const Box in = inside(box);
  for (std::size_t i = 0; i < std::size(kErrorLevels); ++i) {
    if (kErrorLevels[i].max_error < y.min || kErrorLevels[i].max_error > y.max) continue;
    const double py = place(y, kErrorLevels[i].max_error, in.bottom, in.top);
    canvas.segment(in.left, py, in.right, py, 1.0, kRing.with_alpha(0.5f));
    const KindPoint* p = cheapest(k, kErrorLevels[i].max_error);
    if (p == nullptr || !levels) continue;
    canvas.arc(place(x, p->ms(), in.left, in.right), place(y, p->error, in.bottom, in.top),
               8.0 + 3.0 * double(i), -3.1416, 3.1416, 1.8, kRing);
  }
}

// The same knob with and without the point spread.
void draw_resolution(Canvas& canvas, const Box& box, const KindResult& k) {
  Series spread{"with the point spread", kSeriesColors[0], {}, {}},
      cells{"cells without it", kSeriesColors[1], {}, {}};
  for (const KindPoint* p : of_sweep(k, "gbuffer_scale")) {
    spread.x.push_back(p->knobs.scale);
    spread.y.push_back(p->error);
    cells.x.push_back(p->knobs.scale);
    cells.y.push_back(p->error_cells);
  }
  const std::vector<Series> series{spread, cells};
  draw_lines(canvas, box, "error over resolution",
             axis_over("G-buffer pixels a cell", series, true), axis_over("error", series, false),
             series);
}

void draw_other_knobs(Canvas& canvas, const Box& box, const KindResult& k) {
  std::vector<Bar> bars;
  std::size_t color = 0;
  for (const char* sweep : {"gather", "columns", "rows", "range bins", "beams"}) {
    for (const KindPoint* p : of_sweep(k, sweep)) {
      const bool words = std::string(sweep) == "gather";
      bars.push_back({words ? p->setting.substr(0, p->setting == "plane" ? 5 : 4) : p->setting,
                      kSeriesColors[color % 5], 100.0 * p->error});
    }
    ++color;
  }
  draw_bars(canvas, box, "other knobs: error", "%", bars);
  // What the colours stand for, on a line of its own.
  const Box in = inside(box);
  double x = in.left;
  color = 0;
  for (const char* sweep : {"gather", "columns", "rows", "range bins", "beams"}) {
    const Color& c = kSeriesColors[color++ % 5];
    if (of_sweep(k, sweep).empty()) continue;
    canvas.fill_rectangle(x, in.bottom + 32, x + 12, in.bottom + 42, c);
    canvas.text(x + 18, in.bottom + 42, 10.0, sweep, kInk);
    x += 40 + canvas.text_width(10.0, sweep);
  }
}

// What the rings of draw_cost are, a line each.
void draw_levels(Canvas& canvas, double y, const KindResult& k) {
  for (std::size_t i = 0; i < std::size(kErrorLevels); ++i, y += 22) {
    const KindPoint* p = cheapest(k, kErrorLevels[i].max_error);
    const std::string words =
        p ? fmt::format(
                "{} (under {:g} %): {:g} pixels a cell, {} columns, {} rows, {} range bins: "
                "{:.2f} %, {:.1f} ms",
                kErrorLevels[i].name, 100 * kErrorLevels[i].max_error, p->knobs.scale,
                p->knobs.columns, p->knobs.rows, p->bins_range, 100.0 * p->error, p->ms())
          : fmt::format("{} (under {:g} %): none of these", kErrorLevels[i].name,
                        100 * kErrorLevels[i].max_error);
    canvas.arc(84, y - 4, 4.0 + 1.5 * double(i), -3.1416, 3.1416, 1.6, kRing);
    canvas.text(104, y, 10, words, kInk);
  }
}

// One term a line: name, three bars (milliseconds; error with, without), a note.
void draw_terms(Canvas& canvas, double top, const KindResult& k) {
  struct Lane {
    const char* title;
    double left, width, largest;
    Color color;
  } lanes[] = {{"adds, ms a ping", 330, 230, 1e-9, kSeriesColors[0]},
               {"error with it, %", 680, 230, 1e-9, kSeriesColors[2]},
               {"error without it, %", 1030, 230, 1e-9, kSeriesColors[1]}};
  const auto value = [](const TermPoint& t, int lane) {
    return lane == 0 ? std::max(t.ms, 0.0) : 100.0 * (lane == 1 ? t.error_with : t.error_without);
  };
  const auto shown = [](const TermPoint& t, int lane) {
    return lane == 0 || (lane == 1 ? t.error_with : t.error_without) >= 0.0;
  };
  for (const TermPoint& t : k.terms)
    for (int lane = 0; lane < 3; ++lane)
      if (shown(t, lane)) lanes[lane].largest = std::max(lanes[lane].largest, value(t, lane));
  canvas.text(24, top, 13, "terms", kInk, Align::kLeft, draw2d::Face::kBold);
  for (const Lane& lane : lanes) canvas.text(lane.left, top, 10, lane.title, kInk.with_alpha(0.8f));
  double y = top + 12;
  for (const TermPoint& t : k.terms) {
    canvas.text(24, y + 15, 9.5, t.term, kInk);
    for (int i = 0; i < 3; ++i) {
      const Lane& lane = lanes[i];
      if (!shown(t, i)) continue;
      const double v = value(t, i), width = std::max(0.0, v / lane.largest) * lane.width;
      canvas.fill_rectangle(lane.left, y + 3, lane.left + std::max(1.0, width), y + 18, lane.color);
      canvas.text(lane.left + width + 8, y + 15, 9.0, fmt::format("{:.3g}", v), kInk);
    }
    canvas.text(1370, y + 15, 9.0, t.note, kInk.with_alpha(0.8f));
    y += kRow;
  }
}

}  // namespace

ImageU8 draw_kind(const KindResult& k, const std::string& device, const std::string& scene,
                  bool levels) {
  const double terms_top = kTop + kCurves + 130;
  const double height = terms_top + kRow * static_cast<double>(k.terms.size()) + 40;
  Canvas canvas(static_cast<std::uint32_t>(kWidth), static_cast<std::uint32_t>(height), kPaper);
  canvas.text(24, 34, 18, fmt::format("Sonar, {}: error against cost", k.kind), kInk, Align::kLeft,
              draw2d::Face::kBold);
  canvas.text(24, 56, 10,
              fmt::format("{}; scene {}; truth: {:.2g} rays, themselves off by {:.2f} %", device,
                          scene, k.rays, 100.0 * k.uncertain),
              kInk.with_alpha(0.7f));
  draw_cost(canvas, {0, kTop, 660, kTop + kCurves}, k, levels);
  draw_resolution(canvas, {660, kTop, 1130, kTop + kCurves}, k);
  draw_other_knobs(canvas, {1130, kTop, kWidth, kTop + kCurves}, k);
  if (levels)
    draw_levels(canvas, kTop + kCurves + 26, k);
  else
    canvas.text(84, kTop + kCurves + 26, 10, "--quick is too coarse to tell levels by", kInk);
  draw_terms(canvas, terms_top, k);
  return canvas.take();
}

}  // namespace neritic::tools
