// A sonar's settings as heads (one, or a side-scan's two), each a view of its own
// with a grid of beams that it gathers and a grid that leaves it, and the terms that its passes
// need. Fixed as long as the settings are. Pure functions of plain values; any thread.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "sonar/acoustics_pulse.hpp"
#include "sonar/beam_grid.hpp"
#include "sonar/gather.hpp"
#include "sonar/receiver.hpp"

namespace neritic::sonar {

struct Head {
  std::string name;      // "" or "port", "starboard"
  Pose sonar_from_head;  // a head looks along its -z
  BeamGrid beams;        // of what leaves: [range][beams]
  BeamGrid samples;      // of what is gathered: samples_per_beam columns a beam, and a margin
  // The part of the gathered elevations that is heard: less than all if rays are bent, since such a
  // ray may end outside the elevation at which it leaves.
  double heard_up_rad = 0.0;                       // to either side
  std::uint32_t samples_per_beam = 1, margin = 0;  // columns
  bool folded = false;  // all columns are one beam: an echo sounder's cone
  // Absent: the plain cosine, whose 32-bit sums are the image.
  std::optional<EchoOptions> echo;
  ReceiverDesc receiver;  // where echo is there; sum_scale is the gather's
  // The weight of one gathered beam of full strength in the field, before range and water: power.
  double sample_power = 1.0;
};

// kBadInput that names the setting.
Result<std::vector<Head>> plan_heads(const scene::Sonar& sonar);

// The image of a point by the pulse that the terms name, over the grid's bins; without one, empty.
Result<RangeSpread> pulse_taps(const scene::SonarTerms& terms, const BeamGrid& grid);

// Where a mechanical scanner's beam points at its ping-th ping: azimuth in sonar axes, positive to
// starboard. From full port in steps; a full turn goes on round, a sector is swept to and fro by as
// many whole steps as fit, in its middle. 0 for other kinds.
double scan_heading_rad(const scene::Sonar& sonar, std::uint32_t ping);

// The quantiles of a gamma distribution of mean 1 and that shape (variance 1 / shape), count of
// them at (i + 1/2) / count, scaled so that their own mean is 1. shape in [0.05, 1000].
std::vector<float> gamma_quantiles(double shape, std::uint32_t count);

}  // namespace neritic::sonar
