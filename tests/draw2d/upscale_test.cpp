// Pictures and panels on the host, against sums in double.
#include "engine/draw2d/upscale.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/random.hpp"

namespace neritic::draw2d {
namespace {

std::vector<std::uint8_t> noise(std::size_t size, std::uint64_t seed) {
  std::vector<std::uint8_t> out(size);
  for (std::size_t i = 0; i < size; ++i)
    out[i] = static_cast<std::uint8_t>(256.0 * random_uniform(RandomKey{.seed = seed}, i));
  return out;
}

// Channel c of the picture at a place in pixels, whose middles lie at halves.
double bilinear(const std::vector<std::uint8_t>& rgba, int width, int height, double x, double y,
                int c) {
  x = std::clamp(x - 0.5, 0.0, width - 1.0);
  y = std::clamp(y - 0.5, 0.0, height - 1.0);
  const int x0 = int(x), y0 = int(y), x1 = std::min(x0 + 1, width - 1),
            y1 = std::min(y0 + 1, height - 1);
  const auto at = [&](int i, int k) { return double(rgba[std::size_t(4 * (k * width + i) + c)]); };
  const double a = std::lerp(at(x0, y0), at(x1, y0), x - x0);
  const double b = std::lerp(at(x0, y1), at(x1, y1), x - x0);
  return std::lerp(a, b, y - y0);
}

TEST(Upscale, APictureOfAnySizeIsBilinearToTwoLevels) {
  constexpr int kSizes[][4] = {{7, 5, 31, 23}, {1, 1, 19, 3}, {40, 30, 41, 29}, {33, 9, 12, 4}};
  for (const auto& [from_width, from_height, width, height] : kSizes) {
    const auto from = noise(std::size_t(4 * from_width * from_height), 3);
    std::vector<std::uint8_t> to(std::size_t(4 * width * height));
    upscale_to_bgra(from, std::uint32_t(from_width), std::uint32_t(from_height), to,
                    std::uint32_t(width), std::uint32_t(height));
    double worst = 0.0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < 4; ++c) {
          const double wanted =
              bilinear(from, from_width, from_height, (x + 0.5) * from_width / width,
                       (y + 0.5) * from_height / height, c);
          const int place = c == 3 ? 3 : 2 - c;
          worst = std::max(worst, std::abs(wanted - to[std::size_t(4 * (y * width + x) + place)]));
        }
    EXPECT_LT(worst, 2.0) << from_width << " x " << from_height;
  }
}

TEST(Upscale, APictureOfTheSameSizeIsTheSameToTheLastBit) {
  const auto from = noise(4 * 21 * 13, 5);
  std::vector<std::uint8_t> to(from.size());
  upscale_to_bgra(from, 21, 13, to, 21, 13);
  for (std::size_t i = 0; i < from.size(); i += 4) {
    EXPECT_EQ(to[i], from[i + 2]);
    EXPECT_EQ(to[i + 1], from[i + 1]);
    EXPECT_EQ(to[i + 2], from[i]);
  }
}

TEST(Upscale, APanelLiesOverThePictureByItsAlphaWhereItsPartReachesAndNowhereElse) {
  constexpr int kWidth = 16, kHeight = 12, kPanelWidth = 10;
  auto panel = noise(4 * kPanelWidth * 8, 7);
  for (std::size_t i = 0; i < panel.size(); i += 4)  // colour is at most alpha
    for (std::size_t c = 0; c < 3; ++c)
      panel[i + c] = static_cast<std::uint8_t>(panel[i + c] * panel[i + 3] / 255);
  const auto before = noise(4 * kWidth * kHeight, 9);
  // Beyond the left, beyond the right and the bottom, and inside.
  for (const auto& [left, top] : {std::pair(-3, -2), std::pair(11, 9), std::pair(4, 2)}) {
    auto picture = before;
    const PixelRect part{2, 1, 6, 5};
    lay_over(panel, kPanelWidth, part, left, top, picture, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (int c = 0; c < 3; ++c) {
          const auto at = std::size_t(4 * (y * kWidth + x));
          const int px = x - left, py = y - top;
          double wanted = before[at + std::size_t(2 - c)];
          if (px >= 2 && px < 8 && py >= 1 && py < 6) {
            const auto from = std::size_t(4 * (py * kPanelWidth + px));
            wanted = panel[from + std::size_t(c)] + wanted * (255 - panel[from + 3]) / 255.0;
          }
          EXPECT_NEAR(picture[at + std::size_t(2 - c)], wanted, 0.51) << x << ' ' << y;
        }
  }
}

}  // namespace
}  // namespace neritic::draw2d
