#include "sonar/mechanical_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/image_file.hpp"
#include "sonar/levels.hpp"
#include "sonar/panel.hpp"

namespace neritic::sonar {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kMaxMosaicCells = 1 << 26;

struct Turn {
  double from_rad, to_rad;
};
// The sector that the head swept, beams included, its middle within half a turn of ahead; at most a
// full turn, which begins so that the first heading is a beam's middle.
Turn swept(const MechanicalScan& scan) {
  const auto& steps = scan.steps();
  if (steps.empty()) return {-kPi, kPi};
  double at = steps[0].heading_rad, low = at, high = at;
  for (const ScanStep& step : steps) {
    at += std::remainder(step.heading_rad - at, 2.0 * kPi);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  const double beam = scan.options().beam_rad;
  if (high - low + beam >= 2.0 * kPi - beam / 2.0) {
    const double column = 2.0 * kPi / std::round(2.0 * kPi / beam);
    const double from = -kPi + std::remainder(steps[0].heading_rad + kPi - column / 2.0, column);
    return {from, from + 2.0 * kPi};
  }
  const double middle = std::remainder((low + high) / 2.0, 2.0 * kPi);
  return {middle - (high - low + beam) / 2.0, middle + (high - low + beam) / 2.0};
}

// A step's beam seen from above.
struct PlanBeam {
  Vec2 origin_m;       // x, z
  double bearing_rad;  // clockwise from north (-z)
  double shrink;       // metres in the plane a metre of range
};
PlanBeam plan_beam(const ScanStep& step) {
  const Vec3 d = step.world_from_sonar.rotation * direction(step.heading_rad, 0.0);
  return {{step.world_from_sonar.position_m.x, step.world_from_sonar.position_m.z},
          std::atan2(d.x, -d.z),
          std::hypot(d.x, d.z)};
}

struct Box {
  Vec2 low{std::numeric_limits<double>::infinity()}, high{-low};
  void add(const Vec2& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};
// Bounds of the area that a beam paints: its edges, and the arc's extremes if it crosses an axis.
Box box_of(const PlanBeam& beam, const MechanicalScanOptions& o) {
  Box box;
  const auto at = [&](double bearing, double range_m) {
    const double r = range_m * beam.shrink;
    box.add(beam.origin_m + Vec2(r * std::sin(bearing), -r * std::cos(bearing)));
  };
  const double half = o.beam_rad / 2.0;
  for (const double r : {o.range_min_m, o.range_max_m}) {
    at(beam.bearing_rad - half, r);
    at(beam.bearing_rad + half, r);
    for (int quarter = -4; quarter <= 4; ++quarter)
      if (std::abs(quarter * kPi / 2.0 - beam.bearing_rad) < half) at(quarter * kPi / 2.0, r);
  }
  return box;
}

// Sums of one step over the cells whose centres its beam covers.
void paint(const MechanicalScan& scan, std::size_t step, const PlanBeam& beam,
           const ScanMosaic& map, std::vector<double>& sums, std::vector<std::uint32_t>& counts) {
  const MechanicalScanOptions& o = scan.options();
  const Box box = box_of(beam, o);
  const auto profile = scan.profile(step);
  const auto index = [&](double metres, std::int64_t first, std::uint32_t end) {
    return static_cast<std::uint32_t>(
        std::clamp(std::floor(metres / map.cell_m) - static_cast<double>(first), 0.0, end - 1.0));
  };
  // A beam's box grows by a cell, since a beam is a cell wide at least.
  const auto right = index(box.high.x + map.cell_m, map.first_column, map.columns),
             bottom = index(box.high.y + map.cell_m, map.first_row, map.rows);
  // The beam's axis; a cell lies in the wedge where it is within half a beam of it.
  const Vec2 axis(std::sin(beam.bearing_rad), -std::cos(beam.bearing_rad));
  const double half = o.beam_rad / 2.0;
  for (auto row = index(box.low.y - map.cell_m, map.first_row, map.rows); row <= bottom; ++row)
    for (auto column = index(box.low.x - map.cell_m, map.first_column, map.columns);
         column <= right; ++column) {
      const Vec2 p = Vec2(static_cast<double>(map.first_column) + column + 0.5,
                          static_cast<double>(map.first_row) + row + 0.5) *
                         map.cell_m -
                     beam.origin_m;
      const double along = glm::dot(p, axis), across = p.x * axis.y - p.y * axis.x;
      // Near the sonar a beam is narrower than a cell: it paints one cell's width at least.
      const bool covers = std::abs(std::atan2(across, along)) <= half ||
                          (along > 0.0 && std::abs(across) <= map.cell_m / 2.0);
      if (!covers) continue;
      const auto bin =
          bin_index(glm::length(p) / beam.shrink, o.range_min_m, o.range_max_m, o.n_range);
      if (!bin) continue;
      const std::size_t at = std::size_t{row} * map.columns + column;
      sums[at] += profile[*bin];
      ++counts[at];
    }
}

std::string csv_of(const MechanicalScan& scan) {
  std::string csv = "step,time_s,heading_deg,x_m,y_m,z_m,qw,qx,qy,qz\n";
  for (std::size_t i = 0; i < scan.steps().size(); ++i) {
    const ScanStep& s = scan.steps()[i];
    const Vec3& p = s.world_from_sonar.position_m;
    const Quat& q = s.world_from_sonar.rotation;
    csv += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", i,
                       s.time_s, degrees(s.heading_rad), p.x, p.y, p.z, q.w, q.x, q.y, q.z);
  }
  return csv;
}

}  // namespace

Status validate(const MechanicalScanOptions& o) {
  if (o.n_range == 0 || o.n_range > kMaxBins)
    return refusal("mechanical scan", fmt::format("{} range bins", o.n_range),
                   fmt::format("1 to {}", kMaxBins));
  if (!(o.range_min_m >= 0.0 && o.range_max_m > o.range_min_m) || !std::isfinite(o.range_max_m))
    return refusal("mechanical scan",
                   fmt::format("a range from {} to {} m", o.range_min_m, o.range_max_m),
                   "from 0 or more, increasing");
  if (!(o.beam_rad >= 2.0 * kPi / kMaxBins && o.beam_rad <= kPi))
    return refusal("mechanical scan", fmt::format("a beam of {} degrees", degrees(o.beam_rad)),
                   fmt::format("{:.3g} to 180", 360.0 / kMaxBins));
  if (!(o.elevation_rad > 0.0 && o.elevation_rad <= kMaxElevation_rad))
    return refusal("mechanical scan",
                   fmt::format("a beam of {} degrees in elevation", degrees(o.elevation_rad)),
                   fmt::format("above 0, at most {}", degrees(kMaxElevation_rad)));
  return {};
}

MechanicalScan::MechanicalScan(const MechanicalScanOptions& options) : options_(options) {
  const Status valid = validate(options);
  NERITIC_CHECK(valid.ok(), "{}", valid.error().message);
}

void MechanicalScan::append(std::span<const float> intensity, const ScanStep& step) {
  NERITIC_CHECK(intensity.size() == options_.n_range, "{} values for {} bins", intensity.size(),
                options_.n_range);
  for (const float v : intensity) profiles_.push_back(heard(v));
  steps_.push_back(step);
}

std::vector<float> MechanicalScan::sector_image() const {
  std::vector<float> out(profiles_.size());
  for (std::size_t s = 0; s < steps_.size(); ++s)
    for (std::size_t r = 0; r < options_.n_range; ++r)
      out[r * steps_.size() + s] = profiles_[s * options_.n_range + r];
  return out;
}

DeviceImage device_image(const MechanicalScan& scan) {
  const MechanicalScanOptions& o = scan.options();
  const Turn turn = swept(scan);
  const auto columns = static_cast<std::uint32_t>(
      std::clamp(std::round((turn.to_rad - turn.from_rad) / o.beam_rad), 1.0, double{kMaxBins}));
  DeviceImage out;
  out.grid.limits = {.range_min_m = o.range_min_m,
                     .range_max_m = o.range_max_m,
                     .azimuth_min_rad = turn.from_rad,
                     .azimuth_max_rad = turn.to_rad,
                     .elevation_min_rad = -o.elevation_rad / 2.0,
                     .elevation_max_rad = o.elevation_rad / 2.0};
  out.grid.bins = {o.n_range, columns, o.bins_elevation};
  const std::size_t cells = std::size_t{o.n_range} * columns;
  out.image = {o.n_range, columns, std::vector<float>(cells), std::vector<std::uint16_t>(cells)};
  const double width = (turn.to_rad - turn.from_rad) / columns,
               middle = (turn.from_rad + turn.to_rad) / 2.0;
  const bool full_turn = turn.to_rad - turn.from_rad > 2.0 * kPi - 1e-9;
  for (std::size_t s = 0; s < scan.steps().size(); ++s) {
    const double heading = middle + std::remainder(scan.steps()[s].heading_rad - middle, 2.0 * kPi);
    // Columns whose middles the beam reaches; headings on a grid reach theirs despite rounding.
    const double at = (heading - turn.from_rad) / width - 0.5, half = o.beam_rad / width / 2.0;
    const double first = std::min(std::ceil(at - half + 1e-6), std::round(at)),
                 last = std::max(std::floor(at + half - 1e-6), std::round(at));
    for (double column = first; column <= last; ++column) {
      if (!full_turn && (column < 0.0 || column >= columns)) continue;
      const auto c = static_cast<std::uint32_t>(column - columns * std::floor(column / columns));
      for (std::size_t r = 0; r < o.n_range; ++r)
        out.image.intensity[r * columns + c] = scan.profile(s)[r];
    }
  }
  return out;
}

Result<ScanMosaic> scan_mosaic(const MechanicalScan& scan, double cell_m) {
  if (!(cell_m > 0.0) || !std::isfinite(cell_m))
    return refusal("scan mosaic", fmt::format("cells of {} m", cell_m), "above 0");
  ScanMosaic out;
  out.cell_m = cell_m;
  if (scan.steps().empty()) return out;
  std::vector<PlanBeam> beams;
  Box all;
  for (const ScanStep& step : scan.steps()) {
    beams.push_back(plan_beam(step));
    const Box box = box_of(beams.back(), scan.options());
    all.add(box.low);
    all.add(box.high);
    const Vec3& at = step.world_from_sonar.position_m;
    all.add(Vec2(at.x, at.z));
  }
  const Vec2 first = glm::floor(all.low / cell_m), last = glm::floor(all.high / cell_m);
  const Vec2 size = last - first + 1.0;
  if (!(size.x * size.y <= kMaxMosaicCells && std::abs(first.x) < 1e15 && std::abs(first.y) < 1e15))
    return refusal("scan mosaic", fmt::format("{} x {} cells of {} m", size.y, size.x, cell_m),
                   fmt::format("at most {} in all", kMaxMosaicCells));
  out.first_column = static_cast<std::int64_t>(first.x);
  out.first_row = static_cast<std::int64_t>(first.y);
  out.columns = static_cast<std::uint32_t>(size.x);
  out.rows = static_cast<std::uint32_t>(size.y);
  const std::size_t cells = std::size_t{out.rows} * out.columns;
  std::vector<double> sums(cells);
  std::vector<std::uint32_t> counts(cells);
  for (std::size_t s = 0; s < beams.size(); ++s)
    // A beam straight up or down has no place on the map.
    if (beams[s].shrink > 1e-6) paint(scan, s, beams[s], out, sums, counts);
  out.intensity.assign(cells, kNone);
  for (std::size_t i = 0; i < cells; ++i)
    if (counts[i] > 0) out.intensity[i] = static_cast<float>(sums[i] / counts[i]);
  return out;
}

Status write_mechanical_scan(const std::filesystem::path& folder, const MechanicalScan& scan,
                             double cell_m, const nlohmann::json& facts) {
  NERITIC_TRY(const ScanMosaic mosaic, scan_mosaic(scan, cell_m));
  NERITIC_TRY_STATUS(make_folder(folder));
  const MechanicalScanOptions& o = scan.options();
  NERITIC_TRY_STATUS(write_npy(folder / "mechanical.npy",
                               std::span<const float>(scan.sector_image()),
                               {std::size_t{o.n_range}, scan.steps().size()}));
  NERITIC_TRY_STATUS(write_text(folder / "mechanical_steps.csv", csv_of(scan)));
  const DeviceImage device = device_image(scan);
  NERITIC_TRY_STATUS(scene::write_png8(
      folder / "mechanical.png", draw_panel(device.grid, device.image,
                                            {.title = "SCANNING SONAR   AS THE DEVICE SHOWS IT",
                                             .span_db = o.levels ? kScanShown_db : 0.0})));
  NERITIC_TRY_STATUS(write_npy(folder / "mechanical_world.npy",
                               std::span<const float>(mosaic.intensity),
                               {std::size_t{mosaic.rows}, std::size_t{mosaic.columns}}));
  NERITIC_TRY_STATUS(scene::write_png8(folder / "mechanical_world.png", draw_mosaic(scan, mosaic)));
  nlohmann::json json = facts;
  json["range_m"] = {o.range_min_m, o.range_max_m};
  json["bins"] = o.n_range;
  json["steps"] = scan.steps().size();
  json["beam_deg"] = degrees(o.beam_rad);
  json["layout"] = "mechanical.npy [range, step]: row 0 nearest, column 0 the first step";
  json["world"] = {
      {"cell_m", mosaic.cell_m},
      {"west_m", static_cast<double>(mosaic.first_column) * mosaic.cell_m},
      {"north_m", static_cast<double>(mosaic.first_row) * mosaic.cell_m},
      {"layout", "mechanical_world.npy [row, column]: row 0 north (-z); NaN: no beam"}};
  return write_json(folder / "mechanical.json", json);
}

}  // namespace neritic::sonar
