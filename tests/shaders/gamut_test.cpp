// Colours outside of sRGB come into it at their hue and lightness. tests/support/oklab.hpp measures
// both in double and finds the gamut's edge in another way than the shader's function.
#include "shared/gamut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/oklab.hpp"

namespace neritic::shared {
namespace {

using test::edge_chroma;
using test::in_srgb;
using test::Lch;
using test::linear_srgb;
using test::oklab;

Vec3 mapped(const Vec3& c) {
  return Vec3(map_into_gamut(Vec3f(c)));
}

double encoded_level(double x) {
  return 255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055);
}

// Colours of saturated light after a tone curve: some channels lie below 0, some above 1.
std::vector<Vec3> wide_colours() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> channel(-0.4, 1.4), scale(0.02, 1.0);
  std::vector<Vec3> colours;
  for (int i = 0; i < 20000; ++i) {
    const double brightness = scale(random);
    colours.push_back(brightness * Vec3(channel(random), channel(random), channel(random)));
  }
  return colours;
}

TEST(Gamut, ColoursInsideTheKneeKeepEveryBitAndAreMappedAgainToThemselves) {
  int kept = 0;
  for (int r = 0; r <= 16; ++r)
    for (int g = 0; g <= 16; ++g)
      for (int b = 0; b <= 16; ++b) {
        const Vec3f c(static_cast<float>(r) / 16.0f, static_cast<float>(g) / 16.0f,
                      static_cast<float>(b) / 16.0f);
        const Lch colour = oklab(Vec3(c));
        if (colour.lightness > 0.999) continue;
        if (colour.chroma > (kGamutKnee - 0.01) * edge_chroma(colour.lightness, colour.hue_rad))
          continue;
        ++kept;
        EXPECT_EQ(map_into_gamut(c), c) << r << " " << g << " " << b;
      }
  EXPECT_GT(kept, 1000);
}

TEST(Gamut, HueStaysWithinTwoDegreesAndLightnessWithinAThousandth) {
  int reduced = 0;
  for (const Vec3& c : wide_colours()) {
    const Lch before = oklab(c);
    if (before.lightness < 0.02 || before.lightness > 0.999) continue;
    const Vec3 result = mapped(c);
    ASSERT_TRUE(in_srgb(result));
    const Lch after = oklab(result);
    EXPECT_NEAR(after.lightness, before.lightness, 0.001);
    EXPECT_LE(after.chroma, before.chroma + 0.001);
    if (in_srgb(c) || after.chroma < 0.005) continue;
    ++reduced;
    const double turn = std::remainder(after.hue_rad - before.hue_rad, 2.0 * kPi);
    EXPECT_LT(std::abs(turn), radians(2.0)) << c.x << " " << c.y << " " << c.z;
  }
  EXPECT_GT(reduced, 5000);
}

TEST(Gamut, ChromaRisesAlongARayAsTheFormulaSaysAndStaysInside) {
  constexpr double k = kGamutKnee;
  for (int h = 0; h < 72; ++h)
    for (const double lightness : {0.15, 0.3, 0.5, 0.7, 0.9}) {
      const double hue = h * kPi / 36.0, edge = edge_chroma(lightness, hue);
      double last = 0.0;
      for (double r = 0.02; r < 2.0; r += 0.02) {
        const Vec3 c = linear_srgb({lightness, r * edge, hue});
        const double chroma = oklab(mapped(c)).chroma;
        EXPECT_GE(chroma, last - 2e-4);
        last = chroma;
        const double x = (r - k) / (1.0 - k);
        const double wanted = r < k ? r : k + (1.0 - k) * x / (1.0 + x);
        EXPECT_NEAR(chroma, wanted * edge, 0.01 * edge + 0.001)
            << "hue " << 5 * h << ", lightness " << lightness << ", r " << r;
      }
    }
}

// Steps of a quarter of a level or less come out as steps of less than a level, across the knee and
// the edge.
TEST(Gamut, GradientsOfChromaLightnessAndHueShowNoBands) {
  constexpr int kSteps = 4096;
  const auto check = [](const char* what, const auto& colour_at_share) {
    Vec3 last = mapped(colour_at_share(0.0));
    for (int i = 1; i <= kSteps; ++i) {
      const Vec3 now = mapped(colour_at_share(static_cast<double>(i) / kSteps));
      for (int ch = 0; ch < 3; ++ch)
        EXPECT_LT(std::abs(encoded_level(now[ch]) - encoded_level(last[ch])), 1.0)
            << what << " " << i << " channel " << ch;
      last = now;
    }
  };
  for (const double degrees : {20.0, 140.0, 185.0, 230.0, 255.0, 300.0}) {
    const double hue = radians(degrees);
    check("chroma", [&](double s) { return linear_srgb({0.5, 0.3 * s, hue}); });
    check("lightness", [&](double s) { return linear_srgb({0.1 + 0.8 * s, 0.15, hue}); });
  }
  check("hue", [&](double s) { return linear_srgb({0.5, 0.2, 2.0 * kPi * s}); });
}

TEST(Gamut, AnyNumbersGiveAColour) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  const float values[] = {nan,  infinite, -infinite, 0.0f,  -0.0f,    1e-38f,    -1e-38f, 1e-6f,
                          0.5f, 1.0f,     1.01f,     -1.0f, 65504.0f, -65504.0f, 3.4e38f};
  for (const float r : values)
    for (const float g : values)
      for (const float b : values)
        EXPECT_TRUE(in_srgb(mapped(Vec3(r, g, b)))) << r << " " << g << " " << b;
  EXPECT_EQ(map_into_gamut(Vec3f(0.0f)), Vec3f(0.0f));
  EXPECT_EQ(map_into_gamut(Vec3f(nan)), Vec3f(0.0f));
  EXPECT_EQ(map_into_gamut(Vec3f(infinite)), Vec3f(1.0f));
  EXPECT_EQ(map_into_gamut(Vec3f(0.25f, nan, 0.25f)), map_into_gamut(Vec3f(0.25f, 0.0f, 0.25f)));
}

}  // namespace
}  // namespace neritic::shared
