#include "sonar/head.hpp"

#include <algorithm>
#include <numeric>

#include "sonar/acoustics_pulse.hpp"
#include "sonar/head_pattern.hpp"
#include "sonar/quality.hpp"
#include "sonar/range_correction.hpp"

namespace neritic::sonar {
namespace {

using scene::SonarKind;
using scene::SonarTerms;

constexpr std::uint32_t kGammaQuantiles = 4096;

// Whether anything beyond the published plain cosine is named.
bool has_terms(const scene::Sonar& sonar) {
  const SonarTerms& t = sonar.terms;
  return t.level || t.beam.azimuth || t.beam.elevation || t.beam.samples > 1 || t.range_spread ||
         (sonar.kind == SonarKind::kSideScan && sonar.bins_azimuth > 1) || t.speckle || t.noise ||
         t.ghosts || t.profile || t.motion || t.labels.energy ||
         sonar.kind == SonarKind::kEchoSounder;
}

// The grid that leaves the head: of an echo sounder the pyramid around its cone, as one beam.
BeamGrid beam_grid_of(const scene::Sonar& s) {
  const bool cone = s.kind == SonarKind::kEchoSounder;
  const bool one_beam = s.kind == SonarKind::kMechanical || s.kind == SonarKind::kSideScan;
  // A scanner's head is one beam that a step's width of the bottom belongs to.
  const double azimuth = cone                               ? 2.0 * s.semi_angle_rad
                         : s.kind == SonarKind::kMechanical ? s.step_rad
                                                            : s.azimuth_rad;
  const double elevation = cone ? 2.0 * s.semi_angle_rad : s.elevation_rad;
  return symmetric_grid(s.range_min_m, s.range_max_m, azimuth, elevation,
                        {s.bins_range, one_beam ? 1 : s.bins_azimuth, s.bins_elevation});
}

bool full_turn(const BeamGrid& grid) {
  return grid.limits.azimuth_max_rad - grid.limits.azimuth_min_rad > 2.0 * kPi - 1e-9;
}

constexpr std::uint32_t kMostBent = 768;  // kMostWidenedRows of rows as far as rays bend

// An elevation pattern is heard beyond the aperture that its half power names: as far as its second
// null: the bottom straight below a side-scan, or the surface above a flat beam, is heard there.
void widen_elevation(const scene::Sonar& sonar, Head& head, const HeadPatterns& patterns) {
  if (!patterns.upright()) return;
  BeamGrid& g = head.samples;
  const double cell_rad = target_cell_rad(sonar, patterns);
  const auto widen = [&](double& min_rad, double& max_rad, double step_rad, std::uint32_t& bins) {
    const double beyond_rad = heard_half_rad(max_rad, patterns) - max_rad;
    const auto rows = static_cast<std::uint32_t>(std::clamp(
        std::ceil(beyond_rad / step_rad - 1e-6), 0.0,
        std::max(0.0, std::floor((kMaxElevation_rad / 2.0 - max_rad) / step_rad + 1e-6))));
    min_rad -= rows * step_rad;
    max_rad += rows * step_rad;
    const double for_targets = cell_rad > 0.0 ? std::ceil((max_rad - min_rad) / cell_rad) : 0.0;
    const auto most = std::max(kMostWidenedRows,
                               static_cast<std::uint32_t>(std::min(for_targets, double{kMaxBins})));
    bins = std::min(bins + 2 * rows, std::max(bins, most));
  };
  Limits& l = g.limits;
  widen(l.elevation_min_rad, l.elevation_max_rad, g.elevation_step_rad(), g.bins.elevation);
  if (patterns.cone)
    widen(l.azimuth_min_rad, l.azimuth_max_rad, g.azimuth_step_rad(), g.bins.azimuth);
}

// Sound that leaves within the beam may end beyond it: rows (a cone's columns too) as far as rays
// bend.
void widen_for_bends(Head& head, const scene::SonarProfile& profile, bool cone) {
  BeamGrid& g = head.samples;
  Limits& l = g.limits;
  const double bend_rad = most_bend_rad(profile, l.range_max_m);
  const auto widen = [&](double& min_rad, double& max_rad, double step_rad, std::uint32_t& bins) {
    const double most = std::floor((kMaxElevation_rad / 2.0 - max_rad) / step_rad + 1e-6);
    const double rows = std::max(0.0, std::min(std::ceil(bend_rad / step_rad - 1e-6), most));
    bins = std::min(bins + 2 * static_cast<std::uint32_t>(rows), std::max(bins, kMostBent));
    min_rad -= rows * step_rad;
    max_rad += rows * step_rad;
  };
  widen(l.elevation_min_rad, l.elevation_max_rad, g.elevation_step_rad(), g.bins.elevation);
  if (cone) widen(l.azimuth_min_rad, l.azimuth_max_rad, g.azimuth_step_rad(), g.bins.azimuth);
}

// Makes head.samples from head.beams: columns a beam, and as many beyond the edges as the pattern
// reaches, so that what lies just outside is heard through the flank of the edge beams.
Status plan_samples(Head& head, std::uint32_t samples, std::uint32_t reach) {
  head.samples_per_beam = head.folded ? head.samples.bins.azimuth : samples;
  if (head.folded) {
    head.beams.bins.azimuth = 1;
    return validate(head.samples);
  }
  const bool ring = full_turn(head.beams);
  const double column = head.beams.azimuth_step_rad() / samples;
  const double room =
      (2.0 * kPi - (head.beams.limits.azimuth_max_rad - head.beams.limits.azimuth_min_rad)) / 2.0;
  head.margin = ring ? 0 : std::min(reach, static_cast<std::uint32_t>(std::floor(room / column)));
  head.samples.bins.azimuth = head.beams.bins.azimuth * samples + 2 * head.margin;
  head.samples.limits.azimuth_min_rad -= head.margin * column;
  head.samples.limits.azimuth_max_rad += head.margin * column;
  return validate(head.samples);
}

// Weights of each gathered beam: the elevation pattern there and back, the solid angle's cosine
// where powers are physical, and a cone's edge. Empty: all are 1.
std::vector<float> beam_weights(const scene::Sonar& sonar, const Head& head,
                                const HeadPatterns& patterns) {
  const bool bent = sonar.terms.profile && sonar.terms.profile->bent;
  if (!sonar.terms.level && !patterns.elevation && !patterns.cone && !bent) return {};
  const BeamGrid& grid = head.samples;
  std::vector<float> weights(std::size_t{grid.bins.azimuth} * grid.bins.elevation);
  for (std::uint32_t row = 0; row < grid.bins.elevation; ++row)
    for (std::uint32_t column = 0; column < grid.bins.azimuth; ++column) {
      const double phi = grid.elevation_rad(row);
      double weight = patterns.power_of_cell(grid, column, row);
      if (sonar.terms.level || patterns.cone) weight *= std::cos(phi);
      if (patterns.cone) weight *= cone_share(grid, column, row, patterns.cone_rad);
      if (std::abs(phi) > head.heard_up_rad) weight = 0.0;
      weights[std::size_t{row} * grid.bins.azimuth + column] = static_cast<float>(weight);
    }
  return weights;
}

// The spread along range. With levels a bin has the mean power over its length, whatever that is;
// else the energy is kept.
Result<Taps> range_taps(const scene::Sonar& sonar, const BeamGrid& grid, bool coherent) {
  if (!sonar.terms.range_spread) return Taps{};
  NERITIC_TRY(const RangeSpread kernel, pulse_taps(sonar.terms, grid));
  const double scale = sonar.terms.level ? kernel.pulse_bins : 1.0;
  Taps taps{-static_cast<int>(kernel.reach), {}};
  for (std::size_t i = 0; i < kernel.energy.size(); ++i)
    taps.weights.push_back(static_cast<float>(coherent ? kernel.amplitude[i] * std::sqrt(scale)
                                                       : kernel.energy[i] * scale));
  return taps;
}

// The kernel of the beam at axis_rad.
std::vector<float> beam_kernel(const scene::Sonar& sonar, const Head& head,
                               const HeadPatterns& patterns, std::uint32_t reach, double axis_rad,
                               bool coherent) {
  const std::uint32_t samples = head.samples_per_beam;
  const double column = head.samples.azimuth_step_rad();
  std::vector<double> amplitude(samples + 2 * reach, 1.0);
  for (std::size_t i = 0; i < amplitude.size() && !head.folded; ++i)
    amplitude[i] = patterns.across_column((double(i) - reach - (samples - 1) / 2.0) * column,
                                          axis_rad, column);
  // Calibrated levels count all that a beam hears; else the taps share the energy out.
  const bool counts_all = sonar.terms.level || head.folded;
  double total = 0.0;
  for (const double a : amplitude) total += a * a;
  const double scale = counts_all ? 1.0 : 1.0 / total;
  std::vector<float> kernel;
  for (const double a : amplitude)
    kernel.push_back(static_cast<float>(coherent ? a * std::sqrt(scale) : a * a * scale));
  return kernel;
}

// The weights that gather columns into a beam.
Taps across_taps(const scene::Sonar& sonar, const Head& head, const HeadPatterns& patterns,
                 std::uint32_t reach, bool coherent) {
  if (head.samples_per_beam == 1 && reach == 0 && !head.folded) return {};
  Taps taps{static_cast<int>(head.margin) - static_cast<int>(reach), {}};
  if (patterns.flat) taps.kernels = head.beams.bins.azimuth;
  for (std::uint32_t beam = 0; beam < taps.kernels; ++beam) {
    const double axis_rad = patterns.flat ? head.beams.azimuth_rad(beam) : 0.0;
    const auto kernel = beam_kernel(sonar, head, patterns, reach, axis_rad, coherent);
    taps.weights.insert(taps.weights.end(), kernel.begin(), kernel.end());
  }
  return taps;
}

double sample_power_of(const scene::Sonar& sonar, const Head& head) {
  const BeamGrid& g = head.samples;
  if (sonar.terms.level) return g.azimuth_step_rad() * g.elevation_step_rad();
  // The mean over the aperture; what is heard beyond it comes on top. Rows may have grown since.
  if (!head.folded)
    return g.elevation_step_rad() / head.beams.elevation_step_rad() / head.beams.bins.elevation;
  const auto& w = head.echo->weights;
  return 1.0 / std::max(std::accumulate(w.begin(), w.end(), 0.0), 1e-30);
}

Result<Head> plan_head(const scene::Sonar& sonar, std::string name, const Quat& rotation) {
  Head head;
  head.name = std::move(name);
  head.sonar_from_head.rotation = rotation;
  head.beams = beam_grid_of(sonar);
  head.folded = sonar.kind == SonarKind::kEchoSounder;
  if (const Status valid = validate(head.beams); !valid.ok())
    return bad_input("sonar {}: {}", sonar.name, valid.error().message);
  const SonarTerms& t = sonar.terms;
  head.samples = head.beams;
  head.heard_up_rad = head.beams.limits.elevation_max_rad;
  if (!has_terms(sonar)) return head;
  auto made = head_patterns(sonar);
  if (!made.ok()) return bad_input("sonar {}: beam: {}", sonar.name, made.error().message);
  const HeadPatterns& patterns = *made;
  widen_elevation(sonar, head, patterns);
  head.heard_up_rad = head.samples.limits.elevation_max_rad;
  if (t.profile && t.profile->bent) widen_for_bends(head, *t.profile, patterns.cone);
  // Side-scans and scanners hear one beam: their azimuth bins sample it.
  const std::uint32_t samples = sonar.kind == SonarKind::kSideScan
                                    ? std::max(sonar.bins_azimuth, t.beam.samples)
                                    : t.beam.samples;
  const double column = head.beams.azimuth_step_rad() / samples;
  // The outermost beam of a flat array is the widest.
  const double widest_rad = patterns.flat ? head.beams.azimuth_rad(0) : 0.0;
  const std::uint32_t reach =
      patterns.azimuth && !head.folded ? pattern_reach(patterns, widest_rad, column) : 0;
  if (const Status valid = plan_samples(head, samples, reach); !valid.ok())
    return bad_input("sonar {}: with {} samples a beam: {}", sonar.name, samples,
                     valid.error().message);
  EchoOptions echo;
  echo.coherent = t.speckle.has_value();
  echo.corrected = t.profile.has_value();
  echo.bent = t.profile && t.profile->bent;
  echo.moving = t.motion.has_value();
  echo.records = t.labels.energy;
  echo.weights = beam_weights(sonar, head, patterns);
  if (t.speckle && t.speckle->shape > 0.0)
    echo.gamma_quantiles = gamma_quantiles(t.speckle->shape, kGammaQuantiles);
  head.echo = std::move(echo);
  head.sample_power = sample_power_of(sonar, head);
  ReceiverDesc& r = head.receiver;
  r.rows = head.samples.bins.range;
  r.columns = head.samples.bins.azimuth;
  r.beams = head.beams.bins.azimuth;
  r.stride = head.samples_per_beam;
  r.wrap = full_turn(head.beams);
  r.coherent = t.speckle.has_value();
  r.noise = t.noise.has_value();
  r.shift = t.motion && t.motion->within_ping && !head.folded;
  r.first_bearing_rad = head.beams.azimuth_rad(0);
  r.bearing_step_rad = head.beams.azimuth_step_rad();
  NERITIC_TRY(r.range, range_taps(sonar, head.beams, r.coherent));
  r.across = across_taps(sonar, head, patterns, reach, r.coherent);
  if (r.shift && r.across.weights.empty()) r.across = {0, {1.0f}};
  return head;
}

}  // namespace

Result<RangeSpread> pulse_taps(const scene::SonarTerms& terms, const BeamGrid& grid) {
  if (!terms.range_spread) return RangeSpread{};
  using Window = scene::SonarRangeSpread::Window;
  const bool hann = terms.range_spread->window == Window::kHann;
  const double resolution =
      range_resolution_m(sound_speed_of(terms.water, 0.0), terms.range_spread->bandwidth_hz);
  // A Hann pulse's tails are short, a sinc's are not: leaving out 1 % costs its echo as much error.
  return range_spread(hann ? PulseShape::kHann : PulseShape::kFlat, resolution, grid.range_step_m(),
                      hann ? 1e-3 : 1e-2,
                      terms.level ? PlaceInBin::kAnywhere : PlaceInBin::kMiddle);
}

double scan_heading_rad(const scene::Sonar& sonar, std::uint32_t ping) {
  if (sonar.kind != SonarKind::kMechanical) return 0.0;
  const bool round = sonar.azimuth_rad > 2.0 * kPi - 1e-9;
  // Those of a sector lie within it; a turn's last may overlap its first by half a step.
  const double fit = sonar.azimuth_rad / sonar.step_rad;
  const auto steps =
      static_cast<std::uint32_t>(std::max(1.0, round ? std::round(fit) : std::floor(fit + 1e-6)));
  std::uint32_t at = ping % steps;
  if (!round && steps > 1) {
    at = ping % (2 * (steps - 1));
    if (at >= steps) at = 2 * (steps - 1) - at;
  }
  return (at + 0.5 - 0.5 * steps) * sonar.step_rad;
}

std::vector<float> gamma_quantiles(double shape, std::uint32_t count) {
  // The distribution function by Simpson's rule in t = log x, where the density x^shape e^-x is
  // smooth at 0; then read backwards.
  const double low = std::log(1e-12) / std::min(shape, 1.0),
               high = std::log(shape + 40.0 + 12.0 * std::sqrt(shape));
  constexpr int kSteps = 20000;
  const double step = (high - low) / kSteps;
  const auto density = [&](double t) {
    return std::exp(shape * t - std::exp(t) - std::lgamma(shape));
  };
  std::vector<double> below(kSteps + 1, 0.0);
  for (int i = 0; i < kSteps; ++i) {
    const double t = low + i * step;
    below[i + 1] =
        below[i] + step / 6.0 * (density(t) + 4.0 * density(t + step / 2.0) + density(t + step));
  }
  std::vector<double> x(count);
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double wanted = (i + 0.5) / count * below.back();
    while (at + 1 < below.size() - 1 && below[at + 1] < wanted) ++at;
    const double part = (wanted - below[at]) / std::max(below[at + 1] - below[at], 1e-300);
    x[i] = std::exp(low + (at + std::clamp(part, 0.0, 1.0)) * step);
  }
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / count;
  std::vector<float> out(count);
  for (std::uint32_t i = 0; i < count; ++i) out[i] = static_cast<float>(x[i] / mean);
  return out;
}

Result<std::vector<Head>> plan_heads(const scene::Sonar& settings) {
  scene::Sonar sonar = settings;
  NERITIC_TRY_STATUS(apply_quality(sonar));
  std::vector<Head> heads;
  if (sonar.kind != SonarKind::kSideScan) {
    NERITIC_TRY(Head head, plan_head(sonar, "", Quat(1, 0, 0, 0)));
    heads.push_back(std::move(head));
    return heads;
  }
  // To either side of the track, tilted down.
  for (const auto& [name, side] : {std::pair("port", 1.0), std::pair("starboard", -1.0)}) {
    const Quat turn = glm::angleAxis(side * kPi / 2.0, Vec3(0, 1, 0)) *
                      glm::angleAxis(-sonar.depression_rad, Vec3(1, 0, 0));
    NERITIC_TRY(Head head, plan_head(sonar, name, turn));
    heads.push_back(std::move(head));
  }
  return heads;
}

}  // namespace neritic::sonar
