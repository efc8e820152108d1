// Lenses in double precision: the same models as shaders/shared/lens.h, and the pinhole that a
// lens's picture is made from.
#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/scene/camera_terms.hpp"

namespace neritic::scene {
namespace {

constexpr double kWidest_rad = 80.0 * kPi / 180.0;
constexpr int kMargin_px = 2;

double fisheye_radius(const Lens& lens, double angle) {
  const double a2 = angle * angle;
  const auto& k = lens.k;
  return angle * (1.0 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
}

double fisheye_slope(const Lens& lens, double angle) {
  const double a2 = angle * angle;
  const auto& k = lens.k;
  return 1.0 + a2 * (3.0 * k[0] + a2 * (5.0 * k[1] + a2 * (7.0 * k[2] + a2 * 9.0 * k[3])));
}

// The derivative of through_lens, by columns.
glm::dmat2 brown_slope(const Lens& lens, const glm::dvec2& t) {
  const auto& k = lens.k;
  const auto& p = lens.p;
  const double r2 = glm::dot(t, t);
  const double radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
  const double slope = 2.0 * (k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[2]));
  const double xy = t.x * t.y * slope + 2.0 * (p[0] * t.x + p[1] * t.y);
  return {radial + t.x * t.x * slope + 2.0 * p[0] * t.y + 6.0 * p[1] * t.x, xy, xy,
          radial + t.y * t.y * slope + 6.0 * p[0] * t.y + 2.0 * p[1] * t.x};
}

}  // namespace

double ImageSensor::saturation() const {
  return std::exp2(saturation_ev);
}

double ImageSensor::electrons_per_unit() const {
  return full_well_e * std::pow(10.0, -gain_db / 20.0) / saturation();
}

// Angles to the axis on both sides of a port, by Snell. A dome's entrance pupil lies `offset` of
// its radius before its centre: a ray at the angle a in air meets it at an incidence whose sine is
// offset sin a. Distances are long against port and pupil, so that both sides share one centre.
static double water_angle(const Port& port, double air_rad) {
  if (port.kind == PortKind::kFlat) return std::asin(std::sin(air_rad) / kPortIndex);
  const double sine = port.offset * std::sin(air_rad);
  return air_rad - std::asin(sine) + std::asin(sine / kPortIndex);
}

static double air_angle(const Port& port, double water_rad) {
  if (port.kind == PortKind::kFlat)
    return std::asin(std::min(kPortIndex * std::sin(water_rad), 1.0));
  double low = 0.0, high = kPi / 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (water_angle(port, middle) < water_rad ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Points of the planes at distance 1 in air and in water.
static glm::dvec2 into_water(const Port& port, const glm::dvec2& air) {
  const double r = glm::length(air);
  if (port.kind == PortKind::kNone || !(r > 1e-12)) return air;
  return air * (std::tan(water_angle(port, std::atan(r))) / r);
}

static glm::dvec2 into_air(const Port& port, const glm::dvec2& water) {
  const double r = glm::length(water);
  if (port.kind == PortKind::kNone) return water;
  // Directions that total reflection keeps out lie beyond all pictures.
  const double angle = air_angle(port, std::atan(r));
  if (!(angle < radians(89.9))) return r > 0.0 ? water * (1e6 / r) : water;
  return r > 1e-12 ? water * (std::tan(angle) / r) : water;
}

static glm::dvec2 distorted(const Lens& lens, const glm::dvec2& t) {
  if (lens.model == LensModel::kFisheye) {
    const double r = glm::length(t);
    return r > 1e-12 ? t * (fisheye_radius(lens, std::atan(r)) / r) : t;
  }
  const auto& k = lens.k;
  const auto& p = lens.p;
  const double r2 = glm::dot(t, t);
  const double radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
  return {t.x * radial + 2.0 * p[0] * t.x * t.y + p[1] * (r2 + 2.0 * t.x * t.x),
          t.y * radial + p[0] * (r2 + 2.0 * t.y * t.y) + 2.0 * p[1] * t.x * t.y};
}

glm::dvec2 through_lens(const Lens& lens, const glm::dvec2& plane) {
  return distorted(lens, into_air(lens.port, plane));
}

static double magnification(const Lens& lens) {
  // On the axis: of a flat port n, of a dome 1 / (1 - e + e / n).
  if (lens.port.kind == PortKind::kNone) return 1.0;
  constexpr double kSmall = 1e-4;
  return into_air(lens.port, {kSmall, 0.0}).x / kSmall;
}

bool unfolded(const Lens& lens, const glm::dvec2& in_water) {
  constexpr int kSteps = 32;
  const glm::dvec2 plane = into_air(lens.port, in_water);
  if (!(glm::length(plane) < 1e5)) return false;
  for (int i = 0; i <= kSteps; ++i) {
    const glm::dvec2 t = plane * (double(i) / kSteps);
    const bool good =
        lens.model == LensModel::kFisheye
            ? fisheye_slope(lens, std::atan(glm::length(t))) > 0.0
            : glm::determinant(brown_slope(lens, t)) > 0.0 && brown_slope(lens, t)[0][0] > 0.0;
    if (!good) return false;
  }
  return true;
}

static glm::dvec2 undistorted(const Lens& lens, const glm::dvec2& image) {
  if (lens.model == LensModel::kFisheye) {
    const double r = glm::length(image);
    if (!(r > 1e-12)) return image;
    constexpr double kLast = 1.4835;
    double angle = std::min(r, kLast);
    for (int i = 0; i < 20; ++i)
      angle = std::clamp(
          angle - (fisheye_radius(lens, angle) - r) / std::max(fisheye_slope(lens, angle), 1e-6),
          0.0, kLast);
    return image * (std::tan(angle) / r);
  }
  glm::dvec2 t = image;
  for (int i = 0; i < 20; ++i) {
    const glm::dmat2 slope = brown_slope(lens, t);
    if (!(std::abs(glm::determinant(slope)) > 1e-15)) break;
    t -= glm::inverse(slope) * (distorted(lens, t) - image);
  }
  return t;
}

glm::dvec2 before_lens(const Lens& lens, const glm::dvec2& image) {
  return into_water(lens.port, undistorted(lens, image));
}

Result<LensView> lens_view(const Lens& lens, std::uint32_t width, std::uint32_t height,
                           double fov_rad) {
  const bool fisheye = lens.model == LensModel::kFisheye;
  const double edge = fisheye ? fisheye_radius(lens, fov_rad / 2.0) : std::tan(fov_rad / 2.0);
  const char* accepted =
      "coefficients and a field of view with which each pixel has one ray of its own, at most 80 "
      "degrees off the axis";
  LensView out;
  const double focal = height / 2.0 / edge;
  if (!(edge > 0.0) || !std::isfinite(focal))
    return refusal("lens", "a picture that folds", accepted);
  out.lens = {focal, focal, width / 2.0, height / 2.0};
  glm::dvec2 low(1e9), high(-1e9);
  const auto add = [&](double x_px, double y_px) -> Status {
    const glm::dvec2 image((x_px - out.lens.cx) / focal, (y_px - out.lens.cy) / focal);
    const glm::dvec2 plane = before_lens(lens, image);
    const double off_px = glm::length(through_lens(lens, plane) - image) * focal;
    if (!(off_px < 0.01) || !unfolded(lens, plane))
      return refusal("lens", fmt::format("no ray for pixel {:.0f}, {:.0f}", x_px, y_px), accepted);
    if (const double angle = std::atan(glm::length(plane)); angle > kWidest_rad)
      return refusal("lens",
                     fmt::format("{:.1f} degrees off the axis at pixel {:.0f}, {:.0f}",
                                 degrees(angle), x_px, y_px),
                     accepted);
    low = glm::min(low, plane);
    high = glm::max(high, plane);
    return {};
  };
  constexpr int kSteps = 64;  // a side
  for (int i = 0; i <= kSteps; ++i) {
    const double x = double(width) * i / kSteps, y = double(height) * i / kSteps;
    NERITIC_TRY_STATUS(add(x, 0.0));
    NERITIC_TRY_STATUS(add(x, height));
    NERITIC_TRY_STATUS(add(0.0, y));
    NERITIC_TRY_STATUS(add(width, y));
  }
  // As fine as the lens's picture is in its middle.
  const double fine = focal * magnification(lens);
  const double left = std::floor(low.x * fine) - kMargin_px,
               right = std::ceil(high.x * fine) + kMargin_px;
  const double top = std::floor(low.y * fine) - kMargin_px,
               bottom = std::ceil(high.y * fine) + kMargin_px;
  out.width = static_cast<std::uint32_t>(right - left);
  out.height = static_cast<std::uint32_t>(bottom - top);
  out.source = {fine, fine, -left, -top};
  out.tangents = {left / fine, right / fine, -bottom / fine, -top / fine};
  return out;
}

}  // namespace neritic::scene
