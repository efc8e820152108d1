// The comparison itself: it fails for a shifted level and a lost fish, and passes a driver's noise.
#include "tests/golden/compare.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/random.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/support.hpp"

namespace neritic::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The wreck with its shoal.
ImageU8 wreck() {
  auto read = scene::read_image8(source_dir() / "tests/golden/wreck.overview.png", 3);
  EXPECT_TRUE(read.ok());
  return std::move(read).value();
}

std::vector<std::string> faults(const ImageU8& actual, const ImageU8& golden) {
  const PictureLimits limits;
  return faults_of(difference_of(actual, golden, limits.level), limits);
}

TEST(GoldenCompare, APictureIsLikeItself) {
  const ImageU8 golden = wreck();
  EXPECT_THAT(faults(golden, golden), IsEmpty());
}

TEST(GoldenCompare, NoiseOfOneLevelPasses) {
  const ImageU8 golden = wreck();
  ImageU8 noisy = golden;
  for (std::size_t i = 0; i < noisy.data.size(); ++i) {
    const bool at_end = golden.data[i] == 0 || golden.data[i] == 255;  // noise there is one-sided
    if (!at_end) noisy.data[i] += static_cast<int>(3.0 * random_uniform({7}, i)) - 1;
  }
  EXPECT_EQ(difference_of(noisy, golden, 0).worst, 1);
  EXPECT_THAT(faults(noisy, golden), IsEmpty());
}

// Half a level more is one level more of every second value.
TEST(GoldenCompare, AnImageShiftedByHalfALevelFails) {
  const ImageU8 golden = wreck();
  ImageU8 brighter = golden;
  for (std::size_t i = 1; i < brighter.data.size(); i += 3)  // green
    if (random_uniform({7, 1}, i) < 0.5) brighter.data[i] += golden.data[i] < 255;
  EXPECT_THAT(faults(brighter, golden), ElementsAre(HasSubstr("channel 1 differs by +0.5")));
}

// A fish of 7 by 4 pixels at the side of the shoal, painted over with the water beside it.
TEST(GoldenCompare, AnImageWithASmallFishPaintedOutFails) {
  const ImageU8 golden = wreck();
  ImageU8 without = golden;
  for (std::uint32_t y = 73; y < 84; ++y)
    for (std::uint32_t x = 341; x < 354; ++x)
      for (std::uint32_t channel = 0; channel < 3; ++channel)
        without.at(x, y, channel) = golden.at(357, y, channel);
  EXPECT_THAT(faults(without, golden), ElementsAre(HasSubstr("a patch of ")));
  EXPECT_LT(difference_of(without, golden, 5).patch_px, 60u);
}

// A mask's larger limit is for masked pixels alone.
TEST(GoldenCompare, AMaskCountsItsPatchesApart) {
  const ImageU8 golden(40, 20, 1, 100);
  ImageU16 labels(40, 20, 1, 0);
  for (std::uint32_t y = 5; y < 15; ++y)
    for (std::uint32_t x = 5; x < 15; ++x) labels.at(x, y) = 3;
  const std::vector<bool> mask = mask_of(labels, 3);
  EXPECT_EQ(std::ranges::count(mask, true), 12 * 12);
  const auto changed_at = [&](std::uint32_t left) {
    ImageU8 actual = golden;
    for (std::uint32_t x = left; x < left + 5; ++x)
      for (std::uint32_t y = 7; y < 11; ++y) actual.at(x, y) = 150;
    return difference_of(actual, golden, 5, mask);
  };
  EXPECT_EQ(changed_at(6).masked_patch_px, 20u);
  EXPECT_EQ(changed_at(6).patch_px, 0u);
  EXPECT_EQ(changed_at(25).patch_px, 20u);
  EXPECT_EQ(changed_at(25).masked_patch_px, 0u);
  PictureLimits limits;
  limits.fraction = 1.0;
  limits.mean = 2.0;
  limits.masked_patch_px = 30;
  EXPECT_THAT(faults_of(changed_at(6), limits), IsEmpty());
  EXPECT_THAT(faults_of(changed_at(25), limits), ElementsAre(HasSubstr("a patch of 20 pixels")));
}

TEST(GoldenCompare, PatchesHangTogetherByCornersAndNotRoundTheEdge) {
  const ImageU8 golden(8, 4, 1, 100);
  ImageU8 actual = golden;
  actual.at(0, 0) = actual.at(1, 1) = actual.at(2, 2) = 110;  // one patch of three
  actual.at(7, 1) = actual.at(7, 2) = 90;                     // one of two
  EXPECT_EQ(difference_of(actual, golden, 5).patch_px, 3u);
  EXPECT_EQ(difference_of(actual, golden, 10).patch_px, 0u);
  EXPECT_DOUBLE_EQ(difference_of(actual, golden, 5).fraction, 5.0 / 32.0);
  EXPECT_DOUBLE_EQ(difference_of(actual, golden, 5).means.front(), 10.0 / 32.0);
}

// 200 rows of 100 beams that hear a bottom, and a fish of 3 by 2 cells above it.
std::vector<float> bottom(bool fish) {
  std::vector<float> image(200 * 100, 0.0f);
  for (std::size_t row = 120; row < 200; ++row)
    for (std::size_t column = 0; column < 100; ++column)
      image[row * 100 + column] =
          static_cast<float>(0.5 + 0.5 * random_uniform({7, 2}, row * 100 + column));
  for (std::size_t row = 60; fish && row < 62; ++row)
    for (std::size_t column = 40; column < 43; ++column) image[row * 100 + column] = 0.8f;
  return image;
}

TEST(GoldenCompare, SumsSurviveTheirFile) {
  const SonarSums sums = sums_of(bottom(true), 200, 100);
  EXPECT_THAT(faults_of(sums_from(to_json(sums)), sums, {1e-6, 1e-6, 0.0}), IsEmpty());
}

TEST(GoldenCompare, ASonarShiftedByAHundredthOfADecibelFails) {
  std::vector<float> image = bottom(true);
  const SonarSums golden = sums_of(image, 200, 100);
  for (float& value : image) value *= 1.0023f;  // 0.01 dB
  EXPECT_THAT(faults_of(sums_of(image, 200, 100), golden, {}),
              ElementsAre(HasSubstr("the sum differs by +0.0023 of it")));
}

TEST(GoldenCompare, ASonarThatLostAFishFails) {
  EXPECT_THAT(
      faults_of(sums_of(bottom(false), 200, 100), sums_of(bottom(true), 200, 100), {}),
      ElementsAre(HasSubstr("cells are heard"), HasSubstr("row 60"), HasSubstr("column 4")));
}

TEST(GoldenCompare, ASonarOfAnotherSizeOrWithoutValuesFails) {
  const SonarSums golden = sums_of(bottom(true), 200, 100);
  EXPECT_THAT(faults_of(sums_of(bottom(true), 100, 200), golden, {}),
              ElementsAre(HasSubstr("accepted: 200 of 100")));
  std::vector<float> image = bottom(true);
  image[150 * 100] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(faults_of(sums_of(image, 200, 100), golden, {}),
              ElementsAre(HasSubstr("the sum"), HasSubstr("row 150"), HasSubstr("column 0")));
}

}  // namespace
}  // namespace neritic::test
