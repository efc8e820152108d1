// The beam patterns that a sonar's settings name, for its head's tables. Pure functions; any
// thread.
#pragma once

#include <optional>

#include "engine/scene/scene.hpp"
#include "sonar/beam_grid.hpp"
#include "sonar/beam_pattern.hpp"

namespace neritic::sonar {

// Sound speed that turns time to range: the settings', or Mackenzie's at depth_m unless they name
// one.
double sound_speed_of(const scene::SonarWater& water, double depth_m);

struct HeadPatterns {
  std::optional<BeamPattern> azimuth, elevation;
  bool azimuth_two_way = false;  // sends and receives through it
  bool flat = false;             // beams are steered by phase on a flat array
  bool cone = false;             // an echo sounder's: elevation (else azimuth) about the axis
  double cone_rad = 0.0;         // its semi-angle, or as far as its pattern is gathered
  // The pattern over elevation, of a cone over all angles off its axis.
  const std::optional<BeamPattern>& upright() const {
    return cone && !elevation ? azimuth : elevation;
  }

  // Amplitude of a scatterer so far off the axis of the beam at azimuth axis_rad; 1 without a
  // pattern. Signed.
  double across(double off_rad, double axis_rad = 0.0) const;
  // The same of a column of that width: the root of the mean power over it, where the pattern is
  // narrow beside it; else that of its middle.
  double across_column(double off_rad, double axis_rad, double column_rad) const;
  // Power there and back of a direction of the gathered grid.
  double power(double azimuth_rad, double elevation_rad) const;
  // The mean over a cell of the grid, where the pattern is narrow beside it.
  double power_of_cell(const BeamGrid& grid, std::uint32_t column, std::uint32_t row) const;
};
// kBadInput names what is wrong with a pattern.
Result<HeadPatterns> head_patterns(const scene::Sonar& sonar);

// Where rows beyond the aperture, which a pattern is heard in, would make more than this, all rows
// grow instead: what is heard there is never cut off, and nobody pays for more rows than these,
// those asked for, or those that small targets need.
inline constexpr std::uint32_t kMostWidenedRows = 1536;

// Half of the elevations (of a cone: of all angles) that a head hears whose aperture's half is
// half_rad: as far as its pattern's second null, a pinhole and a few apertures go.
double heard_half_rad(double half_rad, const HeadPatterns& patterns);

// A cell of columns and rows that the smallest target of a sonar whose level was chosen does not
// slip through (scene::least_target_m), or as fine as a ping may cost; 0: no target asks for one.
double target_cell_rad(const scene::Sonar& sonar, const HeadPatterns& patterns);

// The share of a cell of the grid within the cone of semi-angle semi_rad about the axis, 0 to 1.
double cone_share(const BeamGrid& grid, std::uint32_t column, std::uint32_t row, double semi_rad);

// Columns of column_rad to either side beyond which the pattern of the beam at axis_rad holds at
// most half a per cent of its power and, of a closed form, no more than its second side lobe.
std::uint32_t pattern_reach(const HeadPatterns& patterns, double axis_rad, double column_rad);

}  // namespace neritic::sonar
