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

glm::dvec2 through_lens(const Lens& lens, const glm::dvec2& t) {
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

bool unfolded(const Lens& lens, const glm::dvec2& plane) {
  constexpr int kSteps = 32;
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

glm::dvec2 before_lens(const Lens& lens, const glm::dvec2& image) {
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
    t -= glm::inverse(slope) * (through_lens(lens, t) - image);
  }
  return t;
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
  const double left = std::floor(low.x * focal) - kMargin_px,
               right = std::ceil(high.x * focal) + kMargin_px;
  const double top = std::floor(low.y * focal) - kMargin_px,
               bottom = std::ceil(high.y * focal) + kMargin_px;
  out.width = static_cast<std::uint32_t>(right - left);
  out.height = static_cast<std::uint32_t>(bottom - top);
  out.source = {focal, focal, -left, -top};
  out.tangents = {left / focal, right / focal, -bottom / focal, -top / focal};
  return out;
}

}  // namespace neritic::scene
