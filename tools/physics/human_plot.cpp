#include "tools/physics/human_plot.hpp"

#include <algorithm>
#include <cmath>

#include "diver/gas_label.hpp"

namespace neritic::tools {
namespace {

constexpr double kHeadroom = 0.25;
// Beside ventilation and time.
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

Series first_over_time(const std::vector<HumanRow>& rows, const std::string& name,
                       std::size_t color, const HumanValue& y) {
  return of_human(rows, 0, name, color, human_time, y);
}

// Vehicles have the first colours.
std::size_t color_of(const PhysicsWorld& world, std::size_t human) {
  return world.vehicles().size() + human;
}

std::string tank_name(const PhysicsHuman& human, std::size_t tank) {
  if (human.body.tank_count == 1) return "tank, bar";
  return fmt::format("tank {}, {}, bar", tank + 1, diver::name_of(human.body.tanks[tank].mix));
}

// Each tank's pressure, and a dot where the diver changes to it.
std::vector<Series> gas_lines(const PhysicsHuman& human, const std::vector<HumanRow>& rows) {
  std::vector<Series> lines{
      first_over_time(rows, "ventilation, l/min", 1,
                      [](const HumanRow& r) { return r.gas.ventilation_l_min; }),
      first_over_time(rows, "left to 50 bar, min", 2,
                      [](const HumanRow& r) { return std::min(r.gas.remaining_s / 60.0, 300.0); })};
  Series changes{"changes tank", kInk, {}, {}};
  changes.joined = false;
  const HumanRow* before = nullptr;
  for (const HumanRow& row : rows) {
    if (row.human != 0) continue;
    if (before != nullptr && row.tank != before->tank && row.tank < human.body.tank_count) {
      changes.x.push_back(row.time_s);
      changes.y.push_back(1e-5 * row.tank_pa[row.tank]);
    }
    before = &row;
  }
  for (std::size_t tank = 0; tank < human.body.tank_count; ++tank) {
    lines.push_back(first_over_time(rows, tank_name(human, tank), 0,
                                    [tank](const HumanRow& r) { return 1e-5 * r.tank_pa[tank]; }));
    lines.back().color = kTankColors[tank];
  }
  if (!changes.x.empty()) lines.push_back(changes);
  return lines;
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
                       const PhysicsWorld& world, const std::vector<HumanRow>& rows) {
  const std::string& name = world.humans()[0].name;
  const double middle_x = 0.5 * width_px, row_px = kHumanPanels_px / 3.0;
  const double middle_y = top_px + row_px, last_y = top_px + 2.0 * row_px;
  const double bottom = top_px + kHumanPanels_px - 10.0;
  draw_over_time(
      canvas, {10, top_px, middle_x, middle_y}, "Pace of " + name, "m/s, beats/s",
      {first_over_time(rows, "speed, m/s", 0,
                       [](const HumanRow& r) { return glm::length(r.velocity.linear()); }),
       first_over_time(rows, "kick, beats/s", 1, [](const HumanRow& r) { return r.kick_hz; })},
      0.2, kHeadroom);
  draw_over_time(canvas, {middle_x, top_px, width_px - 10.0, middle_y}, "Gas of " + name,
                 "bar, l/min, min", gas_lines(world.humans()[0], rows), 5.0, kHeadroom);
  draw_over_time(
      canvas, {10, middle_y, middle_x, last_y}, "Decompression of " + name, "m, min, m/min",
      {first_over_time(
           rows, "no-stop time, min", 0,
           [](const HumanRow& r) { return std::min(r.ascent.view.no_stop_min, 300.0); }),
       first_over_time(rows, "ceiling, m", 1,
                       [](const HumanRow& r) { return r.ascent.view.ceiling_m; }),
       first_over_time(
           rows, "to the surface, min", 2,
           [](const HumanRow& r) { return std::min(r.ascent.view.to_surface_min, 300.0); }),
       first_over_time(rows, "ascent, m/min", 3,
                       [](const HumanRow& r) { return r.ascent.view.ascent_m_min; })},
      1.0, kHeadroom);
  draw_over_time(
      canvas, {middle_x, middle_y, width_px - 10.0, last_y}, "Lungs, jacket and balance of " + name,
      "litres, N",
      {first_over_time(rows, "lungs, l", 0, [](const HumanRow& r) { return 1e3 * r.lungs_m3; }),
       first_over_time(rows, "jacket, l", 1,
                       [](const HumanRow& r) { return 1e3 * r.gas.jacket_m3; }),
       first_over_time(rows, "weight less lift, N", 2,
                       [](const HumanRow& r) { return r.net_weight_n; })},
      1.0, kHeadroom);
  draw_over_time(canvas, {10, last_y, middle_x, bottom}, "Heart and breath of " + name, "a minute",
                 {first_over_time(rows, "heart, beats/min", 0,
                                  [](const HumanRow& r) { return r.vitals.heart_bpm; }),
                  first_over_time(rows, "breaths/min", 1,
                                  [](const HumanRow& r) { return r.vitals.breath_bpm; }),
                  first_over_time(rows, "oxygen, dl/min", 2,
                                  [](const HumanRow& r) { return 10.0 * r.oxygen_l_min; })},
                 1.0, kHeadroom);
  draw_over_time(canvas, {middle_x, last_y, width_px - 10.0, bottom},
                 fmt::format("Risk of {} ({})", name, diver::kRiskNote), "mmHg, m, g/l",
                 {first_over_time(rows, "CO2 proxy, mmHg", 0,
                                  [](const HumanRow& r) { return r.vitals.risk.co2_mmhg; }),
                  first_over_time(rows, "narcotic depth, m", 1,
                                  [](const HumanRow& r) { return r.vitals.risk.narcotic_depth_m; }),
                  first_over_time(rows, "gas density, g/l", 2,
                                  [](const HumanRow& r) { return r.ascent.view.density_g_l; })},
                 1.0, kHeadroom);
}

}  // namespace neritic::tools
