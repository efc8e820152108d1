#include "engine/scene/color_temperature.hpp"

#include <algorithm>

namespace neritic::scene {
namespace {

constexpr double kWhite_k = 6504.0;
const Vec3 kLuminance(0.2126, 0.7152, 0.0722);

// Linear sRGB of luminance 1; the sRGB matrix's white is D65, beside the locus.
Vec3 color_on_locus(double kelvin) {
  const double t = 1000.0 / std::clamp(kelvin, 1667.0, 25000.0);
  const double x = t > 0.25 ? -0.2661239 * t * t * t - 0.2343589 * t * t + 0.8776956 * t + 0.179910
                            : -3.0258469 * t * t * t + 2.1070379 * t * t + 0.2226347 * t + 0.240390;
  const double x2 = x * x, x3 = x2 * x;
  double y = 3.0817580 * x3 - 5.87338670 * x2 + 3.75112997 * x - 0.37001483;
  if (t > 0.25) y = -0.9549476 * x3 - 1.37418593 * x2 + 2.09137015 * x - 0.16748867;
  if (t > 1.0 / 2.222) y = -1.1063814 * x3 - 1.34811020 * x2 + 2.18555832 * x - 0.20219683;
  const Vec3 xyz(x / y, 1.0, (1.0 - x - y) / y);
  return Vec3(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
              -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
              0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
}

}  // namespace

Vec3f color_of_temperature(double kelvin) {
  // As a camera balanced for 6504 K sees it (von Kries 1902, in the channels of sRGB).
  const Vec3 balanced = color_on_locus(kelvin) / color_on_locus(kWhite_k);
  const Vec3 seen = glm::max(balanced, Vec3(0.0));
  return Vec3f(seen / glm::dot(seen, kLuminance));
}

}  // namespace neritic::scene
