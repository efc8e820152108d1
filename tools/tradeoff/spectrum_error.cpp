#include "tools/tradeoff/spectrum_error.hpp"

#include <cmath>

#include "engine/render/bands.hpp"

namespace neritic::tools {
namespace {

// IEC 61966-2-1.
Vec3 xyz_of(const Vec3& c) {
  return {0.4124 * c.x + 0.3576 * c.y + 0.1805 * c.z, 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z,
          0.0193 * c.x + 0.1192 * c.y + 0.9505 * c.z};
}

double lab_root(double t) {
  constexpr double d = 6.0 / 29.0;
  return t > d * d * d ? std::cbrt(t) : t / (3.0 * d * d) + 4.0 / 29.0;
}

Result<Vec3> whole_spectrum(const std::string& water, double depth_m) {
  Vec3 sum(0.0), white(0.0);
  for (double nm = 400.5; nm < 700.0; nm += 1.0) {
    const render::WaveBand here{nm, nm};
    NERITIC_TRY(const render::WaterOptics optics, render::jerlov_optics(water, {here, here, here}));
    const Vec3 response = render::response_to_daylight({}, nm);
    white += response;
    sum += response * std::exp(-depth_m * optics.diffuse_attenuation_m.x);
  }
  return sum / white;
}

}  // namespace

Vec3 lab_of(const Vec3& linear) {
  const Vec3 t = xyz_of(linear) / xyz_of(Vec3(1.0));
  const double x = lab_root(t.x), y = lab_root(t.y), z = lab_root(t.z);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double delta_e(const Vec3& a_lab, const Vec3& b_lab) {
  const auto seventh = [](double c) {
    const double c7 = std::pow(c, 7.0);
    return std::sqrt(c7 / (c7 + std::pow(25.0, 7.0)));
  };
  const double mean_c = 0.5 * (std::hypot(a_lab.y, a_lab.z) + std::hypot(b_lab.y, b_lab.z));
  const double wider = 1.5 - 0.5 * seventh(mean_c);
  const double a1 = a_lab.y * wider, a2 = b_lab.y * wider;
  const double c1 = std::hypot(a1, a_lab.z), c2 = std::hypot(a2, b_lab.z);
  const auto hue = [](double a, double b) {
    const double h = std::atan2(b, a);
    return h < 0.0 ? h + 2.0 * kPi : h;
  };
  const double h1 = hue(a1, a_lab.z), h2 = hue(a2, b_lab.z);
  const bool grey = c1 * c2 == 0.0;
  double turn = grey ? 0.0 : h2 - h1;
  if (turn > kPi) turn -= 2.0 * kPi;
  if (turn < -kPi) turn += 2.0 * kPi;
  const double dl = b_lab.x - a_lab.x, dc = c2 - c1,
               dh = 2.0 * std::sqrt(c1 * c2) * std::sin(0.5 * turn);
  const double l = 0.5 * (a_lab.x + b_lab.x), c = 0.5 * (c1 + c2);
  double h = h1 + h2;
  if (!grey) h = std::abs(h1 - h2) > kPi ? 0.5 * (h + (h < 2.0 * kPi ? 2.0 : -2.0) * kPi) : 0.5 * h;
  const double t = 1.0 - 0.17 * std::cos(h - radians(30.0)) + 0.24 * std::cos(2.0 * h) +
                   0.32 * std::cos(3.0 * h + radians(6.0)) -
                   0.20 * std::cos(4.0 * h - radians(63.0));
  const double l50 = (l - 50.0) * (l - 50.0);
  const double sl = 1.0 + 0.015 * l50 / std::sqrt(20.0 + l50), sc = 1.0 + 0.045 * c,
               sh = 1.0 + 0.015 * c * t;
  const double bend = (degrees(h) - 275.0) / 25.0;
  const double rotation =
      -2.0 * seventh(c) * std::sin(2.0 * radians(30.0) * std::exp(-bend * bend));
  return std::sqrt(dl * dl / (sl * sl) + dc * dc / (sc * sc) + dh * dh / (sh * sh) +
                   rotation * dc / sc * dh / sh);
}

Result<double> card_error(const std::string& water, double depth_m, std::uint32_t bands) {
  NERITIC_TRY(const Vec3 whole, whole_spectrum(water, depth_m));
  Vec3 few;
  if (bands == 3) {
    NERITIC_TRY(const render::WaterOptics optics, render::jerlov_optics(water));
    few = glm::exp(-depth_m * optics.diffuse_attenuation_m);
  } else {
    NERITIC_TRY(few,
                render::white_under_water(water, render::make_bands({.bands = bands}), depth_m));
  }
  const double exposure = 0.5 / xyz_of(whole).y;
  return delta_e(lab_of(exposure * whole), lab_of(exposure * few));
}

}  // namespace neritic::tools
