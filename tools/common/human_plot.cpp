#include "tools/common/human_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diver/gas_label.hpp"

namespace neritic::tools {
namespace {

constexpr double kHeadroom = 0.25;
constexpr sonar::Color kTankColors[diver::kMaxTanks] = {
    kSeriesColors[0], kSeriesColors[3], kSeriesColors[4], {0.902f, 0.624f, 0.0f}};

using HumanValue = std::function<double(const HumanRow&)>;

double human_time(const HumanRow& row) {
  return row.time_s;
}

Series of_human(const std::vector<HumanRow>& rows, std::size_t human, const std::string& name,
                std::size_t color, const HumanValue& x, const HumanValue& y) {
  return series_from<HumanRow>(
      rows, [human](const HumanRow& row) { return row.human == human; }, name,
      kSeriesColors[color % std::size(kSeriesColors)], x, y);
}

// The rows of one diver among all.
struct OwnRows {
  const std::vector<HumanRow>& all;
  std::size_t human;
};

Series over_time(const OwnRows& rows, const std::string& name, std::size_t color,
                 const HumanValue& y) {
  return of_human(rows.all, rows.human, name, color, human_time, y);
}

// Vehicles have the first colours.
std::size_t color_of(const PhysicsWorld& world, std::size_t human) {
  return world.vehicles().size() + human;
}

std::string tank_name(const PhysicsHuman& human, std::size_t tank) {
  const std::string mix = diver::name_of(human.body.tanks[tank].mix);
  return human.body.tank_count == 1 ? "tank, " + mix : fmt::format("tank {}, {}", tank + 1, mix);
}

// Each tank's pressure, and a dot where the diver changes to it.
std::vector<Series> tank_lines(const PhysicsHuman& human, const OwnRows& rows) {
  std::vector<Series> lines;
  Series changes{"changes tank", kInk, {}, {}};
  changes.joined = false;
  const HumanRow* before = nullptr;
  for (const HumanRow& row : rows.all) {
    if (row.human != rows.human) continue;
    if (before != nullptr && row.tank != before->tank && row.tank < human.body.tank_count) {
      changes.x.push_back(row.time_s);
      changes.y.push_back(1e-5 * row.tank_pa[row.tank]);
    }
    before = &row;
  }
  for (std::size_t tank = 0; tank < human.body.tank_count; ++tank) {
    lines.push_back(over_time(rows, tank_name(human, tank), 0,
                              [tank](const HumanRow& r) { return 1e-5 * r.tank_pa[tank]; }));
    lines.back().color = kTankColors[tank];
  }
  if (!changes.x.empty()) lines.push_back(changes);
  return lines;
}

using diver::AscentAlarm;
using diver::RiskLevel;

// What endangers a diver, the gravest last.
struct Danger {
  const char* name;
  sonar::Color color;
  bool (*is)(const HumanRow&);
};
constexpr Danger kDangers[] = {
    {"gas or breath of high risk",
     {0.902f, 0.624f, 0.0f},
     [](const HumanRow& r) {
       const diver::RiskProxies& risk = r.vitals.risk;
       return std::max({risk.co2, risk.narcosis, risk.gas_density, risk.breathing}) >=
              RiskLevel::kHigh;
     }},
    {"rises fast",
     {0.95f, 0.45f, 0.45f},
     [](const HumanRow& r) { return r.ascent.view.alarm == AscentAlarm::kFast; }},
    {"rises dangerously fast",
     {0.8f, 0.0f, 0.1f},
     [](const HumanRow& r) { return r.ascent.view.alarm == AscentAlarm::kDangerous; }},
    {"above the ceiling",
     {0.55f, 0.1f, 0.55f},
     [](const HumanRow& r) { return r.ascent.view.ceiling_violated; }},
    {"oxygen beyond its limits",
     {0.0f, 0.5f, 0.35f},
     [](const HumanRow& r) { return r.vitals.risk.oxygen >= RiskLevel::kHigh; }},
    {"nothing to breathe", kInk, [](const HumanRow& r) { return r.out_of_gas_s > 0.0; }}};
// Each below the one before, in shares of the depths that are drawn.
constexpr double kDangersApart = 0.02;

double depth_of(const HumanRow& row) {
  return -row.world_from_body.position_m.y;
}

// Of all dangers that are met, dots along the line of depth, side by side.
void add_dangers(std::vector<Series>& lines, const OwnRows& rows) {
  const Axis depths = roomy_axis("", lines, &Series::y, 1.0);
  const double apart_m = kDangersApart * (depths.max - depths.min);
  double below_m = 0.0;
  for (const Danger& danger : kDangers) {
    Series dots = series_from<HumanRow>(
        rows.all, [&](const HumanRow& row) { return row.human == rows.human && danger.is(row); },
        danger.name, danger.color, human_time,
        [&](const HumanRow& row) { return depth_of(row) + below_m; });
    if (dots.x.empty()) continue;
    dots.joined = false;
    dots.marked = true;
    lines.push_back(std::move(dots));
    below_m += apart_m;
  }
}

// As a dive computer's profile: the surface at the top.
void draw_profile(sonar::Canvas& canvas, const Box& box, const std::string& name,
                  const OwnRows& rows) {
  std::vector<Series> lines{over_time(rows, "depth", 0, depth_of)};
  for (const Series& line :
       {over_time(rows, "ceiling", 1, [](const HumanRow& r) { return r.ascent.view.ceiling_m; }),
        over_time(rows, "next stop", 3, [](const HumanRow& r) { return r.ascent.view.stop_m; })})
    if (std::ranges::any_of(line.y, [](double m) { return m > 0.0; })) lines.push_back(line);
  add_dangers(lines, rows);
  const Axis x = roomy_axis("time, s", lines, &Series::x, 1e-3);
  const Axis y = roomy_axis("m", lines, &Series::y, 1.0);
  draw_lines(canvas, box, "Depth, ceiling and dangers of " + name, x, {y.label, y.max, y.min},
             lines);
}

std::vector<Series> rate_lines(const PhysicsHuman& human, const OwnRows& rows) {
  std::vector<Series> lines{
      over_time(rows, "upwards", 0, [](const HumanRow& r) { return r.ascent.view.ascent_m_min; })};
  const diver::AscentRateLimits& limits = human.computer->settings().ascent;
  const double most = lines[0].y.empty() ? 0.0 : std::ranges::max(lines[0].y);
  // A limit is drawn where half of it is reached.
  if (most > 0.5 * limits.fast_m_min)
    lines.push_back(over_time(rows, "fast", 1, [&](const HumanRow&) { return limits.fast_m_min; }));
  if (most > 0.5 * limits.dangerous_m_min)
    lines.push_back(
        over_time(rows, "dangerous", 3, [&](const HumanRow&) { return limits.dangerous_m_min; }));
  return lines;
}

// What is more than this, or has no end, is a gap.
constexpr double kLongest_min = 300.0;

std::vector<Series> minute_lines(const OwnRows& rows) {
  const auto line = [&](const char* what, std::size_t color, double longest_min,
                        double (*minutes)(const HumanRow&)) {
    return over_time(rows, what, color, [=](const HumanRow& r) {
      const double value = minutes(r);
      return value <= longest_min ? value : std::numeric_limits<double>::quiet_NaN();
    });
  };
  return {line("without stops", 0, kLongest_min,
               [](const HumanRow& r) { return r.ascent.view.no_stop_min; }),
          line("to the surface", 1, std::numeric_limits<double>::max(),
               [](const HumanRow& r) { return r.ascent.view.to_surface_min; }),
          line("gas left to 50 bar", 2, kLongest_min,
               [](const HumanRow& r) { return r.gas.remaining_s / 60.0; })};
}

// Each as a share of where it counts as raised.
std::vector<Series> risk_lines(const OwnRows& rows) {
  const auto line = [&](const char* what, std::size_t color, double raised,
                        double (*value)(const HumanRow&)) {
    return over_time(rows, what, color,
                     [raised, value](const HumanRow& r) { return 100.0 * value(r) / raised; });
  };
  return {line("CO2 proxy", 0, diver::kCo2Levels_mmhg[0],
               [](const HumanRow& r) { return r.vitals.risk.co2_mmhg; }),
          line("narcotic depth", 1, diver::kNarcoticLevels_m[0],
               [](const HumanRow& r) { return r.vitals.risk.narcotic_depth_m; }),
          line("gas density", 2, diver::kDensityLevels_kg_m3[0],
               [](const HumanRow& r) { return r.ascent.view.density_g_l; }),
          line("oxygen pressure", 3, diver::kOxygenLevels_bar[0],
               [](const HumanRow& r) { return r.vitals.risk.oxygen_bar; })};
}

}  // namespace

std::vector<Series> human_paths(const PhysicsWorld& world, const std::vector<HumanRow>& rows) {
  std::vector<Series> lines;
  for (std::size_t i = 0; i < world.humans().size(); ++i)
    lines.push_back(of_human(
        rows, i, world.humans()[i].name, color_of(world, i),
        [](const HumanRow& r) { return r.world_from_body.position_m.x; },
        [](const HumanRow& r) { return -r.world_from_body.position_m.z; }));
  return lines;
}

std::vector<Series> human_heights(const PhysicsWorld& world, const std::vector<HumanRow>& rows) {
  std::vector<Series> lines;
  for (std::size_t i = 0; i < world.humans().size(); ++i)
    lines.push_back(of_human(rows, i, world.humans()[i].name, color_of(world, i), human_time,
                             [](const HumanRow& r) { return r.world_from_body.position_m.y; }));
  return lines;
}

void draw_human_panels(sonar::Canvas& canvas, double width_px, double top_px,
                       const PhysicsHuman& human, std::size_t index,
                       const std::vector<HumanRow>& all_rows) {
  const OwnRows rows{all_rows, index};
  const std::string& name = human.name;
  std::size_t panel = 0;
  const auto next_box = [&] {
    const double left = panel % 2 == 0 ? 10.0 : 0.5 * width_px;
    const double right = panel % 2 == 0 ? 0.5 * width_px : width_px - 10.0;
    const double top = top_px + static_cast<double>(panel++ / 2) * kHumanPanel_px;
    return Box{left, top, right, top + kHumanPanel_px - 10.0};
  };
  const auto draw = [&](const std::string& title, const char* unit,
                        const std::vector<Series>& lines, double least_span = 1.0) {
    draw_over_time(canvas, next_box(), title, unit, lines, least_span, kHeadroom);
  };
  const auto line = [&](const char* what, std::size_t color, HumanValue value) {
    return over_time(rows, what, color, std::move(value));
  };
  draw_profile(canvas, next_box(), name, rows);
  draw("Rate of ascent of " + name, "m/min", rate_lines(human, rows));
  draw(fmt::format("Minutes that {} has (to {:g}) and needs", name, kLongest_min), "min",
       minute_lines(rows));
  if (human.body.tank_count > 0) draw("Tanks of " + name, "bar", tank_lines(human, rows), 5.0);
  draw("Speed over ground of " + name, "m/s",
       {line("", 0, [](const HumanRow& r) { return glm::length(r.velocity.linear()); })}, 0.2);
  draw("Kicks of " + name, "beats/s", {line("", 0, [](const HumanRow& r) { return r.kick_hz; })},
       0.2);
  draw("What the limbs of " + name + " give the water", "W",
       {line("", 0, [](const HumanRow& r) { return r.limb_power_w; })});
  draw("Gas that " + name + " breathes", "l/min",
       {line("ventilation", 0, [](const HumanRow& r) { return r.gas.ventilation_l_min; }),
        line("oxygen taken up", 1, [](const HumanRow& r) { return r.oxygen_l_min; })});
  draw("Heart and breath of " + name, "a minute",
       {line("heartbeats", 0, [](const HumanRow& r) { return r.vitals.heart_bpm; }),
        line("breaths", 1, [](const HumanRow& r) { return r.vitals.breath_bpm; })});
  draw("Gas within " + name + " and jacket", "litres",
       {line("lungs", 0, [](const HumanRow& r) { return 1e3 * r.lungs_m3; }),
        line("jacket", 1, [](const HumanRow& r) { return 1e3 * r.gas.jacket_m3; })});
  draw("Weight less lift of " + name, "N",
       {line("", 0, [](const HumanRow& r) { return r.net_weight_n; })});
  draw(fmt::format("Risk of {} ({})", name, diver::kRiskNote), "% of where it is raised",
       risk_lines(rows));
}

}  // namespace neritic::tools
