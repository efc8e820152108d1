// Ticks, numbers, resampling and colour maps.
#include "engine/draw2d/axes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/draw2d/resample.hpp"

namespace neritic::draw2d {
namespace {

constexpr float kNanPixel = std::numeric_limits<float>::quiet_NaN();

TEST(Axes, TicksAreRoundNumbersInsideTheSpan) {
  EXPECT_EQ(nice_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(nice_ticks(7.5, -7.5, 3), (std::vector<double>{-5, 0, 5}));
  EXPECT_TRUE(nice_ticks(3, 3, 5).empty());
  EXPECT_TRUE(nice_ticks(0, kNanPixel, 5).empty());
  EXPECT_LT(nice_ticks(1e17, 1e17 + 64, 50).size(), 60u);
  for (const double value : {0.011, 0.02, 3.0, 49.99, 50.0, 1e6}) {
    const double nice = nice_at_most(value);
    EXPECT_LE(nice, value * 1.000001);
    EXPECT_GT(nice * 2.51, value);
  }
  EXPECT_EQ(number_text(0.1 + 0.2), "0.3");
  EXPECT_EQ(number_text(-1e-9), "0");
  EXPECT_EQ(number_text(-12.5), "\u221212.5");
}

TEST(Resample, ResamplingKeepsTheMeanAndLeavesOutHoles) {
  std::vector<float> values;
  for (int i = 0; i < 35; ++i) values.push_back(static_cast<float>((i * 17) % 11));
  double mean = 0.0;
  for (const float v : values) mean += v / 35.0;
  for (const auto& [w, h] : {std::pair{1u, 1u}, {3u, 2u}, {7u, 5u}, {40u, 33u}}) {
    const ImageF32 out = resample_area(values, 5, 7, w, h);
    double sum = 0.0;
    for (const float v : out.data) sum += v / static_cast<double>(w * h);
    EXPECT_NEAR(sum, mean, 1e-5) << w << " x " << h;
  }
  EXPECT_EQ(resample_area(values, 5, 7, 7, 5).data, values);
  const std::vector<float> holes{kNanPixel, 2, kNanPixel, kNanPixel};
  EXPECT_EQ(resample_area(holes, 2, 2, 1, 1).data[0], 2.0f);
  EXPECT_TRUE(std::isnan(resample_area(holes, 2, 2, 1, 2).data[1]));
}

TEST(ColorMaps, MapsGrowBrighterOrStayInRange) {
  for (const auto map : {ColorMap::kCopper, ColorMap::kBronze, ColorMap::kEcho, ColorMap::kDepth})
    for (const double v : {-1.0, 0.0, 0.3, 1.0, 7.0, std::nan("")}) {
      const Color c = map_color(map, v);
      for (const float channel : {c.r, c.g, c.b}) {
        EXPECT_GE(channel, 0.0f);
        EXPECT_LE(channel, 1.0f);
      }
    }
  double before = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const Color c = map_color(ColorMap::kBronze, i / 100.0);
    const double brightness = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    EXPECT_GT(brightness, before);
    before = brightness;
  }
}

TEST(Axes, NumbersThatCannotCollideDoNot) {
  // Labels of a narrow plot: as many ticks as have room, none at the same place.
  for (const double span : {1e-6, 0.3, 7.0, 1234.0})
    for (const double count : {1.0, 3.0, 12.0}) {
      const std::vector<double> ticks = nice_ticks(2.0, 2.0 + span, count);
      EXPECT_LE(static_cast<double>(ticks.size()), count + 2.0);
      EXPECT_GE(static_cast<double>(ticks.size()), count / 3.0 - 1.0);
    }
}

}  // namespace
}  // namespace neritic::draw2d
