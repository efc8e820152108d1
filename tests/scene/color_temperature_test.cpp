// The colour of a lamp's temperature: its luminance, its white, and the CIE's incandescent lamp.
#include "engine/scene/color_temperature.hpp"

#include <gtest/gtest.h>

namespace neritic::scene {
namespace {

double luminance(const Vec3f& rgb) {
  return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

TEST(ColorOfTemperature, HasTheLuminanceOfWhiteAtAnyTemperature) {
  for (double kelvin = 1500.0; kelvin <= 15000.0; kelvin += 250.0)
    EXPECT_NEAR(luminance(color_of_temperature(kelvin)), 1.0, 1e-6) << kelvin;
}

TEST(ColorOfTemperature, IsWhiteAt6504AndBluerAbove) {
  const Vec3f white = color_of_temperature(6504.0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(white[i], 1.0, 1e-6) << i;
  for (double kelvin = 2000.0; kelvin < 15000.0; kelvin += 250.0) {
    const Vec3f less = color_of_temperature(kelvin), more = color_of_temperature(kelvin + 250.0);
    EXPECT_GT(less.x, more.x) << kelvin;
    EXPECT_LT(less.z, more.z) << kelvin;
  }
}

// CIE 15:2004, table T.3: illuminant A is a black body of 2856 K, x = 0.44758, y = 0.40745. The
// body of 6504 K: x = 0.3135, y = 0.3237 (Wyszecki and Stiles 1982, table 1(3.11), between 6500 and
// 6600).
TEST(ColorOfTemperature, IsTheCiesIncandescentLampAt2856) {
  const auto linear = [](double x, double y) {
    const Vec3 xyz(x / y, 1.0, (1.0 - x - y) / y);
    return Vec3(3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
                -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
                0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z);
  };
  Vec3 lamp = linear(0.44758, 0.40745) / linear(0.3135, 0.3237);
  lamp /= luminance(Vec3f(lamp));
  const Vec3f seen = color_of_temperature(2856.0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], lamp[i], 0.005) << i;
}

}  // namespace
}  // namespace neritic::scene
