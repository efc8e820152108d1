// The output of `neritic tradeoff swim` (swim_tradeoff.hpp).
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/swim_tradeoff.hpp"

namespace neritic::tools {
namespace {

constexpr const char* kSwimNames[] = {"straight", "turning", "ascent"};

std::string model_name(diver::Model model) {
  return model == diver::Model::kFull ? "full" : "planar";
}
std::string variant_name(const SwimPoint& p) {
  return p.model == diver::Model::kPlanar
             ? "planar"
             : fmt::format("{} strip{}", p.strips, p.strips == 1 ? "" : "s");
}

std::string swim_csv(const SwimTradeoff& t) {
  std::string out =
      "swim,model,strips,step_ms,error_m,way_error,strips_a_second,us_a_second,default\n";
  for (const SwimPoint& p : t.points)
    out += fmt::format("{},{},{},{:.6g},{:.4g},{:.4g},{:.6g},{:.4g},{}\n", p.swim,
                       model_name(p.model), p.strips, 1e3 * p.step_s, p.error_m, p.way_error,
                       p.strips_a_second, p.us_a_second, is_default(p) ? 1 : 0);
  return out;
}

// Variants in the order of the points.
std::vector<std::string> variants_of(const SwimTradeoff& t) {
  std::vector<std::string> out;
  for (const SwimPoint& p : t.points)
    if (std::ranges::find(out, variant_name(p)) == out.end()) out.push_back(variant_name(p));
  return out;
}

std::string point_words(const SwimPoint& p) {
  return fmt::format("{} at {:.3g} ms, {:.1e} m, {:.0f} strips a second, {:.0f} us",
                     variant_name(p), 1e3 * p.step_s, p.error_m, p.strips_a_second, p.us_a_second);
}

std::string swim_md(const SwimTradeoff& t) {
  std::string out = fmt::format(
      "# Swimming: error against cost\n\nA diver with full gear kicks for {:g} s ({:.1f} m); the "
      "largest distance from the same swim with 64 strips a segment and steps of 0.25 ms (itself "
      "within {:.0e} m of steps of 0.5 ms), and microseconds of one core a second of swimming.\n",
      t.swim_s, t.way_m, t.reference_error_m);
  const auto names = variants_of(t);
  for (const char* swim : kSwimNames) {
    out += fmt::format("\n## {}\n\n| step, ms |", swim);
    for (const std::string& name : names) out += fmt::format(" {}, m | us |", name);
    out += "\n|---|";
    for (std::size_t i = 0; i < names.size(); ++i) out += "---|---|";
    out += "\n";
    for (const SwimPoint& row : t.points) {
      if (row.swim != swim || variant_name(row) != names[0]) continue;
      out += fmt::format("| {:.3g} |", 1e3 * row.step_s);
      for (const SwimPoint& p : t.points)
        if (p.swim == swim && p.step_s == row.step_s)
          out += fmt::format(" {:.1e}{} | {:.0f} |", p.error_m, is_default(p) ? " (default)" : "",
                             p.us_a_second);
      out += "\n";
    }
    if (const SwimPoint* p = knee(t.points, swim))
      out += fmt::format("\nThe knee: {}.\n", point_words(*p));
  }
  const std::vector<SwimPoint> worst = worst_of_all(t);
  out += "\n## The worst of all swims\n\n";
  if (const SwimPoint* p = knee(worst, kAllSwims))
    out += fmt::format("The knee: {}.\n", point_words(*p));
  for (const double share : {0.01, 0.005, kWithinShare, 0.001})
    if (const SwimPoint* p = cheapest_within(worst, kAllSwims, share * t.way_m))
      out += fmt::format("The cheapest within {:g} % of the way ({:.1e} m): {}.\n", 100.0 * share,
                         share * t.way_m, point_words(*p));
  return out;
}

nlohmann::json swim_point_json(const SwimPoint& p) {
  return {{"model", model_name(p.model)}, {"strips", p.strips},
          {"step_ms", 1e3 * p.step_s},    {"error_m", p.error_m},
          {"way_error", p.way_error},     {"strips_a_second", p.strips_a_second},
          {"us_a_second", p.us_a_second}};
}

nlohmann::json swim_json(const SwimTradeoff& t) {
  nlohmann::json json{
      {"swim_s", t.swim_s}, {"way_m", t.way_m}, {"reference_error_m", t.reference_error_m}};
  for (const char* swim : kSwimNames)
    if (const SwimPoint* p = knee(t.points, swim)) json["knees"][swim] = swim_point_json(*p);
  const std::vector<SwimPoint> worst = worst_of_all(t);
  if (const SwimPoint* p = knee(worst, kAllSwims)) json["knees"][kAllSwims] = swim_point_json(*p);
  if (const SwimPoint* p = cheapest_within(worst, kAllSwims, kWithinShare * t.way_m)) {
    json["cheapest_within"] = swim_point_json(*p);
    json["cheapest_within"]["share_of_way"] = kWithinShare;
  }
  for (const SwimPoint& p : t.points)
    if (is_default(p)) json["default"][p.swim] = swim_point_json(p);
  return json;
}

// Error over what(point), a curve for each of some variants; more would not be distinguishable.
Panel swim_panel(const SwimTradeoff& t, const std::string& swim, const std::string& title,
                 const std::string& label, double (*what)(const SwimPoint&), bool noted) {
  const char* const drawn[] = {"1 strip",  "2 strips",  "4 strips",
                               "6 strips", "16 strips", "planar"};
  Panel panel{title, {label}, {"largest error, m"}};
  for (const char* name : drawn) {
    Series s{name, {}, {}};
    for (const SwimPoint& p : t.points) {
      if (p.swim != swim || variant_name(p) != name || !(p.error_m > 0.0) || p.error_m > 100.0)
        continue;
      s.x.push_back(what(p));
      s.y.push_back(p.error_m);
      if (noted && variant_name(p) == drawn[3])
        s.notes.push_back(fmt::format("{:.3g} ms", 1e3 * p.step_s));
    }
    panel.series.push_back(std::move(s));
  }
  for (const SwimPoint& p : t.points)
    if (p.swim == swim && is_default(p)) panel.marks.push_back({what(p), p.error_m, "default"});
  return panel;
}

Page swim_page(const SwimTradeoff& t) {
  Page page{"Swimming by moving limbs: error against cost",
            {fmt::format("{:g} s of flutter kick, {:.1f} m. Truth: 64 strips a segment, 0.25 ms.",
                         t.swim_s, t.way_m)}};
  for (const std::string swim : kSwimNames) {
    page.panels.push_back(swim_panel(
        t, swim, swim + ": over cost", "µs of one core a second",
        [](const SwimPoint& p) { return p.us_a_second; }, true));
    page.panels.push_back(swim_panel(
        t, swim, swim + ": over the step", "step, ms",
        [](const SwimPoint& p) { return 1e3 * p.step_s; }, false));
  }
  return page;
}

}  // namespace

Result<bool> write_swim_tradeoff(const std::filesystem::path& folder,
                                 const SwimTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "swim.csv", swim_csv(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "swim.md", swim_md(tradeoff)));
  NERITIC_TRY_STATUS(write_json(folder / "swim.json", swim_json(tradeoff)));
  return write_picture(folder / "swim.png", page_data(swim_page(tradeoff)));
}

}  // namespace neritic::tools
