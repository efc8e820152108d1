#include "engine/core/sea_waves.hpp"

#include <algorithm>

#include "engine/core/random.hpp"

namespace neritic {
namespace {

constexpr double kGravity_m_s2 = 9.81;
// Surface tension over density of sea water at 15 degrees Celsius, m^3/s^2 (0.0735 N/m over 1026
// kg/m3).
constexpr double kTension_m3_s2 = 7.16e-5;
// The sum ends at this wavelength; what is shorter counts as roughness.
constexpr double kShortest_m = 0.12;
// Stream of the counter-based randomness.
constexpr std::uint64_t kWaveStream = 0x77617665;

// Capillary and gravity waves in deep water: w^2 = g k + s k^3.
double angular_of(double k) {
  return std::sqrt(kGravity_m_s2 * k + kTension_m3_s2 * k * k * k);
}

// The wave number of an angular frequency, by Newton's method.
double wave_number_of(double angular_s) {
  double k = angular_s * angular_s / kGravity_m_s2;
  for (int i = 0; i < 8; ++i) {
    const double f = kGravity_m_s2 * k + kTension_m3_s2 * k * k * k - angular_s * angular_s;
    k -= f / (kGravity_m_s2 + 3.0 * kTension_m3_s2 * k * k);
  }
  return k;
}

// Quantile of the spread cos^2s about the mean direction, s by Mitsuyasu et al. 1975 reduced to two
// constants: 10 at the peak, falling as (w / peak)^-2.5 above, no less than 1. By the sum over 256
// steps.
double spread_quantile(double s, double share) {
  constexpr int kSteps = 256;
  double whole = 0.0;
  const auto weight = [&](int i) {
    const double angle = ((i + 0.5) / kSteps - 0.5) * kPi;  // half of the turn from the mean
    return std::pow(std::cos(angle), 2.0 * s);
  };
  for (int i = 0; i < kSteps; ++i) whole += weight(i);
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double w = weight(i);
    if (sum + w >= share * whole)
      return ((i + (share * whole - sum) / std::max(w, 1e-300)) / kSteps - 0.5) * 2.0 * kPi;
    sum += w;
  }
  return kPi;
}

double fetch_number(const SeaState& sea) {
  return kGravity_m_s2 * sea.fetch_m / (sea.wind_m_s * sea.wind_m_s);
}

}  // namespace

double jonswap_peak(const SeaState& sea) {
  // Hasselmann 1973: peak frequency 3.5 g / U x^-0.33; not below that of a fully grown sea (Pierson
  // and Moskowitz 1964: 0.13 g / U).
  const double hertz =
      std::max(3.5 * std::pow(fetch_number(sea), -0.33), 0.13) * kGravity_m_s2 / sea.wind_m_s;
  return 2.0 * kPi * hertz;
}

double jonswap(const SeaState& sea, double angular_s) {
  if (!(angular_s > 0.0) || !(sea.wind_m_s > 0.0)) return 0.0;
  const double peak = jonswap_peak(sea);
  // Where the sea is fully grown alpha is Phillips' of Pierson and Moskowitz.
  const double alpha = std::max(0.076 * std::pow(fetch_number(sea), -0.22), 0.0081);
  constexpr double kGamma = 3.3;
  const double width = angular_s <= peak ? 0.07 : 0.09;
  const double off = (angular_s / peak - 1.0) / width;
  const double ratio = peak / angular_s;
  return alpha * kGravity_m_s2 * kGravity_m_s2 / std::pow(angular_s, 5.0) *
         std::exp(-1.25 * ratio * ratio * ratio * ratio) *
         std::pow(kGamma, std::exp(-0.5 * off * off));
}

SeaWaves::SeaWaves(const SeaState& sea) {
  // Cox and Munk 1954: mean square slope of a clean surface, both axes.
  const double slope2 = 0.003 + 0.00512 * std::max(sea.wind_m_s, 0.0);
  fine_slope2_ = slope2;
  if (!(sea.wind_m_s > 0.0) || sea.components == 0) return;
  const double peak = jonswap_peak(sea);
  const double first = 0.6 * peak;
  const double last = std::max(angular_of(2.0 * kPi / kShortest_m), 1.5 * peak);
  const RandomKey key{.seed = sea.seed, .stream = kWaveStream};
  const double step = std::log(last / first) / sea.components;
  for (std::uint32_t i = 0; i < sea.components; ++i) {
    // One wave a band of equal ratio, with the band's energy and a random place in it.
    const double low = first * std::exp(step * i);
    constexpr int kParts = 64;
    double energy_m2 = 0.0;
    for (int part = 0; part < kParts; ++part) {
      const double w = low * std::exp(step * (part + 0.5) / kParts);
      energy_m2 += jonswap(sea, w) * w * step / kParts;
    }
    SeaWave wave;
    wave.angular_s = low * std::exp(step * random_uniform(key, 3 * i));
    const double k = wave_number_of(wave.angular_s);
    wave.amplitude_m = std::sqrt(2.0 * energy_m2);
    wave.phase_rad = 2.0 * kPi * random_uniform(key, 3 * i + 1);
    // Directions are spread evenly over the quantiles, so that few waves already lie on both sides.
    const double even =
        std::fmod((i + 1) * 0.6180339887498949 + 0.2 * random_uniform(key, 3 * i + 2), 1.0);
    const double s = std::max(10.0 * std::pow(std::max(wave.angular_s / peak, 1.0), -2.5), 1.0);
    const double direction = sea.direction_rad + spread_quantile(s, even);
    wave.wave_number_m = k * Vec2(std::sin(direction), -std::cos(direction));
    height_rms_m_ += energy_m2;
    slope2_ += energy_m2 * k * k;
    waves_.push_back(wave);
  }
  height_rms_m_ = std::sqrt(height_rms_m_);
  fine_slope2_ = std::max(slope2 - slope2_, 0.001);
  foam_share_ = std::min(3.84e-6 * std::pow(sea.wind_m_s, 3.41), 1.0);
}

double SeaWaves::angle_rad(const SeaWave& wave, double x_m, double z_m, double time_s) {
  return std::remainder(wave.wave_number_m.x * x_m + wave.wave_number_m.y * z_m -
                            wave.angular_s * time_s + wave.phase_rad,
                        2.0 * kPi);
}

double SeaWaves::height_m(double x_m, double z_m, double time_s) const {
  double height = 0.0;
  for (const SeaWave& wave : waves_)
    height += wave.amplitude_m * std::cos(angle_rad(wave, x_m, z_m, time_s));
  return height;
}

Vec2 SeaWaves::slope(double x_m, double z_m, double time_s) const {
  Vec2 slope(0.0);
  for (const SeaWave& wave : waves_)
    slope -= wave.amplitude_m * std::sin(angle_rad(wave, x_m, z_m, time_s)) * wave.wave_number_m;
  return slope;
}

WaveFlow SeaWaves::flow(const Vec3& point_m, double time_s) const {
  WaveFlow out;
  const bool under = point_m.y < 0.0;
  for (const SeaWave& wave : waves_) {
    const double k = glm::length(wave.wave_number_m);
    // Below -700 / k the exponential is 0 in double.
    const double head = wave.amplitude_m * (under ? std::exp(k * point_m.y) : 1.0);
    if (head == 0.0) continue;
    const double speed = head * wave.angular_s;
    const double angle = angle_rad(wave, point_m.x, point_m.z, time_s);
    const double cosine = speed * std::cos(angle), sine = speed * std::sin(angle);
    const Vec2 way = wave.wave_number_m / k;
    const Vec3 velocity(way.x * cosine, sine, way.y * cosine);
    const Vec3 by_angle(-way.x * sine, cosine, -way.y * sine);  // d velocity / d angle
    out.velocity_m_s += velocity;
    out.rate_m_s2 -= wave.angular_s * by_angle;
    out.gradient_per_s[0] += wave.wave_number_m.x * by_angle;
    out.gradient_per_s[2] += wave.wave_number_m.y * by_angle;
    if (under) out.gradient_per_s[1] += k * velocity;
    out.head_m += head * std::cos(angle);
  }
  return out;
}

Vec3 SeaWaves::height_and_slopes(const Vec2& center_m, const Vec2& length_breadth_m,
                                 double heading_rad, double time_s) const {
  const Vec2 ahead(std::sin(heading_rad), -std::cos(heading_rad)), aside(-ahead.y, ahead.x);
  // The mean of a cosine over a length is its value at the middle times sinc; of the slope of the
  // fitted line 3 (sin u - u cos u) / u^3, with u half the length times the wave number along it.
  const auto mean = [](double u) { return std::abs(u) < 1e-4 ? 1.0 : std::sin(u) / u; };
  const auto tilt = [](double u) {
    return std::abs(u) < 1e-2 ? 1.0 - 0.1 * u * u
                              : 3.0 * (std::sin(u) - u * std::cos(u)) / (u * u * u);
  };
  double height = 0.0;
  Vec2 slope(0.0);
  for (const SeaWave& wave : waves_) {
    const double along = glm::dot(wave.wave_number_m, ahead),
                 across = glm::dot(wave.wave_number_m, aside);
    const double u = 0.5 * along * length_breadth_m.x, v = 0.5 * across * length_breadth_m.y;
    const double angle = angle_rad(wave, center_m.x, center_m.y, time_s);
    height += wave.amplitude_m * std::cos(angle) * mean(u) * mean(v);
    const double sine = -wave.amplitude_m * std::sin(angle);
    slope += sine * (along * tilt(u) * mean(v) * ahead + across * tilt(v) * mean(u) * aside);
  }
  return {height, slope.x, slope.y};
}

}  // namespace neritic
