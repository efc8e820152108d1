#include "sonar/beam_pattern.hpp"

#include <cmath>
#include <numbers>

#include "engine/core/check.hpp"
#include "engine/core/math.hpp"
#include "sonar/acoustics.hpp"

namespace neritic::sonar {
namespace {

constexpr double kMinLength = 1e-3, kMaxLength = 1e5;
constexpr TableFormat kFormat{"angle_deg", "db", -180.0, 180.0, -300.0, 0.0};
const double kHalfAmplitude = std::sqrt(0.5);

double sinc(double u) {
  const double a = kPi * u;
  return std::abs(a) < 1e-8 ? 1.0 : std::sin(a) / a;
}

// Weights 0.54 + 0.46 cos(2 pi x / L) along the line (Harris 1978, Proc. IEEE 66, 51), transformed
// and scaled to 1 on the axis.
double hamming(double u) {
  return sinc(u) + 0.23 / 0.54 * (sinc(u - 1.0) + sinc(u + 1.0));
}

// Kinsler et al. 2000, eq. 7.4.17.
double piston(double u) {
  const double a = kPi * std::abs(u);
  return a < 1e-6 ? 1.0 : 2.0 * ::j1(a) / a;
}

// Where f falls through level in [low, high]: f(low) > level >= f(high).
template <class F>
double falls_through(const F& f, double level, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// The greatest f in [low, high], which holds one peak.
template <class F>
double peak(const F& f, double low, double high) {
  const double golden = 1.0 / std::numbers::phi;
  for (int i = 0; i < 60; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (f(a) > f(b))
      high = b;
    else
      low = a;
  }
  return 0.5 * (low + high);
}

}  // namespace

const char* name_of(BeamKind kind) {
  switch (kind) {
    case BeamKind::kOmni:
      return "omni";
    case BeamKind::kSinc:
      return "sinc";
    case BeamKind::kHamming:
      return "hamming";
    case BeamKind::kPiston:
      return "piston";
    case BeamKind::kTable:
      return "table";
  }
  return "";
}

Result<BeamKind> beam_kind_of(std::string_view name) {
  for (const BeamKind kind :
       {BeamKind::kOmni, BeamKind::kSinc, BeamKind::kHamming, BeamKind::kPiston})
    if (name == name_of(kind)) return kind;
  return bad_input("beam '{}'; accepted: omni, sinc, hamming, piston", name);
}

double beam_response(BeamKind kind, double u) {
  NERITIC_CHECK(kind != BeamKind::kOmni && kind != BeamKind::kTable, "{} has no closed form in u",
                name_of(kind));
  return kind == BeamKind::kSinc ? sinc(u) : kind == BeamKind::kHamming ? hamming(u) : piston(u);
}

double half_power_u(BeamKind kind) {
  return falls_through([kind](double u) { return beam_response(kind, u); }, kHalfAmplitude, 0.0,
                       1.0);
}

BeamPattern BeamPattern::omni() {
  return BeamPattern(BeamKind::kOmni, 0.0);
}

Result<BeamPattern> BeamPattern::of_length(BeamKind kind, double length_wavelengths) {
  if (kind == BeamKind::kOmni || kind == BeamKind::kTable)
    return bad_input("beam '{}' has no length; accepted: sinc, hamming, piston", name_of(kind));
  if (!(length_wavelengths >= kMinLength && length_wavelengths <= kMaxLength))
    return bad_input("beam: a length of {} wavelengths; accepted: {:g} to {:g}", length_wavelengths,
                     kMinLength, kMaxLength);
  return BeamPattern(kind, length_wavelengths);
}

Result<BeamPattern> BeamPattern::of_length(BeamKind kind, double length_m, double frequency_hz,
                                           double sound_speed_m_s) {
  return of_length(kind, length_m * frequency_hz / sound_speed_m_s);
}

Result<BeamPattern> BeamPattern::of_half_power_width(BeamKind kind, double width_rad) {
  if (kind == BeamKind::kOmni || kind == BeamKind::kTable)
    return bad_input("beam '{}' has no width to choose; accepted: sinc, hamming, piston",
                     name_of(kind));
  if (!(width_rad > 0.0 && width_rad < kPi))
    return bad_input("beam: a half-power width of {} degrees; accepted: above 0 and below 180",
                     degrees(width_rad));
  return of_length(kind, half_power_u(kind) / std::sin(0.5 * width_rad));
}

Result<BeamPattern> BeamPattern::of_table(Table degrees_db) {
  NERITIC_TRY_STATUS(validate(degrees_db, "beam table", kFormat));
  if (degrees_db.back().x < 0.0)
    return bad_input("beam table: angles end at {} degrees; accepted: tables that reach the axis",
                     degrees_db.back().x);
  BeamPattern pattern(BeamKind::kTable, 0.0);
  if (degrees_db.front().x >= 0.0)
    for (auto row = degrees_db.rbegin(); row != degrees_db.rend(); ++row)
      if (row->x > 0.0) pattern.table_.push_back({-radians(row->x), row->y});
  for (const TableRow& row : degrees_db) pattern.table_.push_back({radians(row.x), row.y});
  return pattern;
}

Result<BeamPattern> BeamPattern::from_file(const std::filesystem::path& path) {
  NERITIC_TRY(Table table, read_table(path, kFormat));
  return of_table(std::move(table));
}

double BeamPattern::table_amplitude(double theta_rad) const {
  if (theta_rad < table_.front().x || theta_rad > table_.back().x) return 0.0;
  return amplitude_from_db(interpolate(table_, theta_rad));
}

double BeamPattern::amplitude(double theta_rad) const {
  return steered_amplitude(theta_rad, 0.0);
}

double BeamPattern::steered_amplitude(double theta_rad, double steer_rad) const {
  if (std::isnan(theta_rad) || std::isnan(steer_rad)) return theta_rad + steer_rad;
  if (kind_ == BeamKind::kOmni) return 1.0;
  if (kind_ == BeamKind::kTable)
    return table_amplitude(std::remainder(theta_rad - steer_rad, 2.0 * kPi));
  if (std::abs(theta_rad) > kPi / 2.0) return 0.0;
  return beam_response(kind_, length_ * (std::sin(theta_rad) - std::sin(steer_rad)));
}

double BeamPattern::one_way_power(double theta_rad) const {
  const double a = amplitude(theta_rad);
  return a * a;
}

double BeamPattern::two_way_power(double theta_rad) const {
  const double power = one_way_power(theta_rad);
  return power * power;
}

double BeamPattern::half_power_width_rad() const {
  if (kind_ == BeamKind::kOmni) return 2.0 * kPi;
  if (kind_ != BeamKind::kTable) {
    const double sine = half_power_u(kind_) / length_;
    return sine >= 1.0 ? kPi : 2.0 * std::asin(sine);
  }
  // Out from the axis by quarters of a degree to the first fall, then its place.
  const auto side = [this](double sign) {
    const auto f = [&](double theta) { return table_amplitude(sign * theta); };
    const double end = std::max(0.0, sign > 0.0 ? table_.back().x : -table_.front().x);
    const double step = radians(0.25);
    for (double theta = 0.0; theta < end; theta += step)
      if (f(std::min(theta + step, end)) < kHalfAmplitude)
        return f(theta) < kHalfAmplitude
                   ? theta
                   : falls_through(f, kHalfAmplitude, theta, std::min(theta + step, end));
    return end;
  };
  return side(1.0) + side(-1.0);
}

std::optional<SideLobe> BeamPattern::first_side_lobe() const {
  if (kind_ == BeamKind::kOmni) return std::nullopt;
  const bool table = kind_ == BeamKind::kTable;
  const auto level = [&](double x) {
    return std::abs(table ? table_amplitude(x) : beam_response(kind_, x));
  };
  // In u (or radians of a table): down to the first minimum, then up to the next maximum.
  const double end = table ? table_.back().x : length_;
  const double step = table ? radians(0.05) : 0.01;
  double x = 0.0;
  while (x + step <= end && level(x + step) <= level(x)) x += step;
  const double minimum = x;
  while (x + step <= end && level(x + step) >= level(x)) x += step;
  if (x == minimum || x + step > end) return std::nullopt;
  const double top = peak(level, x - step, x + step);
  return SideLobe{table ? top : std::asin(top / length_), db_from_amplitude(level(top))};
}

}  // namespace neritic::sonar
