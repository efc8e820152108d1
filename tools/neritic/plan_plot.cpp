#include "tools/neritic/plan_plot.hpp"

#include <algorithm>
#include <cmath>

#include "diver/gas_label.hpp"
#include "tools/common/plot.hpp"

namespace neritic::tools {
namespace {

using draw2d::Align;
using draw2d::Canvas;
using draw2d::Color;

constexpr double kPlanWide = 1500.0, kProfileHigh = 620.0, kGasHigh = 230.0, kTissuesHigh = 390.0;
constexpr double kLabel_px = 9.0, kLegend_px = 110.0;  // that a panel's legend is wide
constexpr Color kCeilingColor{0.75f, 0.10f, 0.10f}, kN2Color{0.0f, 0.447f, 0.698f},
    kHeColor{0.90f, 0.62f, 0.0f};
// More points than this are not told apart.
constexpr std::size_t kMostDrawn = 3000;

Color gas_color(std::size_t gas) {
  return kSeriesColors[gas % std::size(kSeriesColors)];
}

// Depth grows downwards: the axis runs from the top.
Axis depth_axis(const DiveTrace& trace) {
  double deepest = 3.0;
  for (const TraceRow& row : trace.rows)
    deepest = std::max({deepest, row.depth_m, row.view.ceiling_m});
  return {"", 1.08 * deepest, 0.0};
}

void draw_ceiling(Canvas& canvas, const Box& in, const Axis& x, const Axis& y,
                  const std::vector<const TraceRow*>& rows) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto [a, b] = std::pair(rows[i - 1], rows[i]);
    if (a->view.ceiling_m <= 0.0 && b->view.ceiling_m <= 0.0) continue;
    const double left = place(x, a->run_min, in.left, in.right),
                 right = place(x, b->run_min, in.left, in.right);
    const double top_left = place(y, a->view.ceiling_m, in.bottom, in.top),
                 top_right = place(y, b->view.ceiling_m, in.bottom, in.top);
    // Columns of a pixel: what may not be entered.
    for (double px = std::floor(left); px < right; px += 1.0) {
      const double t = right > left ? std::clamp((px - left) / (right - left), 0.0, 1.0) : 0.0;
      canvas.fill_rectangle(std::max(px, left), in.top, std::min(px + 1.0, right),
                            top_left + t * (top_right - top_left), kCeilingColor.with_alpha(0.13f));
    }
    canvas.segment(left, top_left, right, top_right, 1.6, kCeilingColor);
  }
}

void draw_profile(Canvas& canvas, const Box& in, const Axis& x, const Axis& y,
                  const std::vector<const TraceRow*>& rows) {
  for (std::size_t i = 1; i < rows.size(); ++i)
    canvas.segment(place(x, rows[i - 1]->run_min, in.left, in.right),
                   place(y, rows[i - 1]->depth_m, in.bottom, in.top),
                   place(x, rows[i]->run_min, in.left, in.right),
                   place(y, rows[i]->depth_m, in.bottom, in.top), 2.6, gas_color(rows[i]->gas));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i]->gas == rows[i - 1]->gas) continue;
    const double px = place(x, rows[i - 1]->run_min, in.left, in.right),
                 py = place(y, rows[i - 1]->depth_m, in.bottom, in.top);
    canvas.segment(px, py, px, py, 8.0, gas_color(rows[i]->gas));
  }
}

// Beside the panel's title, from the right: each gas in its colour, and the depth at which it is
// first breathed; nothing lies over a curve there.
void name_gases(Canvas& canvas, const Box& box, const std::vector<const TraceRow*>& rows,
                const PlanPicture& picture) {
  std::vector<std::size_t> seen;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (std::ranges::find(seen, rows[i]->gas) != seen.end()) continue;
    seen.push_back(rows[i]->gas);
    words.push_back(diver::name_of(picture.gases[rows[i]->gas].mix));
    if (i > 0) words.back() += fmt::format(" from {:.3g} m", rows[i - 1]->depth_m);
  }
  double right = inside(box).right;
  for (std::size_t i = seen.size(); i-- > 0;) {
    const double top = box.top + 18.0, wide = draw2d::Font().width(kLabel_px, words[i]);
    const Color color = gas_color(seen[i]);
    canvas.text(right - wide, top, kLabel_px, words[i], color, Align::kLeft, draw2d::Face::kBold);
    canvas.segment(right - wide - 28.0, top - 4.0, right - wide - 8.0, top - 4.0, 3.0, color);
    right -= wide + 50.0;
  }
}

// "3 m 22 min" below each stop, where it does not run into the one before.
void name_stops(Canvas& canvas, const Box& in, const Axis& x, const Axis& y,
                const PlanPicture& picture) {
  double free_from = -1e9;
  for (std::size_t i = picture.stops.size(); i-- > 0;) {
    const diver::PlanStop& stop = picture.stops[i];
    const double from = place(x, stop.leave_min - stop.minutes, in.left, in.right),
                 to = place(x, stop.leave_min, in.left, in.right);
    const double py = place(y, stop.depth_m, in.bottom, in.top);
    if (i + 1 < picture.stops.size() && std::abs(py - free_from) < 13.0) continue;
    free_from = py;
    canvas.text(std::max(to, from) + 14.0, py + 13.0, kLabel_px - 1.0,
                fmt::format("{:g} m  {:.3g} min", stop.depth_m, stop.minutes),
                kInk.with_alpha(0.75f));
  }
}

// The pressure at which a compartment reaches its M-value here; nothing where it gives off no gas.
double m_value_of(const diver::Buehlmann& model, const TraceMoment& moment, std::size_t i,
                  double ambient) {
  const double share = diver::gradient_share(model, moment.tissues, i, ambient);
  const double all = moment.tissues.n2_bar[i] + moment.tissues.he_bar[i];
  return share > 0.0 ? ambient + (all - ambient) / share : 0.0;
}

// Bars of nitrogen and helium; what the place's pressure, the M-value and GF high of it are.
void draw_tissues(Canvas& canvas, const Box& box, const PlanPicture& picture,
                  const TraceMoment& moment) {
  const diver::Buehlmann model = picture.conventions.model();
  const double ambient = picture.conventions.environment.pressure_bar(moment.depth_m);
  double most = 1.1 * ambient;
  for (std::size_t i = 0; i < diver::kCompartments; ++i)
    most = std::max({most, 1.05 * m_value_of(model, moment, i, ambient),
                     1.05 * (moment.tissues.n2_bar[i] + moment.tissues.he_bar[i])});
  const Axis x{"compartment, from fast to slow", 0.5, 16.5}, y{"bar", 0.0, most};
  draw_lines(canvas, box,
             fmt::format("{}: {:.0f} min, {:.3g} m, {:.2f} bar", moment.name, moment.run_min,
                         moment.depth_m, ambient),
             x, y, {});
  const Box in = inside(box);
  const double slot = (in.right - in.left) / static_cast<double>(diver::kCompartments);
  const auto height = [&](double bar) { return place(y, bar, in.bottom, in.top); };
  for (std::size_t i = 0; i < diver::kCompartments; ++i) {
    const double left = in.left + (static_cast<double>(i) + 0.15) * slot, right = left + 0.7 * slot;
    const double n2 = moment.tissues.n2_bar[i], all = n2 + moment.tissues.he_bar[i];
    canvas.fill_rectangle(left, height(n2), right, in.bottom, kN2Color.with_alpha(0.85f));
    canvas.fill_rectangle(left, height(all), right, height(n2), kHeColor.with_alpha(0.9f));
    const double m_value = m_value_of(model, moment, i, ambient);
    if (m_value <= 0.0) continue;
    const double high = ambient + picture.gf_high * (m_value - ambient);
    canvas.segment(left, height(m_value), right, height(m_value), 2.2, kCeilingColor);
    canvas.segment(left, height(high), right, height(high), 1.4, kInk);
  }
  canvas.segment(in.left, height(ambient), in.right, height(ambient), 1.6, kInk.with_alpha(0.6f));
}

// The minimum gas: a ring in the gas's colour, joined to what its tank has then; where it is more
// than the panel holds, at its upper edge. Its words stand above the curves, in a row of their own.
void draw_minimum(Canvas& canvas, const Box& in, const Axis& x, const Axis& y,
                  const GasCurve& curve, int row) {
  const double px = place(x, *curve.minimum_run_min, in.left, in.right),
               there = place(y, *curve.then, in.bottom, in.top),
               words_y = in.top + 10.0 + 14.0 * row,
               py = std::max(place(y, *curve.minimum, in.bottom, in.top), words_y);
  const Color color = gas_color(curve.gas);
  canvas.segment(px, words_y, px, there, 1.2, color.with_alpha(0.6f));
  canvas.arc(px, py, 8.0, -3.1416, 3.1416, 2.0, color);
  const bool enough = *curve.minimum <= *curve.then;
  const std::string words =
      fmt::format("{}: {:.0f} bar{}", curve.name, *curve.minimum,
                  enough ? "" : fmt::format(", more than the {:.0f} there", *curve.then));
  const bool fits = px + 18.0 + draw2d::Font().width(kLabel_px, words) < in.right - kLegend_px;
  canvas.text(fits ? px + 18.0 : px - 18.0, words_y + 4.0, kLabel_px, words,
              enough ? color : kCeilingColor, fits ? Align::kLeft : Align::kRight);
}

// A cross where a tank gives no full breath any more, and in a row above the curves when that is.
void draw_used_up(Canvas& canvas, const Box& in, const Axis& x, const Axis& y,
                  const GasCurve& curve, int row) {
  const double px = place(x, curve.run_min.back(), in.left, in.right),
               py = place(y, curve.value.back(), in.bottom, in.top),
               words_y = in.top + 10.0 + 14.0 * row;
  const std::string words =
      fmt::format("{}: used up at {:.0f} min", curve.name, curve.run_min.back());
  canvas.segment(px, words_y, px, py, 1.2, kCeilingColor.with_alpha(0.6f));
  for (const double slope : {-6.0, 6.0})
    canvas.segment(px - 6.0, py - slope, px + 6.0, py + slope, 2.2, kCeilingColor);
  const bool fits = px - 12.0 - draw2d::Font().width(kLabel_px, words) > in.left;
  canvas.text(fits ? px - 12.0 : px + 12.0, words_y + 4.0, kLabel_px, words, kCeilingColor,
              fits ? Align::kRight : Align::kLeft);
}

// What is left of each gas, or used of it where no tank is known.
void draw_gas(Canvas& canvas, const Box& box, const Axis& x, const std::vector<GasCurve>& gas) {
  std::vector<Series> series;
  std::string without;
  const bool bar = std::ranges::any_of(gas, &GasCurve::bar);
  double most = 1.0;
  for (const GasCurve& curve : gas) {
    if (curve.bar != bar) {
      without += (without.empty() ? "; no tank told: " : ", ") + curve.name;
      continue;
    }
    series.push_back(
        {curve.name, gas_color(curve.gas), curve.run_min, curve.value, {}, true, false});
    for (const double value : curve.value) most = std::max(most, value);
  }
  // Room for rings and their words.
  const Axis y{"", 0.0, 1.4 * most};
  draw_lines(canvas, box,
             bar ? "Bar in the tanks; ring: minimum gas, which must be there then" + without
                 : std::string("Litres used, at 1 bar"),
             x, y, series, false);
  int row = 0;
  for (const GasCurve& curve : gas)
    if (curve.bar && curve.minimum) draw_minimum(canvas, inside(box), x, y, curve, row++);
  for (const GasCurve& curve : gas)
    if (curve.used_up) draw_used_up(canvas, inside(box), x, y, curve, row++);
}

void draw_legend(Canvas& canvas, double left, double top, const PlanPicture& picture) {
  const auto item = [&](const Color& color, const std::string& words, double width) {
    canvas.segment(left, top - 4.0, left + 22.0, top - 4.0, 3.0, color);
    canvas.text(left + 30.0, top, kLabel_px, words, kInk);
    left += width;
  };
  item(kCeilingColor, "ceiling; M-value of what gives off gas here", 420.0);
  item(kN2Color, "nitrogen", 130.0);
  if (std::ranges::any_of(picture.gases, [](const auto& gas) { return gas.mix.helium > 0.0; }))
    item(kHeColor, "helium", 110.0);
  item(kInk, fmt::format("GF high, {:g} % of the way to the M-value", 100.0 * picture.gf_high),
       410.0);
  item(kInk.with_alpha(0.6f), "across: the water's pressure", 10.0);
}

// Words above the panels; returns where these begin. Long lines are set smaller.
double draw_head(Canvas* canvas, const PlanPicture& picture) {
  const auto line = [&](double y, double size_px, const std::string& words, const Color& color) {
    if (!canvas) return;
    const double most = kPlanWide - 48.0, wide = draw2d::Font().width(size_px, words);
    canvas->text(24, y, wide > most ? size_px * most / wide : size_px, words, color, Align::kLeft,
                 size_px > 12.0 ? draw2d::Face::kBold : draw2d::Face::kRegular);
  };
  line(34, 16, picture.title, kInk);
  line(56, 10, picture.below, kInk.with_alpha(0.75f));
  double y = 56.0;
  if (!picture.where.empty()) line(y += 20.0, 10, picture.where, kInk.with_alpha(0.75f));
  for (const std::string& warning : picture.warnings)
    line(y += 20.0, 10, "WARNING: " + warning, kCeilingColor);
  return y + 14.0;
}

}  // namespace

ImageU8 draw_dive(const PlanPicture& picture, const DiveTrace& trace) {
  const double head = draw_head(nullptr, picture);
  const double gas_high = picture.gas.empty() ? 0.0 : kGasHigh;
  const double profile = head + kProfileHigh, split = profile + gas_high,
               high = split + kTissuesHigh;
  Canvas canvas(static_cast<std::uint32_t>(kPlanWide), static_cast<std::uint32_t>(high), kPaper);
  draw_head(&canvas, picture);
  std::vector<const TraceRow*> rows;
  const std::size_t every = trace.rows.size() / kMostDrawn + 1;
  for (std::size_t i = 0; i < trace.rows.size(); ++i)
    if (i % every == 0 || i + 1 == trace.rows.size()) rows.push_back(&trace.rows[i]);
  const Box box{10, head, kPlanWide - 10.0, profile};
  const Axis x{"run time, min", 0.0, std::max(1.09 * trace.rows.back().run_min, 1e-3)};
  const Axis y = depth_axis(trace);
  draw_lines(canvas, box, "Depth in metres; red: above the ceiling", x, y, {});
  name_gases(canvas, box, rows, picture);
  const Box in = inside(box);
  draw_ceiling(canvas, in, x, y, rows);
  draw_profile(canvas, in, x, y, rows);
  name_stops(canvas, in, x, y, picture);
  if (!picture.gas.empty())
    draw_gas(canvas, {10, profile, kPlanWide - 10.0, split}, x, picture.gas);
  const double wide = (kPlanWide - 20.0) / static_cast<double>(trace.moments.size());
  for (std::size_t i = 0; i < trace.moments.size(); ++i) {
    const double left = 10.0 + wide * static_cast<double>(i);
    draw_tissues(canvas, {left, split, left + wide, high - 30.0}, picture, trace.moments[i]);
  }
  draw_legend(canvas, 90.0, high - 12.0, picture);
  return canvas.take();
}

}  // namespace neritic::tools
