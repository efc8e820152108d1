#include "sonar/panel.hpp"

#include <gtest/gtest.h>

#include "sonar/levels.hpp"

namespace neritic {
namespace {

using sonar::BeamGrid;
using sonar::SonarImage;

SonarImage silence(const BeamGrid& grid) {
  const std::size_t cells = std::size_t{grid.bins.range} * grid.bins.azimuth;
  return {grid.bins.range, grid.bins.azimuth, std::vector<float>(cells),
          std::vector<std::uint16_t>(cells)};
}

// Centre of what differs between two panels, and how many pixels do.
struct Spot {
  double x = 0, y = 0;
  std::size_t count = 0;
};
Spot difference(const ImageU8& a, const ImageU8& b, std::uint32_t below_row) {
  Spot spot;
  for (std::uint32_t y = below_row; y < a.height; ++y)
    for (std::uint32_t x = 0; x < a.width; ++x)
      if (a.at(x, y, 0) != b.at(x, y, 0) || a.at(x, y, 1) != b.at(x, y, 1)) {
        spot.x += x + 0.5;
        spot.y += y + 0.5;
        ++spot.count;
      }
  spot.x /= static_cast<double>(spot.count);
  spot.y /= static_cast<double>(spot.count);
  return spot;
}

TEST(SonarPanel, AReturnIsDrawnAtItsBearingAndRange) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {40, 45, 10});
  const sonar::PanelOptions options{.height_px = 600, .full_scale = 1.0};
  const sonar::PolarPanel panel(grid, options);
  const ImageU8 quiet = panel.draw(silence(grid));
  const auto spot_of = [&](std::uint32_t row, std::uint32_t column) {
    SonarImage image = silence(grid);
    image.intensity[row * 45 + column] = 1.0f;
    const ImageU8 loud = panel.draw(image);
    EXPECT_EQ(loud.width, quiet.width);
    return difference(quiet, loud, 0);
  };
  const Spot ahead = spot_of(20, 22), farther = spot_of(39, 22), port = spot_of(20, 0),
             starboard = spot_of(20, 44);
  EXPECT_GT(ahead.count, 50u);
  EXPECT_NEAR(ahead.x, farther.x, 1.0);
  EXPECT_LT(farther.y, ahead.y);
  EXPECT_NEAR(ahead.x - port.x, starboard.x - ahead.x, 2.0);
  // Pixels a metre from two ranges ahead; the port edge column then lies at 44 degrees on that
  // radius.
  const double scale = (ahead.y - farther.y) / (grid.range_m(39) - grid.range_m(20));
  EXPECT_NEAR(ahead.x - port.x, grid.range_m(20) * scale * std::sin(-grid.azimuth_rad(0)), 2.0);
}

TEST(SonarPanel, TheDataAreUntouchedAndSilenceIsDrawn) {
  for (const double aperture : {1.0, 90.0, 170.0, 270.0, 360.0})
    for (const std::uint32_t bins : {1u, 33u}) {
      const BeamGrid grid =
          sonar::symmetric_grid(0.5, 20, radians(aperture), radians(10), {bins, bins, bins});
      const ImageU8 panel = sonar::draw_panel(grid, silence(grid), {.height_px = 300});
      EXPECT_EQ(panel.height, 300u);
      EXPECT_EQ(panel.channels, 3u);
      EXPECT_GE(panel.width, 100u);
    }
}

TEST(SonarPanel, AutoGainIsAHighPercentileOfWhatIsHeard) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {100, 100, 1});
  SonarImage image = silence(grid);
  EXPECT_EQ(sonar::panel_full_scale(image, {}), 1.0);
  for (int i = 0; i < 1000; ++i) image.intensity[i * 7] = 0.001f * static_cast<float>(i + 1);
  EXPECT_NEAR(sonar::panel_full_scale(image, {}), 0.995, 0.002);
  EXPECT_EQ(sonar::panel_full_scale(image, {.full_scale = 0.25}), 0.25);
}

TEST(Levels, ThePercentileIsOfWhatIsHeard) {
  std::vector<float> values(1000, 0.0f);
  EXPECT_EQ(sonar::percentile_of_heard(values, 0.9), 1.0);
  for (int i = 0; i < 101; ++i) values[i * 9] = static_cast<float>(i + 1);
  values[1] = std::nanf("");
  EXPECT_EQ(sonar::percentile_of_heard(values, 0.5), 51.0);
  EXPECT_EQ(sonar::percentile_of_heard(values, 1.0), 101.0);
}

}  // namespace
}  // namespace neritic
