#include "sonar/sidescan_from_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace neritic {
namespace {

using sonar::PictureLineOptions;
using sonar::SeabedPicture;

SeabedPicture even_picture(double altitude_m) {
  SeabedPicture p;
  p.brightness = ImageF32(801, 101, 1, 1.0f);
  p.intrinsics = {200.0, 200.0, 400.5, 50.5};
  p.altitude_m = altitude_m;
  return p;
}

TEST(SidescanFromImage, AnEvenFlatBottomIsSymmetricAndBeginsAtTheAltitude) {
  const double h = 8.0;
  const PictureLineOptions options{.n_range = 200, .range_max_m = 20.0};
  const auto line = sonar::sidescan_from_picture(even_picture(h), options).value();
  double sum = 0.0;
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_NEAR(line.port[i], line.starboard[i], 1e-5);
    const double r0 = 0.1 * static_cast<double>(i), r1 = r0 + 0.1;
    // Width of picture between two slant ranges: fx (tan a1 - tan a0), tan a = sqrt(r^2 - h^2) / h.
    const double end = h * std::hypot(1.0, 400.5 / 200.0);
    const auto across = [&](double r) {
      r = std::clamp(r, h, end);
      return 200.0 * std::sqrt(r * r - h * h) / h;
    };
    const double expected = across(r1) - across(r0);
    EXPECT_NEAR(line.starboard[i], expected, 0.03 * expected + 0.35) << i;
    sum += line.starboard[i];
  }
  EXPECT_NEAR(sum, 400.5, 1e-3);  // every pixel of the side, once
}

TEST(SidescanFromImage, ABrightSpotLandsAtItsSlantRangeOnItsSide) {
  SeabedPicture p = even_picture(10.0);
  std::fill(p.brightness.data.begin(), p.brightness.data.end(), 0.0f);
  p.brightness.at(600, 50) = 1.0f;  // 200 px to starboard: 45 degrees
  const PictureLineOptions options{.n_range = 400, .range_max_m = 20.0};
  const auto line = sonar::sidescan_from_picture(p, options).value();
  double moment = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < 400; ++i) {
    EXPECT_EQ(line.port[i], 0.0f);
    sum += line.starboard[i];
    moment += line.starboard[i] * (static_cast<double>(i) + 0.5) * 0.05;
  }
  EXPECT_NEAR(moment / sum, 10.0 * std::sqrt(2.0), 0.03);
  // The cosine of incidence at 45 degrees, if asked for.
  PictureLineOptions with = options;
  with.incidence = true;
  const auto weighted = sonar::sidescan_from_picture(p, with).value();
  EXPECT_NEAR(std::accumulate(weighted.starboard.begin(), weighted.starboard.end(), 0.0),
              sum * std::sqrt(0.5), 0.01 * sum);
  // A row that the beam does not reach is not heard.
  p.brightness.at(600, 50) = 0.0f;
  p.brightness.at(600, 58) = 1.0f;
  const auto narrow = sonar::sidescan_from_picture(p, options).value();
  EXPECT_EQ(std::accumulate(narrow.starboard.begin(), narrow.starboard.end(), 0.0f), 0.0f);
}

TEST(SidescanFromImage, WithDepthAWallHidesWhatIsBehindAndLeavesAShadow) {
  SeabedPicture p = even_picture(10.0);
  p.depth_m.assign(p.brightness.data.size(), 10.0f);
  // From 100 px on, to starboard, for 40 px the top of a box 6 m below: it hides the floor behind.
  for (std::uint32_t row = 0; row < 101; ++row)
    for (std::uint32_t column = 500; column < 540; ++column) p.depth_m[row * 801 + column] = 6.0f;
  const PictureLineOptions options{.n_range = 400, .range_max_m = 20.0};
  const auto line = sonar::sidescan_from_picture(p, options).value();
  const auto heard = [&](double from_m, double to_m) {
    double sum = 0.0;
    for (std::size_t i = static_cast<std::size_t>(from_m / 0.05 + 0.5); i * 0.05 < to_m - 1e-9; ++i)
      sum += line.starboard[i];
    return sum;
  };
  EXPECT_GT(heard(6.7, 7.35), 30.0);  // the top, nearer than the floor
  EXPECT_EQ(heard(11.3, 12.1), 0.0);  // the shadow
  EXPECT_GT(heard(12.4, 14.0), 30.0);
  p.depth_m.assign(p.depth_m.size(), INFINITY);
  const auto empty = sonar::sidescan_from_picture(p, options).value();
  EXPECT_EQ(std::accumulate(empty.starboard.begin(), empty.starboard.end(), 0.0f), 0.0f);
}

TEST(SidescanFromImage, BrightnessIsLinearLuminance) {
  ImageU8 rgb(3, 1, 3);
  rgb.data = {255, 255, 255, 0, 255, 0, 188, 188, 188};
  const ImageF32 b = sonar::brightness_of(rgb);
  EXPECT_NEAR(b.data[0], 1.0f, 1e-5);
  EXPECT_NEAR(b.data[1], 0.7152f, 1e-5);
  EXPECT_NEAR(b.data[2], 0.5029f, 1e-3);  // sRGB 188 is half of the light
  ImageU8 grey(1, 1, 1);
  grey.data = {188};
  EXPECT_NEAR(sonar::brightness_of(grey).data[0], b.data[2], 1e-6);
}

TEST(SidescanFromImage, WhatDoesNotFitIsNamed) {
  const auto refuses = [](const SeabedPicture& p, const PictureLineOptions& o, const char* word) {
    const auto result = sonar::sidescan_from_picture(p, o);
    ASSERT_FALSE(result.ok()) << word;
    EXPECT_NE(result.error().message.find(word), std::string::npos) << result.error().message;
    EXPECT_NE(result.error().message.find("accepted"), std::string::npos);
  };
  SeabedPicture p = even_picture(10.0);
  p.depth_m.assign(3, 1.0f);
  refuses(p, {}, "depths");
  refuses(SeabedPicture{}, {}, "pixels");
  refuses(even_picture(-1.0), {}, "altitude");
  refuses(even_picture(10.0), {.n_range = 0}, "bins");
  refuses(even_picture(10.0), {.beam_along_rad = 4.0}, "beam");
  p = even_picture(10.0);
  p.intrinsics.fx = 0.0;
  refuses(p, {}, "focal");
  p = even_picture(10.0);
  p.intrinsics.cy = -500.0;
  refuses(p, {}, "rows");
}

}  // namespace
}  // namespace neritic
