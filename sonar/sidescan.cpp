#include "sonar/sidescan.hpp"

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
#include "sonar/beam_grid.hpp"
#include "sonar/levels.hpp"

namespace neritic::sonar {
namespace {

constexpr double kNoGround = std::numeric_limits<double>::quiet_NaN();

// Leading edge of the bottom in bins from the first bin's beginning; NaN where there is none. The
// bin's filled part is its value over the next one's.
double bottom_bins(std::span<const float> line, const SidescanOptions& o) {
  const std::vector<float> profile = above_floor(line, o.floor_by_bin);
  float strongest = 0.0f;
  for (const float v : profile) strongest = std::max(strongest, v);
  if (!(strongest > o.floor)) return kNoGround;
  const double level = std::max(o.relative_threshold * percentile_of_heard(profile, 0.95), o.floor);
  const auto at =
      std::find_if(profile.begin(), profile.end(), [&](float v) { return v > 0.0f && v >= level; });
  if (at == profile.end()) return kNoGround;
  const double start = static_cast<double>(at - profile.begin());
  if (at + 1 == profile.end() || !(*(at + 1) > 0.0f)) return start + 0.5;
  return start + 1.0 - std::min(1.0, double{*at} / double{*(at + 1)});
}

// Median of those that are numbers, the lower of two; NaN for none.
double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return kNoGround;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// One side of one ping, nearest first at stride, onto ground bins.
void spread_side(const SidescanOptions& o, double altitude_m, const float* nearest,
                 std::ptrdiff_t stride, const GroundImage& out, float* first,
                 std::ptrdiff_t out_stride) {
  std::vector<double> sums(out.n_ground);
  const double bin_m = out.bin_m();
  const auto slant = [&](double ground_m) { return std::hypot(ground_m, altitude_m); };
  for (std::uint32_t i = 0; i < o.n_range; ++i) {
    const double r0 = o.range_min_m + i * o.range_step_m(), r1 = r0 + o.range_step_m();
    const double value = nearest[static_cast<std::ptrdiff_t>(i) * stride];
    if (r1 <= altitude_m || value == 0.0) continue;
    // The bin's part before the bottom is water: what it heard came from behind its edge.
    const double from = std::max(r0, altitude_m);
    const double g0 = std::sqrt(std::max(0.0, from * from - altitude_m * altitude_m)),
                 g1 = std::sqrt(std::max(0.0, r1 * r1 - altitude_m * altitude_m));
    const double last = std::min(std::ceil(g1 / bin_m), static_cast<double>(out.n_ground));
    for (auto k = static_cast<std::uint32_t>(std::min(g0 / bin_m, last)); k < last; ++k) {
      const double part = std::min(r1, slant((k + 1) * bin_m)) - std::max(from, slant(k * bin_m));
      if (part > 0.0) sums[k] += value * part / (r1 - from);
    }
  }
  for (std::uint32_t k = 0; k < out.n_ground; ++k)
    first[static_cast<std::ptrdiff_t>(k) * out_stride] = static_cast<float>(sums[k]);
}

nlohmann::json facts_of(const SidescanRecord& record, const GroundImage& ground) {
  const SidescanOptions& o = record.options();
  const std::vector<double> along = record.along_track_m();
  return {{"range_m", {o.range_min_m, o.range_max_m}},
          {"bins_a_side", o.n_range},
          {"pings", record.pings()},
          {"ground_bin_m", ground.bin_m()},
          {"ground_max_m", ground.ground_max_m},
          {"detection", {{"threshold", o.relative_threshold}, {"pings", o.tracking_pings}}},
          {"track_length_m", along.empty() ? 0.0 : along.back()},
          {"layout",
           "[ping, 2 n]: columns n-1 to 0 are port from the nearest bin on, n to 2n-1 starboard"},
          {"units",
           o.levels ? "power re 1 uPa^2 (10 log10 gives dB re 1 uPa); ground bins hold the sum of "
                      "what their slant bins heard"
                    : "linear energy a bin; ground bins hold what their slant bins heard"}};
}

}  // namespace

Status validate(const SidescanOptions& o) {
  if (o.n_range == 0 || o.n_range > kMaxBins)
    return refusal("side-scan", fmt::format("{} range bins", o.n_range),
                   fmt::format("1 to {}", kMaxBins));
  if (!(o.range_min_m >= 0.0 && o.range_max_m > o.range_min_m) || !std::isfinite(o.range_max_m))
    return refusal("side-scan",
                   fmt::format("a range from {} to {} m", o.range_min_m, o.range_max_m),
                   "from 0 or more, increasing");
  if (!(o.relative_threshold > 0.0 && o.relative_threshold <= 1.0))
    return refusal("side-scan", fmt::format("relative threshold {}", o.relative_threshold),
                   "above 0, at most 1");
  if (!(o.floor >= 0.0) || !std::isfinite(o.floor))
    return refusal("side-scan", fmt::format("floor {}", o.floor), "0 or more");
  if (!o.floor_by_bin.empty() && o.floor_by_bin.size() != o.n_range)
    return refusal("side-scan", fmt::format("a floor of {} bins", o.floor_by_bin.size()),
                   fmt::format("none, or {}", o.n_range));
  if (o.tracking_pings % 2 == 0)
    return refusal("side-scan", fmt::format("tracking over {} pings", o.tracking_pings),
                   "an odd number");
  return {};
}

SidescanRecord::SidescanRecord(const SidescanOptions& options) : options_(options) {
  const Status valid = validate(options);
  NERITIC_CHECK(valid.ok(), "{}", valid.error().message);
}

void SidescanRecord::append(std::span<const float> port, std::span<const float> starboard,
                            const Pose& world_from_sonar, double time_s) {
  NERITIC_CHECK(port.size() == options_.n_range && starboard.size() == options_.n_range,
                "{} and {} values for {} bins", port.size(), starboard.size(), options_.n_range);
  for (std::size_t i = port.size(); i-- > 0;) image_.push_back(heard(port[i]));
  for (const float v : starboard) image_.push_back(heard(v));
  poses_.push_back(world_from_sonar);
  times_s_.push_back(time_s);
}

std::vector<double> SidescanRecord::along_track_m() const {
  std::vector<double> out;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Vec3 step = i > 0 ? poses_[i].position_m - poses_[i - 1].position_m : Vec3(0.0);
    out.push_back((i > 0 ? out.back() : 0.0) + std::hypot(step.x, step.z));
  }
  return out;
}

std::vector<double> SidescanRecord::tracked_m(bool port) const {
  const std::size_t n_range = options_.n_range, n = pings();
  std::vector<double> found, out;
  for (std::size_t i = 0; i < n; ++i) {
    const auto side = slant_image().subspan((2 * i + (port ? 0 : 1)) * n_range, n_range);
    std::vector<float> nearest_first(side.begin(), side.end());
    if (port) std::reverse(nearest_first.begin(), nearest_first.end());
    found.push_back(options_.range_min_m +
                    options_.range_step_m() * bottom_bins(nearest_first, options_));
  }
  const std::size_t about = options_.tracking_pings / 2;
  for (std::size_t i = 0; i < n; ++i) {
    const auto from = found.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, about)),
               to = found.begin() + static_cast<std::ptrdiff_t>(std::min(n, i + about + 1));
    out.push_back(median({from, to}));
  }
  return out;
}

FirstReturns SidescanRecord::first_returns() const {
  return {tracked_m(true), tracked_m(false)};
}

std::vector<double> FirstReturns::altitude_m() const {
  std::vector<double> out;
  for (std::size_t i = 0; i < port_m.size(); ++i)
    out.push_back(std::fmin(port_m[i], starboard_m[i]));
  return out;
}

GroundImage ground_image(const SidescanRecord& record, const FirstReturns& bottom,
                         std::uint32_t n_ground) {
  NERITIC_CHECK(bottom.port_m.size() == record.pings() &&
                    bottom.starboard_m.size() == record.pings() && n_ground > 0,
                "{} and {} first returns for {} pings, {} bins", bottom.port_m.size(),
                bottom.starboard_m.size(), record.pings(), n_ground);
  const SidescanOptions& o = record.options();
  const std::vector<double> altitudes_m = bottom.altitude_m();
  GroundImage out{
      n_ground, o.range_max_m,
      std::vector<float>(record.pings() * 2 * n_ground, std::numeric_limits<float>::quiet_NaN())};
  for (std::size_t ping = 0; ping < record.pings(); ++ping) {
    // One altitude for both sides: a side's first return may be a hull that hides the bottom.
    const double altitude_m = altitudes_m[ping];
    if (std::isnan(altitude_m)) continue;
    const float* line = record.slant_image().data() + ping * 2 * o.n_range;
    float* to = out.intensity.data() + ping * 2 * n_ground;
    spread_side(o, altitude_m, line + o.n_range - 1, -1, out, to + n_ground - 1, -1);
    spread_side(o, altitude_m, line + o.n_range, 1, out, to + n_ground, 1);
  }
  return out;
}

Status write_sidescan(const std::filesystem::path& folder, const SidescanRecord& record,
                      const nlohmann::json& facts, const SidescanPictureOptions& picture) {
  NERITIC_TRY_STATUS(make_folder(folder));
  const std::size_t pings = record.pings(), n = record.options().n_range;
  const FirstReturns bottom = record.first_returns();
  const std::vector<double> altitude = bottom.altitude_m();
  const GroundImage ground = ground_image(record, bottom, record.options().n_range);
  NERITIC_TRY_STATUS(
      write_npy(folder / "sidescan_slant.npy", record.slant_image(), {pings, 2 * n}));
  NERITIC_TRY_STATUS(write_npy(folder / "sidescan_ground.npy",
                               std::span<const float>(ground.intensity), {pings, 2 * n}));
  NERITIC_TRY_STATUS(
      write_npy(folder / "sidescan_altitude.npy", std::span<const double>(altitude), {pings}));
  std::vector<double> sides, track;
  for (std::size_t i = 0; i < pings; ++i)
    sides.insert(sides.end(), {bottom.port_m[i], bottom.starboard_m[i]});
  NERITIC_TRY_STATUS(
      write_npy(folder / "sidescan_first_returns.npy", std::span<const double>(sides), {pings, 2}));
  for (const Pose& pose : record.poses())
    track.insert(track.end(), {pose.position_m.x, pose.position_m.y, pose.position_m.z});
  NERITIC_TRY_STATUS(
      write_npy(folder / "sidescan_track.npy", std::span<const double>(track), {pings, 3}));
  NERITIC_TRY_STATUS(
      scene::write_png8(folder / "sidescan_slant.png", draw_slant(record, bottom, picture)));
  NERITIC_TRY_STATUS(
      scene::write_png8(folder / "sidescan_ground.png", draw_ground(record, ground, picture)));
  nlohmann::json json = facts;
  json.update(facts_of(record, ground));
  return write_json(folder / "sidescan.json", json);
}

}  // namespace neritic::sonar
