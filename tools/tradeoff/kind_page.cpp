#include "tools/tradeoff/kind_page.hpp"

#include <algorithm>
#include <limits>

namespace neritic::tools {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<const KindPoint*> of_sweep(const KindResult& k, const std::string& sweep) {
  std::vector<const KindPoint*> out;
  for (const KindPoint& p : k.points)
    if (p.sweep == sweep) out.push_back(&p);
  return out;
}

// Each setting of the joint sweep, the knobs' own curves over it, and the levels.
Panel cost_panel(const KindResult& k, bool levels) {
  Panel panel{
      "Error over cost", {"ms a ping: raster, gather, receiver"}, {"error, with the point spread"}};
  for (const auto& [sweep, name] : {std::pair{"joint", "all settings"},
                                    {"gbuffer_scale", "pixels a cell"},
                                    {"columns", "columns a beam"},
                                    {"rows", "rows"}}) {
    Series s{name, {}, {}};
    s.joined = std::string(sweep) != "joint";
    for (const KindPoint* p : of_sweep(k, sweep)) {
      s.x.push_back(p->ms());
      s.y.push_back(p->error);
    }
    panel.series.push_back(std::move(s));
  }
  for (const ErrorLevel& level : kErrorLevels) {
    panel.levels.push_back({0.0, level.max_error, fmt::format("{:g} %", 100.0 * level.max_error)});
    if (const KindPoint* p = cheapest(k, level.max_error); p != nullptr && levels)
      panel.marks.push_back({p->ms(), p->error, level.name});
  }
  return panel;
}

// The same knob with and without the point spread.
Panel resolution_panel(const KindResult& k) {
  Series spread{"with the point spread", {}, {}}, cells{"cells without it", {}, {}};
  for (const KindPoint* p : of_sweep(k, "gbuffer_scale")) {
    spread.x.push_back(p->knobs.scale);
    spread.y.push_back(p->error);
    cells.x.push_back(p->knobs.scale);
    cells.y.push_back(p->error_cells);  // negative where it is not measured: left out
  }
  return {"Error over resolution", {"G-buffer pixels a cell"}, {"error"}, {spread, cells}};
}

Panel knobs_panel(const KindResult& k) {
  Panel panel{"Other knobs: error", {""}, {"error, %"}};
  for (const char* sweep : {"gather", "columns", "rows", "range bins", "beams"})
    for (const KindPoint* p : of_sweep(k, sweep))
      panel.bars.push_back({p->setting, sweep, 100.0 * p->error});
  return panel;
}

std::string level_words(const KindResult& k, const ErrorLevel& level) {
  const KindPoint* p = cheapest(k, level.max_error);
  if (p == nullptr)
    return fmt::format("{} (under {:g} %): none of these", level.name, 100 * level.max_error);
  return fmt::format(
      "{} (under {:g} %): {:g} pixels a cell, {} columns, {} rows, {} range bins: {:.2f} %, {:.1f} "
      "ms",
      level.name, 100 * level.max_error, p->knobs.scale, p->knobs.columns, p->knobs.rows,
      p->bins_range, 100.0 * p->error, p->ms());
}

}  // namespace

Page kind_page(const KindResult& k, const std::string& device, const std::string& scene,
               bool levels) {
  Page page{fmt::format("Sonar, {}: error against cost", k.kind),
            {fmt::format("{}; scene {}. Truth: {:.2g} rays, themselves off by {:.2f} %.", device,
                         scene, k.rays, 100.0 * k.uncertain)},
            3,
            {cost_panel(k, levels), resolution_panel(k), knobs_panel(k)},
            {"Term adds, ms a ping", "Error with it, %", "Error without it, %"}};
  if (!levels) page.facts.push_back("--quick is too coarse to tell levels by.");
  for (const ErrorLevel& level : kErrorLevels)
    if (levels) page.facts.push_back(level_words(k, level));
  const auto percent = [](double error) { return error < 0.0 ? kNone : 100.0 * error; };
  for (const TermPoint& t : k.terms)
    page.rows.push_back({t.term, {t.ms, percent(t.error_with), percent(t.error_without)}, t.note});
  return page;
}

}  // namespace neritic::tools
