// Water that moves: the current at a point and time, with its gradient and rate of change. World
// frame: Y up, metres, still water at y = 0. Plain values, pure functions; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::sim {

// Faster water than this is an error of the input: the strongest tidal streams reach 10 m/s.
inline constexpr double kMaxCurrent_m_s = 100.0;

struct CurrentSample {
  Vec3 velocity_m_s{0.0};
  Mat3 gradient_per_s{0.0};  // column j: d velocity / d x_j
  Vec3 rate_m_s2{0.0};       // d velocity / d time, at the point
};

// "uniform": everywhere and always the same.
struct UniformCurrent {
  Vec3 velocity_m_s{0.0};
};

// "power_law": a tidal stream over the bed, v(y) = v_0 ((d + y) / d)^alpha from the bed (y = -d) to
// the surface; 0 below, v_0 above (DNV-RP-C205, 2010, 4.1.4.2, alpha 1/7). The gradient grows
// without bound towards the bed: within a thousandth of the depth it is that of the secant to the
// bed.
struct PowerLawCurrent {
  Vec3 surface_velocity_m_s{0.0};
  double depth_m = 50.0;
  double exponent = 1.0 / 7.0;
};

// "linear": from the surface down to a depth, and constant below (DNV-RP-C205, 2010, 4.1.4.3, has 0
// there: a drift that the wind drives).
struct LinearCurrent {
  Vec3 surface_velocity_m_s{0.0}, deep_velocity_m_s{0.0};
  double depth_m = 50.0;
};

// "grid": samples at equal distances, linear between them in x, y, z and time; outside, that of the
// nearest point of the grid's box and span of time.
struct CurrentGridAxes {
  Vec3 origin_m{0.0};   // of the first sample
  Vec3 spacing_m{1.0};  // between neighbours; negative where indices run against the axis
  double start_s = 0.0, interval_s = 1.0;
};
struct GridCurrent {
  CurrentGridAxes axes;
  // Samples along time, y, z, x: in the order of the array, each at least 1.
  std::array<std::uint32_t, 4> counts{1, 1, 1, 1};
  std::vector<float> velocities_m_s;  // [time][y][z][x][3], world axes
};

using Current = std::variant<UniformCurrent, PowerLawCurrent, LinearCurrent, GridCurrent>;
std::string_view name_of(const Current& current);

// Errors name the value, what was found and what is accepted.
Status check_current(const Current& current);

// Precondition: check_current is ok, position and time are finite.
CurrentSample sample(const Current& current, const Vec3& position_m, double time_s);

// .npy of numbers, [time, y, z, x, 3] or, steady, [y, z, x, 3].
Result<GridCurrent> read_grid_current(const std::filesystem::path& path,
                                      const CurrentGridAxes& axes);
// The same from bytes in memory; name stands in messages.
Result<GridCurrent> parse_grid_current(std::span<const std::byte> bytes, const std::string& name,
                                       const CurrentGridAxes& axes);

}  // namespace neritic::sim
