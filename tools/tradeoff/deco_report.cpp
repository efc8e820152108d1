// The output of `neritic tradeoff deco` (deco_tradeoff.hpp).
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "diver/deco_live.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/deco_tradeoff.hpp"

namespace neritic::tools {
namespace {

constexpr TissueMethod kTissueMethods[] = {TissueMethod::kEuler, TissueMethod::kHeld,
                                           TissueMethod::kMean, TissueMethod::kSchreiner,
                                           TissueMethod::kFactors};

std::string deco_csv(const DecoTradeoff& t) {
  std::string out = "dive,method,step_s,error_bar,ceiling_error_m,us_an_hour\n";
  for (const DecoPoint& p : t.points)
    out += fmt::format("\"{}\",{},{:g},{:.4g},{:.4g},{:.4g}\n", p.dive, name_of(p.method), p.step_s,
                       p.error_bar, p.ceiling_error_m, p.us_an_hour);
  return out;
}

void append_table(std::string& out, const std::string& title,
                  const std::vector<DecoPoint>& points) {
  out += "\n## " + title + "\n\n| step, s |";
  for (const TissueMethod m : kTissueMethods) out += fmt::format(" {}, bar | m | us |", name_of(m));
  out += "\n|---|";
  for (std::size_t i = 0; i < 3 * std::size(kTissueMethods); ++i) out += "---|";
  out += "\n";
  for (const DecoPoint& row : points) {
    if (row.method != kTissueMethods[0]) continue;
    out += fmt::format("| {:g} |", row.step_s);
    for (const DecoPoint& p : points)
      if (p.step_s == row.step_s)
        out += fmt::format(" {:.1e} | {:.2g} | {:.3g} |", p.error_bar, p.ceiling_error_m,
                           p.us_an_hour);
    out += "\n";
  }
}

std::string deco_md(const DecoTradeoff& t) {
  const DecoPoint best = knee(t);
  std::string out = fmt::format(
      "# Decompression: error against cost\n\nA dive known by samples, against the exact solution "
      "of "
      "its linear depth changes: the largest error of a tissue (bar) and of the ceiling of GF 30 "
      "(m) "
      "over all samples, and microseconds of one core an hour of diving. The exact methods err "
      "only by corners of the dive between two samples.\n\nKnee: {}, "
      "{:g} s, {:.1e} bar, {:.2g} m, {:.3g} us.\n",
      name_of(best.method), best.step_s, best.error_bar, best.ceiling_error_m, best.us_an_hour);
  append_table(out, "The worst of all dives", worst_of(t));
  for (const std::string& dive : t.dives) {
    std::vector<DecoPoint> points;
    for (const DecoPoint& p : t.points)
      if (p.dive == dive) points.push_back(p);
    append_table(out, dive, points);
  }
  return out;
}

nlohmann::json deco_json(const DecoTradeoff& t) {
  const auto point_json = [](const DecoPoint& p) {
    return nlohmann::json{{"dive", p.dive},
                          {"method", name_of(p.method)},
                          {"step_s", p.step_s},
                          {"error_bar", p.error_bar},
                          {"ceiling_error_m", p.ceiling_error_m},
                          {"us_an_hour", p.us_an_hour}};
  };
  nlohmann::json json{{"knee", point_json(knee(t))}, {"points", nlohmann::json::array()}};
  for (const DecoPoint& p : t.points) json["points"].push_back(point_json(p));
  return json;
}

// Curves of the worst of all dives over x: what(point).
Panel deco_panel(const DecoTradeoff& t, const std::string& title, const std::string& label,
                 double (*what)(const DecoPoint&), bool noted) {
  Panel panel{title, {label}, {"largest error of a tissue, bar"}};
  const std::vector<DecoPoint> worst = worst_of(t);
  for (const TissueMethod m : kTissueMethods) {
    Series s{name_of(m), {}, {}};
    for (const DecoPoint& p : worst) {
      if (p.method != m || !(p.error_bar > 0.0) || p.error_bar > 10.0) continue;
      s.x.push_back(what(p));
      s.y.push_back(p.error_bar);
      if (noted && m == TissueMethod::kFactors) s.notes.push_back(fmt::format("{:g} s", p.step_s));
    }
    panel.series.push_back(std::move(s));
  }
  const DecoPoint best = knee(t);
  panel.marks.push_back({what(best), best.error_bar, "knee"});
  for (const DecoPoint& p : worst)
    if (p.method == TissueMethod::kFactors && p.step_s == diver::kComputerSample_s)
      panel.marks.push_back({what(p), p.error_bar, "default"});
  return panel;
}

Page deco_page(const DecoTradeoff& t) {
  return {"Decompression: error against cost",
          {"Dives known by samples whose corners lie between them, the worst of three. Truth: "
           "Schreiner's equation from corner to corner."},
          2,
          {deco_panel(
               t, "Over the step", "step, s", [](const DecoPoint& p) { return p.step_s; }, false),
           deco_panel(
               t, "Over cost", "µs of one core an hour of diving",
               [](const DecoPoint& p) { return p.us_an_hour; }, true)}};
}

}  // namespace

Result<bool> write_deco_tradeoff(const std::filesystem::path& folder,
                                 const DecoTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "deco.csv", deco_csv(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "deco.md", deco_md(tradeoff)));
  NERITIC_TRY_STATUS(write_json(folder / "deco.json", deco_json(tradeoff)));
  return write_picture(folder / "deco.png", page_data(deco_page(tradeoff)));
}

}  // namespace neritic::tools
