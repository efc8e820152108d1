#include "tools/common/dive_plot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/scene/image_file.hpp"
#include "tools/common/human_plot.hpp"
#include "tools/common/plot_series.hpp"

namespace neritic::tools {
namespace {

constexpr std::uint32_t kWidth = 1600, kHeight = 1200;
constexpr double kMiddleX = 800.0, kMiddleY = 640.0;
// The ground's shading is of cells so wide.
constexpr int kCell_px = 3;
// The ground is darkest at the highest of what is seen, but not where that is lower than this.
constexpr double kLeastRelief_m = 2.0;

// One a thruster, eight that tell apart (Okabe and Ito 2008, darkened for lines on paper), then
// again, paler.
constexpr sonar::Color kThrusterColors[] = {
    {0.0f, 0.447f, 0.698f},   {0.835f, 0.369f, 0.0f}, {0.0f, 0.62f, 0.451f}, {0.8f, 0.475f, 0.655f},
    {0.337f, 0.706f, 0.914f}, {0.72f, 0.58f, 0.0f},   {0.35f, 0.35f, 0.35f}, {0.5f, 0.2f, 0.15f}};
constexpr sonar::Color kGround{0.62f, 0.53f, 0.38f};

using Value = std::function<double(const DiveRow&)>;

Series series_of(const std::vector<DiveRow>& rows, std::size_t vehicle, const std::string& name,
                 const sonar::Color& color, const Value& x, const Value& y) {
  return series_from<DiveRow>(
      rows, [vehicle](const DiveRow& row) { return row.vehicle == vehicle; }, name, color, x, y);
}

// Where the vehicle came to its waypoints, by their numbers.
Series arrivals_of(const std::vector<DiveRow>& rows, std::size_t vehicle, const Value& x,
                   const Value& y) {
  Series series{"waypoints", kInk, {}, {}};
  series.joined = false;
  std::uint64_t arrived = 0;
  for (const DiveRow& row : rows) {
    if (row.vehicle != vehicle || row.arrived == arrived) continue;
    arrived = row.arrived;
    series.x.push_back(x(row));
    series.y.push_back(y(row));
    series.notes.push_back(fmt::format("{}", arrived));
  }
  return series;
}

double time_of(const DiveRow& row) {
  return row.time_s;
}
double east_of(const DiveRow& row) {
  return row.world_from_body.position_m.x;
}
double north_of(const DiveRow& row) {
  return -row.world_from_body.position_m.z;
}

// One scale for both axes: metres are as long to the east as to the north.
void make_square(Axis& x, Axis& y, const Box& in) {
  const double metres_a_px =
      std::max((x.max - x.min) / (in.right - in.left), (y.max - y.min) / (in.bottom - in.top));
  const auto widen = [&](Axis& axis, double px) {
    const double middle = 0.5 * (axis.min + axis.max);
    axis.min = middle - 0.5 * px * metres_a_px;
    axis.max = middle + 0.5 * px * metres_a_px;
  };
  widen(x, in.right - in.left);
  widen(y, in.bottom - in.top);
}

// What is solid, seen from above: the higher, the darker.
void draw_ground(sonar::Canvas& canvas, const Box& in, const Axis& x, const Axis& y,
                 const sim::StaticWorld& solid) {
  constexpr double kAbove_m = 100.0, kFar_m = 12000.0;
  struct Cell {
    double left, top, height_m;
  };
  std::vector<Cell> cells;
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  for (double top = in.top; top < in.bottom; top += kCell_px)
    for (double left = in.left; left < in.right; left += kCell_px) {
      const double east = x.min + (left - in.left) / (in.right - in.left) * (x.max - x.min);
      const double north = y.min + (in.bottom - top) / (in.bottom - in.top) * (y.max - y.min);
      const auto hit = solid.cast({east, kAbove_m, -north}, {0.0, -1.0, 0.0}, kFar_m);
      if (!hit) continue;
      cells.push_back({left, top, kAbove_m - hit->distance_m});
      lowest_m = std::min(lowest_m, cells.back().height_m);
      highest_m = std::max(highest_m, cells.back().height_m);
    }
  const double relief_m = std::max(highest_m - lowest_m, kLeastRelief_m);
  for (const Cell& cell : cells) {
    const double dark = (cell.height_m - lowest_m) / relief_m;
    canvas.fill_rectangle(cell.left, cell.top, std::min(cell.left + kCell_px, in.right),
                          std::min(cell.top + kCell_px, in.bottom),
                          kInk.with_alpha(static_cast<float>(0.03 + 0.6 * dark)));
  }
}

// What drifts wants nothing.
bool is_steered(const PhysicsWorld& world) {
  return !world.vehicles().empty() && world.vehicles()[0].mission;
}

void draw_path(sonar::Canvas& canvas, const Box& box, const PhysicsWorld& world,
               const std::vector<DiveRow>& rows, const std::vector<HumanRow>& human_rows) {
  std::vector<Series> lines;
  for (std::size_t i = 0; i < world.vehicles().size(); ++i) {
    lines.push_back(series_of(rows, i, world.vehicles()[i].name,
                              kSeriesColors[i % std::size(kSeriesColors)], east_of, north_of));
  }
  for (Series& line : human_paths(world, human_rows)) lines.push_back(std::move(line));
  Axis x = roomy_axis("east, m", lines, &Series::x, 1.0);
  Axis y = roomy_axis("north, m", lines, &Series::y, 1.0);
  make_square(x, y, inside(box));
  draw_ground(canvas, inside(box), x, y, world.solid());
  if (world.vehicles().empty()) {
    draw_lines(canvas, box, "Path from above, over what is solid", x, y, lines);
    return;
  }
  if (is_steered(world))
    lines.insert(lines.begin(), series_of(
                                    rows, 0, "wanted", kSeriesColors[4],
                                    [](const DiveRow& r) { return r.wanted.position_m.x; },
                                    [](const DiveRow& r) { return -r.wanted.position_m.z; }));
  if (Series met = arrivals_of(rows, 0, east_of, north_of); !met.x.empty())
    lines.push_back(std::move(met));
  draw_lines(canvas, box, "Path from above, over what is solid (the higher, the darker)", x, y,
             lines);
}

double height_of(const DiveRow& row) {
  return row.world_from_body.position_m.y;
}

// What is solid straight below the vehicle; nothing where nothing is.
Series ground_line(const PhysicsWorld& world, const std::vector<DiveRow>& rows) {
  constexpr double kDeepest_m = 12000.0;
  Series line = series_of(rows, 0, "ground below", kGround, time_of, [&](const DiveRow& row) {
    const auto hit =
        world.solid().cast(row.world_from_body.position_m, {0.0, -1.0, 0.0}, kDeepest_m);
    return hit ? height_of(row) - hit->distance_m : std::numeric_limits<double>::quiet_NaN();
  });
  Series out{line.name, line.color, {}, {}};
  out.marked = false;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    if (std::isnan(line.y[i])) continue;
    out.x.push_back(line.x[i]);
    out.y.push_back(line.y[i]);
  }
  return out;
}

std::vector<Series> depth_lines(const PhysicsWorld& world, const std::vector<DiveRow>& rows,
                                const std::vector<HumanRow>& human_rows) {
  std::vector<Series> lines;
  if (is_steered(world))
    lines.push_back(series_of(rows, 0, "wanted", kSeriesColors[4], time_of,
                              [](const DiveRow& r) { return r.wanted.position_m.y; }));
  for (std::size_t i = 0; i < world.vehicles().size(); ++i)
    lines.push_back(series_of(rows, i, world.vehicles()[i].name,
                              kSeriesColors[i % std::size(kSeriesColors)], time_of, height_of));
  for (Series& line : human_heights(world, human_rows)) lines.push_back(std::move(line));
  if (world.vehicles().empty()) return lines;
  if (Series ground = ground_line(world, rows); !ground.x.empty())
    lines.push_back(std::move(ground));
  if (Series met = arrivals_of(rows, 0, time_of, height_of); !met.x.empty())
    lines.push_back(std::move(met));
  return lines;
}

std::vector<Series> thrust_lines(const PhysicsWorld& world, const std::vector<DiveRow>& rows) {
  std::vector<Series> lines;
  for (std::size_t i = 0; i < world.vehicles()[0].vehicle.thruster_count; ++i)
    lines.push_back(series_of(rows, 0, fmt::format("{}", i + 1),
                              kThrusterColors[i % std::size(kThrusterColors)].with_alpha(
                                  i < std::size(kThrusterColors) ? 1.0f : 0.5f),
                              time_of, [i](const DiveRow& r) { return r.force_n[i]; }));
  return lines;
}

std::vector<Series> error_lines(const PhysicsWorld& world, const std::vector<DiveRow>& rows) {
  std::vector<Series> lines{
      series_of(rows, 0, "speed, m/s", kSeriesColors[0], time_of,
                [](const DiveRow& r) { return glm::length(r.velocity.linear()); })};
  if (is_steered(world))
    lines.push_back(
        series_of(rows, 0, "off the setpoint, m", kSeriesColors[1], time_of, [](const DiveRow& r) {
          return glm::distance(r.world_from_body.position_m, r.wanted.position_m);
        }));
  return lines;
}

}  // namespace

Axis roomy_axis(const std::string& label, const std::vector<Series>& all,
                const std::vector<double> Series::*values, double least_span) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Series& s : all)
    for (const double v : s.*values)
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (low > high) low = high = 0.0;
  const double middle = 0.5 * (low + high), span = std::max(1.15 * (high - low), least_span);
  return {label, middle - 0.5 * span, middle + 0.5 * span};
}

void draw_over_time(sonar::Canvas& canvas, const Box& box, const std::string& title,
                    const std::string& label, const std::vector<Series>& lines, double least_span,
                    double headroom) {
  const Axis x = roomy_axis("time, s", lines, &Series::x, 1e-3);
  Axis y = roomy_axis(label, lines, &Series::y, least_span);
  y.max += headroom * (y.max - y.min);
  draw_lines(canvas, box, title, x, y, lines);
}

Status write_dive_plot(const std::filesystem::path& path, const PhysicsWorld& world,
                       const std::vector<DiveRow>& rows, const std::vector<HumanRow>& human_rows) {
  const bool vehicles = !world.vehicles().empty();
  const auto humans = static_cast<double>(world.humans().size());
  const double high = vehicles ? kHeight : kMiddleY;
  sonar::Canvas canvas(kWidth, static_cast<std::uint32_t>(high + humans * kHumanPanels_px), kPaper);
  draw_path(canvas, {10, 10, kMiddleX, kMiddleY}, world, rows, human_rows);
  draw_over_time(canvas, {kMiddleX, 10, kWidth - 10.0, kMiddleY},
                 "Height over the surface, and the ground below", "m",
                 depth_lines(world, rows, human_rows), 0.5);
  if (vehicles) {
    const std::string& first = world.vehicles()[0].name;
    draw_over_time(canvas, {10, kMiddleY, kMiddleX, kHeight - 10.0},
                   "Thrust of " + first + "'s thrusters", "N", thrust_lines(world, rows), 1.0);
    draw_over_time(canvas, {kMiddleX, kMiddleY, kWidth - 10.0, kHeight - 10.0},
                   "Error and speed of " + first, "m, m/s", error_lines(world, rows), 0.05);
  }
  for (std::size_t i = 0; i < world.humans().size(); ++i)
    draw_human_panels(canvas, kWidth, high + static_cast<double>(i) * kHumanPanels_px,
                      world.humans()[i], i, human_rows);
  return scene::write_png8(path, canvas.take());
}

}  // namespace neritic::tools
