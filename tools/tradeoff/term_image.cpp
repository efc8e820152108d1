#include "tools/tradeoff/term_image.hpp"

#include <algorithm>
#include <cmath>

#include "sonar/acoustics.hpp"
#include "sonar/acoustics_pulse.hpp"
#include "sonar/ping.hpp"

namespace neritic::tools {
namespace {

// Size of the table that stands for the exact bent rays: its interpolation error is (32 / 128)^2 of
// that of the sonar's own table.
constexpr sonar::RangeCorrectionSize kFineTable{129, 257};
// Beyond the last angle at which a pattern's power is this share of its peak it is left out.
constexpr double kLeastWeight = 1e-5;
// Steps of its table a half-power width: linear in between it is off by 2e-6 of the peak.
constexpr double kWeightSteps = 400.0;

sonar::PulseShape shape_of(const scene::SonarRangeSpread& spread) {
  return spread.window == scene::SonarRangeSpread::Window::kHann ? sonar::PulseShape::kHann
                                                                 : sonar::PulseShape::kFlat;
}

// Return time of a pulse sent at 0 that meets a still target after out_s: the receiver has moved by
// then. Fixed-point iteration, which contracts by v / c a step.
double return_s(const Vec3& target_m, const Vec3& velocity_m_s, double out_s, double c) {
  double t = out_s;
  for (int i = 0; i < 8; ++i) t = out_s + glm::length(target_m - velocity_m_s * t) / c;
  return t;
}

// Within half a turn; most angles are, and dividing costs more than all else that is done with
// them.
double wrapped(double angle_rad) {
  return std::abs(angle_rad) < kPi ? angle_rad : std::remainder(angle_rad, 2.0 * kPi);
}

// The entry of a table at a share of its longest range and a sine of the elevation.
double entry_of(const sonar::RangeCorrection& table, const std::vector<float>& entries,
                double share, double sine) {
  const double x = std::clamp(share, 0.0, 1.0) * (table.width - 1);
  const double y = (std::clamp(sine, -1.0, 1.0) * 0.5 + 0.5) * (table.height - 1);
  const auto i = std::min(static_cast<std::uint32_t>(x), table.width - 2),
             j = std::min(static_cast<std::uint32_t>(y), table.height - 2);
  const double u = x - i, v = y - j;
  const auto at = [&](std::uint32_t k, std::uint32_t l) {
    return double{entries[std::size_t{l} * table.width + k]};
  };
  return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
         v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
}

}  // namespace

Result<TermImage> TermImage::create(const scene::Sonar& sonar, const sonar::Head& head,
                                    const TruthView& view) {
  TermImage made;
  made.sonar_ = &sonar;
  made.view_ = view;
  made.grid_ = head.beams;
  made.folded_ = head.folded;
  NERITIC_TRY(made.patterns_, sonar::head_patterns(sonar));
  sonar::PingState state;
  state.world_from_sonar.position_m.y = -view.depth_m;
  const sonar::Ping ping = sonar::ping_of(sonar, head, state);  // for the water's two constants
  made.sound_speed_m_s_ = ping.sound_speed_m_s;
  made.absorption_db_per_m_ = ping.absorption_db_per_m;
  if (const auto& profile = sonar.terms.profile) {
    NERITIC_TRY(made.profile_, sonar::SoundSpeedProfile::of_table(profile->table));
    const double c = made.sound_speed_m_s_, range_m = head.beams.limits.range_max_m;
    if (profile->bent)
      made.bent_ = sonar::range_correction(*profile, view.depth_m, range_m, c, kFineTable);
    for (const sonar::Mirror& mirror : sonar::mirrors_of(sonar))
      if (profile->bent)
        made.bent_ghosts_ =
            sonar::range_correction(*profile, view.depth_m, 2.0 * range_m, c, kFineTable,
                                    sonar::ProfileMirror{-mirror.height_m, mirror.water_below});
  }
  made.make_weights();
  for (std::uint32_t row = 0; row < made.grid_.bins.range; ++row) {
    double db = 0.0;
    if (const auto& level = sonar.terms.level) {
      const double r = std::max(made.grid_.range_m(row), sonar::kNearestRange_m);
      db = level->gain_db + level->tvg_log * std::log10(r) +
           (level->tvg_absorption ? 2.0 * made.absorption_db_per_m_ * r : 0.0);
    }
    made.gain_.push_back(std::pow(10.0, db / 10.0));
  }
  made.make_kernel();
  const std::size_t bins = made.grid_.bins.range + 2 * made.reach_;
  made.column_.assign(made.kernel_[0].empty() ? bins : bins * kSubBins + 1, 0.0);
  made.spread_.resize(made.grid_.bins.range);
  for (auto& half : made.halves_)
    half.assign(std::size_t{made.grid_.bins.range} * made.grid_.bins.azimuth, 0.0);
  return made;
}

// The share that a bin receives of a return k sub-bins beyond its near edge: the pulse's energy
// between the bin's edges. With levels it is the mean power over the bin, of a return whose peak
// is 1.
void TermImage::make_kernel() {
  const auto& spread = sonar_->terms.range_spread;
  if (!spread) return;
  const sonar::PulseShape shape = shape_of(*spread);
  const double step = grid_.range_step_m();
  const double resolution = sonar::range_resolution_m(
      sonar::sound_speed_of(sonar_->terms.water, 0.0), spread->bandwidth_hz);
  reach_ = std::clamp(static_cast<int>(std::ceil(12.0 * resolution / step)), 2, 512);
  const auto share = [&](double offset_m) {
    return sonar::pulse_energy_below(shape, step - offset_m, resolution) -
           sonar::pulse_energy_below(shape, -offset_m, resolution);
  };
  const double scale = sonar_->terms.level ? sonar::pulse_length_m(shape, resolution) / step : 1.0;
  const int least = -reach_ * kSubBins, most = (reach_ + 1) * kSubBins;
  for (int phase = 0; phase < kSubBins; ++phase) {
    for (int k = least + phase; k <= most; k += kSubBins)
      kernel_[phase].push_back(share(k * step / kSubBins) * scale);
    std::ranges::reverse(kernel_[phase]);
  }
}

double TermImage::power(const TruthRay& ray, const TruthEcho& echo) const {
  double power = std::clamp(echo.cosine, 0.0, 1.0) * ray.pattern * echo.bounce;
  const double mean_m = 0.5 * (echo.out_m + echo.back_m);
  if (const auto& level = sonar_->terms.level) {
    power *= echo.backscatter * std::cos(ray.elevation_rad) * ray.elevation_width_rad * width_rad_;
    const double db = level->source_level_db - 2.0 * absorption_db_per_m_ * mean_m;
    return power * std::pow(10.0, db / 10.0) *
           (level->spreading ? 1.0 / (echo.back_m * echo.back_m) : echo.out_m * echo.out_m);
  }
  power *= std::min(1.0, echo.reflectivity);
  if (patterns_.cone)
    return power * std::cos(ray.elevation_rad) * ray.elevation_width_rad * width_rad_;
  return power * ray.elevation_width_rad /
         (grid_.limits.elevation_max_rad - grid_.limits.elevation_min_rad);
}

// Heard along bent rays: out and back, of a ghost each leg by its own.
double TermImage::bent_m(const TruthRay& ray, const TruthEcho& echo) const {
  const double range_max_m = grid_.limits.range_max_m;
  if (!echo.ghost)
    return echo.out_m * entry_of(bent_, bent_.factors, echo.out_m / range_max_m, ray.direction.y);
  const auto leg = [&](double range_m, double sine) {
    return range_m *
           entry_of(bent_ghosts_, bent_ghosts_.factors, range_m / (2.0 * range_max_m), sine);
  };
  return 0.5 * (leg(echo.out_m, ray.direction.y) + leg(echo.back_m, echo.target_m.y / echo.back_m));
}

double TermImage::bend_rad(double range_m, double sine, bool ghost) const {
  if (bent_.bends.empty()) return 0.0;
  const double longest_m = grid_.limits.range_max_m * (ghost ? 2.0 : 1.0);
  const sonar::RangeCorrection& table = ghost ? bent_ghosts_ : bent_;
  return entry_of(table, table.bends, range_m / longest_m, sine);
}

double TermImage::heard_range_m(const TruthRay& ray, const TruthEcho& echo) const {
  const double mean_m = 0.5 * (echo.out_m + echo.back_m), c = sound_speed_m_s_;
  double heard = mean_m;
  if (profile_) heard = bent_.width > 0 ? bent_m(ray, echo) : 0.5 * c * echo.seconds;
  const auto& motion = sonar_->terms.motion;
  if (!motion) return heard;
  // A ghost goes either way round: back directly, or by the mirror, which shows the target
  // elsewhere.
  const Vec3 shown_m = ray.direction * echo.out_m, v = view_.velocity_m_s;
  if (motion->within_ping)
    heard += 0.25 * c *
                 (return_s(echo.target_m, v, echo.out_m / c, c) +
                  return_s(shown_m, v, echo.back_m / c, c)) -
             mean_m;
  if (motion->doppler && sonar_->terms.range_spread)
    heard -= 0.5 * glm::dot(v, ray.direction + echo.target_m / echo.back_m) *
             sonar_->terms.frequency_hz * motion->pulse_s /
             sonar_->terms.range_spread->bandwidth_hz;
  return heard;
}

void TermImage::begin_column(double azimuth_rad, double width_rad) {
  column_rad_ = azimuth_rad;
  width_rad_ = width_rad;
  if (any_) std::fill(column_.begin(), column_.end(), 0.0);
  any_ = false;
  column_solid_angle_ = 0.0;
}

void TermImage::add_solid_angle(const TruthRay& ray) {
  if (folded_ && ray.inside)
    column_solid_angle_ +=
        ray.pattern * std::cos(ray.elevation_rad) * ray.elevation_width_rad * width_rad_;
}

void TermImage::add(const TruthRay& ray, const TruthEcho& echo) {
  if (!ray.inside || !(echo.cosine > 0.0)) return;
  const double at = (heard_range_m(ray, echo) - grid_.limits.range_min_m) / grid_.range_step_m();
  if (!(at > -reach_) || !(at < double(grid_.bins.range) + reach_)) return;
  const double p = power(ray, echo);
  any_ = true;
  if (kernel_[0].empty()) {
    column_[static_cast<std::size_t>(std::min(at, grid_.bins.range - 0.5))] += p;
    return;
  }
  const double sub = (at + reach_) * kSubBins;
  const auto low = std::min(static_cast<std::size_t>(sub), column_.size() - 2);
  const double part = sub - double(low);
  column_[low] += p * (1.0 - part);
  column_[low + 1] += p * part;
}

void TermImage::spread_column() {
  if (kernel_[0].empty()) {
    spread_ = column_;
    return;
  }
  std::fill(spread_.begin(), spread_.end(), 0.0);
  for (std::size_t s = 0; s < column_.size(); ++s) {
    const double p = column_[s];
    if (p == 0.0) continue;
    // Row j's near edge is sub-bin (j + reach) * kSubBins.
    const std::vector<double>& kernel = kernel_[s % kSubBins];
    const int size = static_cast<int>(kernel.size()), rows = static_cast<int>(spread_.size());
    const int first = static_cast<int>(s / kSubBins) - (size - 1);
    const int begin = std::max(0, first), end = std::min(rows, first + size);
    for (int j = begin; j < end; ++j) spread_[j] += p * kernel[j - first];
  }
}

void TermImage::make_weights() {
  if (!patterns_.azimuth || folded_) return;
  weight_step_rad_ = sonar_->terms.beam.azimuth->half_power_rad / kWeightSteps;
  std::size_t last = 0;
  double total = 0.0;  // over all bearings
  for (double off = 0.0; off <= kPi; off += weight_step_rad_) {
    const double a = patterns_.across(off);
    weights_.push_back(a * a);
    total += a * a * weight_step_rad_ * (off > 0.0 ? 2.0 : 1.0);
    if (a * a >= kLeastWeight) last = weights_.size();
  }
  weights_.resize(last);
  if (sonar_->terms.level) return;
  for (double& w : weights_) w /= total;
}

double TermImage::beam_weight(double off_rad) const {
  const double off = std::abs(wrapped(off_rad));
  if (!patterns_.azimuth) {
    const double step = grid_.azimuth_step_rad();
    if (off > step / 2.0) return 0.0;
    return sonar_->terms.level ? 1.0 : 1.0 / step;
  }
  const double at = off / weight_step_rad_;
  const auto low = static_cast<std::size_t>(at);
  if (low + 1 >= weights_.size()) return 0.0;
  return weights_[low] + (at - double(low)) * (weights_[low + 1] - weights_[low]);
}

double TermImage::weight_reach_rad() const {
  if (!patterns_.azimuth) return grid_.azimuth_step_rad() / 2.0;
  return weight_step_rad_ * static_cast<double>(weights_.size());
}

void TermImage::end_column(int half) {
  solid_angle_[half] += column_solid_angle_;
  if (!any_) return;
  spread_column();
  const auto& motion = sonar_->terms.motion;
  // While the echo comes back the head turns: a bearing to port by then looks farther to starboard.
  const double turn = motion && motion->within_ping && !folded_
                          ? view_.yaw_rate_rad_s * 2.0 / sound_speed_m_s_
                          : 0.0;
  // And it moves, so that a bearing slides back by the speed across it.
  const Vec3 v = glm::transpose(view_.world_from_head) * view_.velocity_m_s;
  const double slide =
      motion && motion->within_ping && !folded_
          ? -2.0 / sound_speed_m_s_ * (v.x * std::cos(column_rad_) + v.z * std::sin(column_rad_))
          : 0.0;
  const std::uint32_t beams = grid_.bins.azimuth;
  const double counted = sonar_->terms.level || folded_ ? 1.0 : width_rad_;
  for (std::uint32_t b = 0; b < beams; ++b) {
    const double off = column_rad_ + slide - grid_.azimuth_rad(b);
    const double still = folded_ ? 1.0 : beam_weight(off);
    const double most_turn = std::abs(turn) * grid_.limits.range_max_m;
    if (still == 0.0 && std::abs(wrapped(off)) > weight_reach_rad() + most_turn) continue;
    for (std::uint32_t row = 0; row < grid_.bins.range; ++row) {
      if (spread_[row] == 0.0) continue;
      const double w = turn == 0.0 ? still : beam_weight(off + turn * grid_.range_m(row));
      halves_[half][std::size_t{row} * beams + b] += spread_[row] * w * counted * gain_[row];
    }
  }
}

std::vector<double> TermImage::image() const {
  std::vector<double> out(halves_[0].size());
  const bool share = folded_ && !sonar_->terms.level;
  const double all = share ? solid_angle_[0] + solid_angle_[1] : 1.0;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = (halves_[0][i] + halves_[1][i]) / all;
  return out;
}

std::vector<double> TermImage::half_difference() const {
  std::vector<double> out(halves_[0].size());
  const bool share = folded_ && !sonar_->terms.level;
  const double all[2] = {share ? 2.0 * solid_angle_[0] : 1.0, share ? 2.0 * solid_angle_[1] : 1.0};
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = halves_[0][i] / all[0] - halves_[1][i] / all[1];
  return out;
}

void TermImage::merge(const TermImage& other) {
  for (int half = 0; half < 2; ++half) {
    for (std::size_t i = 0; i < halves_[half].size(); ++i)
      halves_[half][i] += other.halves_[half][i];
    solid_angle_[half] += other.solid_angle_[half];
  }
}

}  // namespace neritic::tools
