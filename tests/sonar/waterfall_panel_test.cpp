#include "sonar/waterfall_panel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace neritic {
namespace {

constexpr float kNanPixel = std::numeric_limits<float>::quiet_NaN();

TEST(WaterfallPanel, TicksAreRoundNumbersInsideTheSpan) {
  EXPECT_EQ(sonar::nice_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(sonar::nice_ticks(7.5, -7.5, 3), (std::vector<double>{-5, 0, 5}));
  EXPECT_TRUE(sonar::nice_ticks(3, 3, 5).empty());
  EXPECT_TRUE(sonar::nice_ticks(0, kNanPixel, 5).empty());
  EXPECT_LT(sonar::nice_ticks(1e17, 1e17 + 64, 50).size(), 60u);
  for (const double value : {0.011, 0.02, 3.0, 49.99, 50.0, 1e6}) {
    const double nice = sonar::nice_at_most(value);
    EXPECT_LE(nice, value * 1.000001);
    EXPECT_GT(nice * 2.51, value);
  }
  EXPECT_EQ(sonar::number_text(0.1 + 0.2), "0.3");
  EXPECT_EQ(sonar::number_text(-1e-9), "0");
}

TEST(WaterfallPanel, ResamplingKeepsTheMeanAndLeavesOutHoles) {
  std::vector<float> values;
  for (int i = 0; i < 35; ++i) values.push_back(static_cast<float>((i * 17) % 11));
  double mean = 0.0;
  for (const float v : values) mean += v / 35.0;
  for (const auto& [w, h] : {std::pair{1u, 1u}, {3u, 2u}, {7u, 5u}, {40u, 33u}}) {
    const ImageF32 out = sonar::resample_area(values, 5, 7, w, h);
    double sum = 0.0;
    for (const float v : out.data) sum += v / static_cast<double>(w * h);
    EXPECT_NEAR(sum, mean, 1e-5) << w << " x " << h;
  }
  EXPECT_EQ(sonar::resample_area(values, 5, 7, 7, 5).data, values);
  const std::vector<float> holes{kNanPixel, 2, kNanPixel, kNanPixel};
  EXPECT_EQ(sonar::resample_area(holes, 2, 2, 1, 1).data[0], 2.0f);
  EXPECT_TRUE(std::isnan(sonar::resample_area(holes, 2, 2, 1, 2).data[1]));
}

TEST(WaterfallPanel, PalettesGrowBrighterOrStayInRange) {
  for (const auto palette :
       {sonar::Palette::kBronze, sonar::Palette::kEcho, sonar::Palette::kDepth})
    for (const double v : {-1.0, 0.0, 0.3, 1.0, 7.0, std::nan("")}) {
      const sonar::Color c = sonar::palette_color(palette, v);
      for (const float channel : {c.r, c.g, c.b}) {
        EXPECT_GE(channel, 0.0f);
        EXPECT_LE(channel, 1.0f);
      }
    }
  double before = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const sonar::Color c = sonar::palette_color(sonar::Palette::kBronze, i / 100.0);
    const double brightness = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    EXPECT_GT(brightness, before);
    before = brightness;
  }
}

TEST(WaterfallPanel, ThePercentileIsOfWhatIsHeard) {
  std::vector<float> values(1000, 0.0f);
  EXPECT_EQ(sonar::percentile_of_heard(values, 0.9), 1.0);
  for (int i = 0; i < 101; ++i) values[i * 9] = static_cast<float>(i + 1);
  values[1] = kNanPixel;
  EXPECT_EQ(sonar::percentile_of_heard(values, 0.5), 51.0);
  EXPECT_EQ(sonar::percentile_of_heard(values, 1.0), 101.0);
}

}  // namespace
}  // namespace neritic
