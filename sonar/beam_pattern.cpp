#include "sonar/beam_pattern.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/math.hpp"
#include "engine/core/refusal.hpp"
#include "sonar/acoustics.hpp"

namespace neritic::sonar {
namespace {

constexpr double kMinLength = 1e-3, kMaxLength = 1e5;
constexpr TableLimits kAngleLimits{-180.0, 180.0, -300.0, 0.0};
const double kHalfAmplitude = std::sqrt(0.5);

double uniform_line(double u) {
  const double a = kPi * u;
  return std::abs(a) < 1e-8 ? 1.0 : std::sin(a) / a;
}

// Weights 0.54 + 0.46 cos(2 pi x / L) along the line (Harris 1978, Proc. IEEE 66, 51), transformed
// and scaled to 1 on the axis.
double hamming_line(double u) {
  return uniform_line(u) + 0.23 / 0.54 * (uniform_line(u - 1.0) + uniform_line(u + 1.0));
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

}  // namespace

const char* name_of(BeamShape shape) {
  switch (shape) {
    case BeamShape::kSinc:
      return "sinc";
    case BeamShape::kHamming:
      return "hamming";
    case BeamShape::kPiston:
      return "piston";
    case BeamShape::kTable:
      return "table";
  }
  return "";
}

double beam_response(BeamShape shape, double u) {
  NERITIC_CHECK(shape != BeamShape::kTable, "{} has no closed form in u", name_of(shape));
  return shape == BeamShape::kSinc      ? uniform_line(u)
         : shape == BeamShape::kHamming ? hamming_line(u)
                                        : piston(u);
}

double half_power_u(BeamShape shape) {
  return falls_through([shape](double u) { return beam_response(shape, u); }, kHalfAmplitude, 0.0,
                       1.0);
}

Result<BeamPattern> BeamPattern::of_length(BeamShape shape, double length_wavelengths) {
  if (shape == BeamShape::kTable)
    return refusal("beam", fmt::format("'{}', which has no length", name_of(shape)),
                   "sinc, hamming, piston");
  if (!(length_wavelengths >= kMinLength && length_wavelengths <= kMaxLength))
    return refusal("beam", fmt::format("a length of {} wavelengths", length_wavelengths),
                   fmt::format("{:g} to {:g}", kMinLength, kMaxLength));
  return BeamPattern(shape, length_wavelengths);
}

Result<BeamPattern> BeamPattern::of_half_power_width(BeamShape shape, double width_rad) {
  if (shape == BeamShape::kTable)
    return refusal("beam", fmt::format("'{}', whose width is fixed", name_of(shape)),
                   "sinc, hamming, piston");
  if (!(width_rad > 0.0 && width_rad < kPi))
    return refusal("beam", fmt::format("a half-power width of {} degrees", degrees(width_rad)),
                   "above 0 and below 180");
  return of_length(shape, half_power_u(shape) / std::sin(0.5 * width_rad));
}

Result<BeamPattern> BeamPattern::of_table(SonarTable degrees_db) {
  NERITIC_TRY_STATUS(validate(degrees_db, "beam table", kAngleLimits));
  if (degrees_db.back().x < 0.0)
    return refusal("beam table", fmt::format("angles that end at {} degrees", degrees_db.back().x),
                   "tables that reach the axis, 0 degrees");
  BeamPattern pattern(BeamShape::kTable, 0.0);
  if (degrees_db.front().x >= 0.0)
    for (auto row = degrees_db.rbegin(); row != degrees_db.rend(); ++row)
      if (row->x > 0.0) pattern.table_.push_back({-radians(row->x), row->y});
  for (const SonarRow& row : degrees_db) pattern.table_.push_back({radians(row.x), row.y});
  return pattern;
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
  if (shape_ == BeamShape::kTable)
    return table_amplitude(std::remainder(theta_rad - steer_rad, 2.0 * kPi));
  if (std::abs(theta_rad) > kPi / 2.0) return 0.0;
  return beam_response(shape_, length_ * (std::sin(theta_rad) - std::sin(steer_rad)));
}

double BeamPattern::two_way_power(double theta_rad) const {
  const double a = amplitude(theta_rad);
  return a * a * a * a;
}

double BeamPattern::half_power_width_rad() const {
  if (shape_ != BeamShape::kTable)
    return 2.0 * std::asin(std::min(1.0, half_power_u(shape_) / length_));
  const double half_db = interpolate(table_, 0.0) - 10.0 * std::log10(2.0);
  // To one side of the axis, from row to row outwards, until the line between two falls through.
  const auto edge = [&](double side) {
    SonarRow inner{0.0, interpolate(table_, 0.0)};
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const SonarRow& outer = side > 0.0 ? table_[i] : table_[table_.size() - 1 - i];
      if (!(outer.x * side > 0.0)) continue;
      if (outer.y <= half_db)
        return std::abs(inner.x + (outer.x - inner.x) * (inner.y - half_db) / (inner.y - outer.y));
      inner = outer;
    }
    return std::abs(inner.x);
  };
  return edge(1.0) + edge(-1.0);
}

double BeamPattern::second_null_rad() const {
  if (shape_ == BeamShape::kTable) return std::max(-table_.front().x, table_.back().x);
  // In u: a line's is 2; Hamming's main lobe ends at 2, its first side lobe at 2.598; a piston's is
  // the second zero of J1, 7.0156, over pi.
  const double u = shape_ == BeamShape::kSinc      ? 2.0
                   : shape_ == BeamShape::kHamming ? 2.598
                                                   : 7.0156 / kPi;
  return u >= length_ ? kPi / 2.0 : std::asin(u / length_);
}

}  // namespace neritic::sonar
