// Tables of `neritic tradeoff sonar` for each kind (sonar_tradeoff.hpp); kind_page.hpp has
// the pictures.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/kind_page.hpp"
#include "tools/tradeoff/sonar_tradeoff.hpp"

namespace neritic::tools {
namespace {

std::string knobs_csv(const KindResult& k) {
  std::string out =
      "sweep,setting,gather,gbuffer_scale,columns,rows,bins_range,beams,error,error_cells,"
      "error_energy,raster_ms,gather_ms,receive_ms,ms\n";
  for (const KindPoint& p : k.points)
    out += fmt::format(
        "{},\"{}\",{},{:g},{},{},{},{},{:.5f},{},{:.5f},{:.3f},{:.3f},{:.3f},{:.3f}\n", p.sweep,
        p.setting, p.knobs.gather, p.knobs.scale, p.knobs.columns, p.knobs.rows, p.bins_range,
        p.beams, p.error, p.error_cells < 0.0 ? "" : fmt::format("{:.5f}", p.error_cells), p.energy,
        p.raster_ms, p.gather_ms, p.receive_ms, p.ms());
  return out;
}

std::string number(double v) {
  return v < 0.0 ? "" : fmt::format("{:.5f}", v);
}

std::string terms_csv(const KindResult& k) {
  std::string out = "term,ms,resolution_ms,error_with,error_without,note\n";
  for (const TermPoint& t : k.terms)
    out += fmt::format("\"{}\",{:.3f},{:.3f},{},{},\"{}\"\n", t.term, t.ms, t.resolution_ms,
                       number(t.error_with), number(t.error_without), t.note);
  return out;
}

nlohmann::json json_of(const KindPoint& p) {
  return {{"gbuffer_scale", p.knobs.scale},
          {"columns", p.knobs.columns},
          {"rows", p.knobs.rows},
          {"bins_range", p.bins_range},
          {"gather", p.knobs.gather},
          {"error", p.error},
          {"ms", p.ms()}};
}

nlohmann::json summary(const SonarTradeoff& t) {
  nlohmann::json json{
      {"device", t.device},
      {"quick", t.quick},
      {"scene", t.kinds_scene},
      {"error",
       "mean relative error of a cell of the image with the sensor's point spread, weighted by the "
       "cell's true energy: sum of absolute differences over the total"},
      {"columns", "gathered a beam in azimuth (an echo sounder's: in its cone)"},
      {"rows", "gathered in elevation"}};
  for (const KindResult& k : t.kinds) {
    nlohmann::json& kind = json["kinds"][k.kind];
    kind["rays"] = k.rays;
    kind["error_of_the_rays"] = k.uncertain;
    if (t.quick) continue;  // its few coarse settings name no level
    for (const ErrorLevel& level : kErrorLevels)
      if (const KindPoint* p = cheapest(k, level.max_error)) kind[level.name] = json_of(*p);
  }
  return json;
}

// A price that is within twice its own error of nothing is only bounded.
std::string price(const TermPoint& t) {
  const double least_ms = t.ms - 2.0 * t.resolution_ms;
  if (t.resolution_ms > 0.0 && least_ms <= 0.0)
    return fmt::format("< {:.1f}", std::max(0.1, std::max(t.ms, 0.0) + 2.0 * t.resolution_ms));
  return fmt::format("{:+.1f}", t.ms);
}

std::string percent(double v) {
  return v < 0.0 ? "" : fmt::format("{:.2f} %", 100.0 * v);
}

constexpr const char* kQuickNote =
    "Made with --quick: coarser sensors, one shot, few rays, one or two settings a knob, each "
    "timed "
    "once. It tells that everything runs and how knobs compare; it cannot tell a setting's error "
    "to "
    "a per cent, what a ping costs, or the cheapest settings within 5, 2 and 1 %: no quality "
    "levels "
    "are named.";

std::string levels_table(const SonarTradeoff& t) {
  std::string out =
      "| kind | level | pixels a cell | columns | rows | range bins | error | ms |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const KindResult& k : t.kinds)
    for (const ErrorLevel& level : kErrorLevels) {
      const KindPoint* p = cheapest(k, level.max_error);
      out += p ? fmt::format("| {} | {} | {:g} | {} | {} | {} | {} | {:.1f} |\n", k.kind,
                             level.name, p->knobs.scale, p->knobs.columns, p->knobs.rows,
                             p->bins_range, percent(p->error), p->ms())
               : fmt::format("| {} | {} | none | | | | | |\n", k.kind, level.name);
    }
  return out;
}

// For a person: what the levels are, what each knob and term costs and buys.
std::string markdown(const SonarTradeoff& t) {
  std::string out = fmt::format("Scene {}, on {}.\n\n{}", t.kinds_scene, t.device,
                                t.quick ? std::string(kQuickNote) + "\n" : levels_table(t));
  for (const KindResult& k : t.kinds) {
    out += fmt::format(
        "\n## {}\n\n{:.2g} rays, whose own image is off by {}.\n\n"
        "| knob | setting | error | error of cells | raster ms | gather ms | receive ms |\n"
        "|---|---|---|---|---|---|---|\n",
        k.kind, k.rays, percent(k.uncertain));
    for (const KindPoint& p : k.points)
      if (p.sweep != "joint")
        out += fmt::format("| {} | {} | {} | {} | {:.1f} | {:.1f} | {:.1f} |\n", p.sweep, p.setting,
                           percent(p.error), percent(p.error_cells), p.raster_ms, p.gather_ms,
                           p.receive_ms);
    out += "\n| term | ms | error with it | error without it | |\n|---|---|---|---|---|\n";
    for (const TermPoint& p : k.terms)
      out += fmt::format("| {} | {} | {} | {} | {} |\n", p.term, price(p), percent(p.error_with),
                         percent(p.error_without), p.note);
  }
  return out;
}

}  // namespace

Result<bool> write_last_kind(const std::filesystem::path& folder, const SonarTradeoff& tradeoff) {
  NERITIC_CHECK(!tradeoff.kinds.empty(), "no kind is measured");
  NERITIC_TRY_STATUS(make_folder(folder));
  const KindResult& k = tradeoff.kinds.back();
  NERITIC_TRY_STATUS(write_text(folder / (k.kind + ".csv"), knobs_csv(k)));
  NERITIC_TRY_STATUS(write_text(folder / (k.kind + "_terms.csv"), terms_csv(k)));
  NERITIC_TRY_STATUS(write_text(folder / "tradeoff.md", markdown(tradeoff)));
  NERITIC_TRY_STATUS(write_json(folder / "quality.json", summary(tradeoff)));
  return write_picture(
      folder / (k.kind + ".png"),
      page_data(kind_page(k, tradeoff.device, tradeoff.kinds_scene, !tradeoff.quick)));
}

}  // namespace neritic::tools
