// Currents from a grid: the file, and linear interpolation along time, y, z and x.
#include "engine/sim/current_grid.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::sim {
namespace {

// Where a coordinate lies between two samples of its axis.
struct GridPlace {
  std::size_t first = 0, second = 0;
  double share = 0.0;           // of the second
  double slope_per_unit = 0.0;  // d share / d coordinate; 0 outside the axis
};

GridPlace place_on_axis(double coordinate, double origin, double spacing, std::uint32_t count) {
  const double at = (coordinate - origin) / spacing;
  const double last = count - 1.0;
  if (!(at > 0.0)) return {};
  if (at >= last) return {count - 1, count - 1};
  const auto first = static_cast<std::size_t>(at);
  return {first, first + 1, at - static_cast<double>(first), 1.0 / spacing};
}

Vec3 velocity_at(const GridCurrent& current, const std::array<std::size_t, 4>& index) {
  std::size_t flat = 0;
  for (std::size_t axis = 0; axis < 4; ++axis) flat = flat * current.counts[axis] + index[axis];
  const float* v = current.velocities_m_s.data() + flat * 3;
  return Vec3(v[0], v[1], v[2]);
}

std::size_t sample_count(const GridCurrent& current) {
  std::size_t samples = 1;
  for (const std::uint32_t count : current.counts) samples *= count;
  return samples;
}

}  // namespace

Status check_grid(const GridCurrent& current) {
  const CurrentGridAxes& axes = current.axes;
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(axes.spacing_m[axis]) || axes.spacing_m[axis] == 0.0)
      return refusal("spacing_m", fmt::format("{}", axes.spacing_m[axis]), "numbers other than 0");
  if (!is_finite(axes.origin_m))
    return refusal("origin_m",
                   fmt::format("({}, {}, {})", axes.origin_m.x, axes.origin_m.y, axes.origin_m.z),
                   "finite numbers");
  if (!std::isfinite(axes.interval_s) || axes.interval_s <= 0.0)
    return refusal("interval_s", fmt::format("{}", axes.interval_s), "above 0");
  if (!std::isfinite(axes.start_s))
    return refusal("start_s", fmt::format("{}", axes.start_s), "finite numbers");
  if (sample_count(current) == 0 || current.velocities_m_s.size() != sample_count(current) * 3)
    return refusal("",
                   fmt::format("{} numbers for {} samples", current.velocities_m_s.size(),
                               sample_count(current)),
                   "3 each, 1 sample or more");
  for (std::size_t i = 0; i < current.velocities_m_s.size(); ++i)
    if (!(std::abs(current.velocities_m_s[i]) <= kMaxCurrent_m_s))
      return refusal(fmt::format("sample {}", i / 3),
                     fmt::format("{} m/s", current.velocities_m_s[i]),
                     fmt::format("up to {} m/s", kMaxCurrent_m_s));
  return {};
}

CurrentSample sample_grid(const GridCurrent& current, const Vec3& position_m, double time_s) {
  const CurrentGridAxes& axes = current.axes;
  const std::array<GridPlace, 4> places{
      place_on_axis(time_s, axes.start_s, axes.interval_s, current.counts[0]),
      place_on_axis(position_m.y, axes.origin_m.y, axes.spacing_m.y, current.counts[1]),
      place_on_axis(position_m.z, axes.origin_m.z, axes.spacing_m.z, current.counts[2]),
      place_on_axis(position_m.x, axes.origin_m.x, axes.spacing_m.x, current.counts[3])};
  CurrentSample sample;
  // The 16 samples around, each with the product of its shares; the derivative along an axis has
  // that axis' share replaced by its slope.
  for (unsigned corner = 0; corner < 16; ++corner) {
    std::array<std::size_t, 4> index{};
    std::array<double, 4> share{}, slope{};
    for (unsigned axis = 0; axis < 4; ++axis) {
      const bool second = (corner >> axis & 1u) != 0;
      const GridPlace& place = places[axis];
      index[axis] = second ? place.second : place.first;
      share[axis] = second ? place.share : 1.0 - place.share;
      slope[axis] = second ? place.slope_per_unit : -place.slope_per_unit;
    }
    const auto product = [&](unsigned sloped) {
      double weight = 1.0;
      for (unsigned axis = 0; axis < 4; ++axis)
        weight *= axis == sloped ? slope[axis] : share[axis];
      return weight;
    };
    const Vec3 velocity_m_s = velocity_at(current, index);
    constexpr unsigned kNoAxis = 4;
    sample.velocity_m_s += velocity_m_s * product(kNoAxis);
    sample.rate_m_s2 += velocity_m_s * product(0);
    sample.gradient_per_s[1] += velocity_m_s * product(1);
    sample.gradient_per_s[2] += velocity_m_s * product(2);
    sample.gradient_per_s[0] += velocity_m_s * product(3);
  }
  return sample;
}

Result<GridCurrent> parse_grid_current(std::span<const std::byte> bytes, const std::string& name,
                                       const CurrentGridAxes& axes) {
  NERITIC_TRY(const NpyArray array, parse_npy(bytes, name));
  const bool steady = array.shape.size() == 4;
  if ((!steady && array.shape.size() != 5) || array.shape.back() != 3)
    return refusal(name, fmt::format("shape ({})", fmt::join(array.shape, ", ")),
                   "[time, y, z, x, 3] or [y, z, x, 3]");
  GridCurrent current;
  current.axes = axes;
  for (std::size_t i = 0; i + 1 < array.shape.size(); ++i) {
    const std::size_t extent = array.shape[i];
    if (extent == 0 || extent > kMaxFileBytes)
      return refusal(name, fmt::format("{} samples along axis {}", extent, i), "1 or more");
    current.counts[i + (steady ? 1 : 0)] = static_cast<std::uint32_t>(extent);
  }
  const std::vector<double> values = array.to_doubles();
  current.velocities_m_s.assign(values.begin(), values.end());
  if (const Status checked = check_grid(current); !checked.ok())
    return bad_input("{}: {}", name, checked.error().message);
  return current;
}

Result<GridCurrent> read_grid_current(const std::filesystem::path& path,
                                      const CurrentGridAxes& axes) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return parse_grid_current(bytes, path.string(), axes);
}

}  // namespace neritic::sim
