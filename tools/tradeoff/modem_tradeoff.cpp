#include "tools/tradeoff/modem_tradeoff.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "sonar/modem.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"

namespace neritic::tools {
namespace {

constexpr int kMidpoints = 200'000, kModemPaths = 3;
constexpr const char* kPathNames[kModemPaths] = {"constant", "straight", "bent"};
constexpr double kTop_m = 3.0, kRange_m_s = 1500.0;

sonar::SoundSpeedProfile summer() {
  return sonar::SoundSpeedProfile::of_table(
             {{0.0, 1520.0}, {20.0, 1518.0}, {60.0, 1492.0}, {300.0, 1488.0}})
      .value();
}

// Time and horizontal distance of the ray with that parameter, cos(elevation) / c.
std::pair<double, double> snell(const sonar::SoundSpeedProfile& profile, double bottom_m,
                                double parameter) {
  const double dz = (bottom_m - kTop_m) / kMidpoints;
  double time_s = 0.0, level_m = 0.0;
  for (int i = 0; i < kMidpoints; ++i) {
    const double c = profile.speed_m_s(kTop_m + (i + 0.5) * dz);
    const double sine = std::sqrt(std::max(1.0 - parameter * c * parameter * c, 1e-18));
    time_s += dz / (c * sine);
    level_m += dz * parameter * c / sine;
  }
  return {time_s, level_m};
}

double true_time_s(const sonar::SoundSpeedProfile& profile, double level_m, double bottom_m) {
  double low = 0.0, high = 1.0 / 1520.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (snell(profile, bottom_m, middle).second < level_m ? low : high) = middle;
  }
  return snell(profile, bottom_m, low).first;
}

}  // namespace

std::vector<ModemPoint> run_modem_tradeoff(int runs) {
  sonar::ModemWater water;
  water.profile = summer();
  std::vector<ModemPoint> points;
  for (const double slope : {4.0, 2.0, 1.0, 0.5, 0.35, 0.25}) {
    std::vector<std::pair<Vec3, double>> ends;  // and their true times
    for (const double bottom_m : {60.0, 120.0, 200.0}) {
      const double level_m = (bottom_m - kTop_m) / slope;
      ends.emplace_back(Vec3(level_m, 0.0, bottom_m),
                        true_time_s(*water.profile, level_m, bottom_m));
    }
    for (int path = 0; path < kModemPaths; ++path) {
      water.path = static_cast<sonar::ModemPath>(path);
      ModemPoint point{kPathNames[path], slope, 0.0, 0.0};
      const TimeNs begun_ns = now_ns();
      double sum = 0.0;
      for (int run = 0; run < runs; ++run)
        for (const auto& [end, time_s] : ends)
          sum += modem_travel_s(water, {0.0, 0.0, kTop_m}, end);
      point.cost_ns = std::isfinite(sum)
                          ? static_cast<double>(now_ns() - begun_ns) / static_cast<double>(runs) /
                                static_cast<double>(ends.size())
                          : 0.0;
      for (const auto& [end, time_s] : ends)
        point.error_m = std::max(
            point.error_m,
            kRange_m_s * std::abs(modem_travel_s(water, {0.0, 0.0, kTop_m}, end) - time_s));
      points.push_back(point);
    }
  }
  return points;
}

Result<bool> write_modem_tradeoff(const std::filesystem::path& folder,
                                  const std::vector<ModemPoint>& points) {
  std::string csv = "path,slope,error_m,cost_ns\n";
  std::string md =
      "# Acoustic ranges: error against cost\n\nThe largest error of a range, m, by how a path's "
      "travel time is found, and ns a path. Summer water: 1520 m/s above 20 m, 1492 below 60 m.\n\n"
      "| path | slope down | error, m | ns |\n|---|---|---|---|\n";
  Page page{
      "Acoustic ranges in summer water: error against cost",
      {"Largest error of a range from 3 m down to 60, 120 and 200 m; truth: Snell's integral."}};
  Panel panel{"Each way of finding a path", {"ns a path"}, {"largest error, m"}};
  for (const char* name : kPathNames) {
    Series series{name, {}, {}};
    series.joined = false;
    for (const ModemPoint& p : points) {
      if (p.path != name) continue;
      csv += fmt::format("{},{},{:.4g},{:.4g}\n", p.path, p.slope, p.error_m, p.cost_ns);
      md += fmt::format("| {} | {} | {:.2g} | {:.0f} |\n", p.path, p.slope, p.error_m, p.cost_ns);
      series.x.push_back(p.cost_ns);
      series.y.push_back(p.error_m);
      series.notes.push_back(fmt::format("slope {:g}", p.slope));
    }
    panel.series.push_back(std::move(series));
  }
  page.panels.push_back(std::move(panel));
  page.columns = 1;
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "modem.csv", csv));
  NERITIC_TRY_STATUS(write_text(folder / "modem.md", md));
  return write_picture(folder / "modem.png", page_data(page));
}

}  // namespace neritic::tools
