// The output of `neritic tradeoff navigation` (navigation_tradeoff.hpp).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/navigation_tradeoff.hpp"

namespace neritic::tools {
namespace {

std::string navigation_csv(const NavigationTradeoff& t) {
  std::string out =
      "aids,sweep,rate_hz,error_m,end_m,error_deg,consistency,us_a_second,of_the_file\n";
  for (const NavigationPoint& p : t.points)
    out += fmt::format("{},{},{:g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{}\n", p.aids, p.sweep,
                       p.rate_hz, p.error_m, p.end_m, p.error_deg, p.consistency, p.us_a_second,
                       p.is_file ? 1 : 0);
  return out;
}

std::string facts(const NavigationTradeoff& t) {
  return fmt::format(
      "{}: a survey of {:g} s and {:.0f} m, {} seeds of noise. Inertial unit, pressure sensor and "
      "compass always.",
      t.vehicle, t.flight_s, t.way_m, t.seeds);
}

std::string navigation_md(const NavigationTradeoff& t) {
  std::string out = fmt::format(
      "# Navigation: error against cost\n\n{} Errors are root mean squares against the true "
      "flight; "
      "consistency is the mean square of the position's error over its covariance, 3 where the "
      "filter knows its error.\n",
      facts(t));
  for (const char* sweep : {"imu", "dvl"}) {
    out += fmt::format("\n## Rate of the {}\n\n",
                       std::string(sweep) == "imu" ? "inertial unit" : "DVL");
    out +=
        "| aids | rate, Hz | position, m | at the end, m | attitude, deg | consistency | us of "
        "one core a second |\n|---|---|---|---|---|---|---|\n";
    for (const NavigationPoint& p : t.points)
      if (p.sweep == sweep)
        out += fmt::format("| {} | {:g}{} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {:.0f} |\n", p.aids,
                           p.rate_hz, p.is_file ? " (file)" : "", p.error_m, p.end_m, p.error_deg,
                           p.consistency, p.us_a_second);
  }
  return out;
}

nlohmann::json navigation_json(const NavigationTradeoff& t) {
  nlohmann::json json{{"vehicle", t.vehicle},
                      {"flight_s", t.flight_s},
                      {"way_m", t.way_m},
                      {"seeds", t.seeds},
                      {"points", nlohmann::json::array()}};
  for (const NavigationPoint& p : t.points)
    json["points"].push_back({{"aids", p.aids},
                              {"sweep", p.sweep},
                              {"rate_hz", p.rate_hz},
                              {"error_m", p.error_m},
                              {"end_m", p.end_m},
                              {"error_deg", p.error_deg},
                              {"consistency", p.consistency},
                              {"us_a_second", p.us_a_second},
                              {"of_the_file", p.is_file}});
  return json;
}

Panel panel(const NavigationTradeoff& t, const std::string& sweep, const std::string& title,
            const std::string& label, double (*what)(const NavigationPoint&)) {
  Panel out{title, {"µs of one core a second"}, {label}};
  for (const NavigationPoint& p : t.points) {
    if (p.sweep != sweep) continue;
    if (out.series.empty() || out.series.back().name != p.aids) out.series.push_back({p.aids});
    Series& s = out.series.back();
    s.x.push_back(p.us_a_second);
    s.y.push_back(what(p));
    s.notes.push_back(fmt::format("{:g} Hz", p.rate_hz));
    if (p.is_file) out.marks.push_back({p.us_a_second, what(p), "file"});
  }
  return out;
}

Page navigation_page(const NavigationTradeoff& t) {
  Page page{"Navigation by a vehicle's own sensors: error against cost", {facts(t)}};
  const auto error_m = [](const NavigationPoint& p) { return p.error_m; };
  const auto error_deg = [](const NavigationPoint& p) { return p.error_deg; };
  page.panels.push_back(
      panel(t, "imu", "rate of the inertial unit: position", "rms error, m", error_m));
  page.panels.push_back(
      panel(t, "imu", "rate of the inertial unit: attitude", "rms error, degrees", error_deg));
  page.panels.push_back(panel(t, "dvl", "rate of the DVL: position", "rms error, m", error_m));
  page.panels.push_back(
      panel(t, "dvl", "rate of the DVL: attitude", "rms error, degrees", error_deg));
  return page;
}

}  // namespace

Result<bool> write_navigation_tradeoff(const std::filesystem::path& folder,
                                       const NavigationTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "navigation.csv", navigation_csv(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "navigation.md", navigation_md(tradeoff)));
  NERITIC_TRY_STATUS(write_json(folder / "navigation.json", navigation_json(tradeoff)));
  return write_picture(folder / "navigation.png", page_data(navigation_page(tradeoff)));
}

}  // namespace neritic::tools
