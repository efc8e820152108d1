#include "sonar/coco.hpp"

#include <gtest/gtest.h>

#include <random>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::LabelImage;

// Run lengths back into a mask [height][width].
std::vector<std::uint8_t> decode(const std::vector<std::uint32_t>& runs, std::uint32_t height,
                                 std::uint32_t width) {
  std::vector<std::uint8_t> mask(std::size_t{height} * width);
  std::size_t at = 0;
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (std::uint32_t k = 0; k < runs[i]; ++k, ++at)
      mask.at(at % height * width + at / height) = i % 2;
  EXPECT_EQ(at, mask.size());
  return mask;
}

TEST(Coco, RunLengthsAreThoseOfThePublishedExamples) {
  // As the format's own description has it: [0 0 1 1 1 0 1] is 2 3 1 1, and a mask that begins
  // inside starts with 0.
  const std::vector<std::uint8_t> column{0, 0, 1, 1, 1, 0, 1};
  EXPECT_EQ(sonar::run_lengths(column, 7, 1), (std::vector<std::uint32_t>{2, 3, 1, 1}));
  const std::vector<std::uint8_t> inside{1, 1, 1, 1, 1, 1, 0};
  EXPECT_EQ(sonar::run_lengths(inside, 7, 1), (std::vector<std::uint32_t>{0, 6, 1}));
  const std::vector<std::uint8_t> rows{0, 1, 1, 1, 0, 0};  // 2 rows, 3 columns, read down
  EXPECT_EQ(sonar::run_lengths(rows, 2, 3), (std::vector<std::uint32_t>{1, 2, 1, 1, 1}));
  EXPECT_EQ(sonar::run_lengths(std::vector<std::uint8_t>(6), 2, 3),
            (std::vector<std::uint32_t>{6}));
  EXPECT_EQ(sonar::run_lengths(std::vector<std::uint8_t>(6, 1), 2, 3),
            (std::vector<std::uint32_t>{0, 6}));
}

TEST(Coco, MasksAndBoxesAreThoseOfEveryInstance) {
  std::mt19937 random(11);
  const std::uint32_t height = 23, width = 31;
  LabelImage labels{height, width, std::vector<std::uint16_t>(height * width),
                    std::vector<std::uint16_t>(height * width), std::vector<float>(height * width)};
  for (std::size_t i = 0; i < labels.classes.size(); ++i) {
    const std::uint16_t kinds[] = {0, 3, 3, 8, 9, sonar::kShadow};
    labels.classes[i] = kinds[random() % 6];
    labels.instances[i] = labels.classes[i] == sonar::kShadow ? 0 : random() % 3;
  }
  sonar::CocoFile coco({{3, "diver"}, {8, "rov"}, {5, "wreck"}});
  coco.add("frame_0000/sonar.png", labels);
  coco.add("frame_0001/sonar.png", labels);
  const auto json = coco.json();
  EXPECT_EQ(json["images"].size(), 2u);
  EXPECT_EQ(json["images"][1]["id"], 2);
  EXPECT_EQ(json["images"][0]["width"], width);
  EXPECT_EQ(json["categories"].size(), 3u);
  ASSERT_EQ(json["annotations"].size(), 12u);  // of 3 and 8, three instances each, two images
  for (const auto& annotation : json["annotations"])
    EXPECT_EQ(annotation["iscrowd"], annotation["instance"] == 0 ? 1 : 0);
  for (std::size_t k = 0; k < 12; ++k) {
    const auto& a = json["annotations"][k];
    EXPECT_EQ(a["id"], k + 1);
    EXPECT_EQ(a["image_id"], k / 6 + 1);
    const auto mask =
        decode(a["segmentation"]["counts"].get<std::vector<std::uint32_t>>(), height, width);
    std::uint32_t left = width, top = height, right = 0, bottom = 0, area = 0;
    for (std::uint32_t y = 0; y < height; ++y)
      for (std::uint32_t x = 0; x < width; ++x) {
        const std::size_t at = y * width + x;
        EXPECT_EQ(mask[at],
                  labels.classes[at] == a["category_id"] && labels.instances[at] == a["instance"]);
        if (!mask[at]) continue;
        ++area;
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
      }
    EXPECT_EQ(a["area"], area);
    EXPECT_EQ(a["bbox"], nlohmann::json({left, top, right - left + 1, bottom - top + 1}));
    EXPECT_EQ(a["segmentation"]["size"], nlohmann::json({height, width}));
  }
}

TEST(Coco, ShadowsAndGhostsAreCategoriesWhereNamed) {
  LabelImage labels{1, 3, {sonar::kShadow, sonar::kGhost, 0}, {0, 4, 0}, {0, 1, 0}};
  sonar::CocoFile coco({{0, "water"}, {sonar::kShadow, "shadow"}, {sonar::kGhost, "ghost"}});
  coco.add("a.png", labels);
  const auto json = coco.json();
  EXPECT_EQ(json["categories"].size(), 2u);
  ASSERT_EQ(json["annotations"].size(), 2u);
  EXPECT_EQ(json["annotations"][0]["category_id"], sonar::kGhost);
  EXPECT_EQ(json["annotations"][1]["bbox"], nlohmann::json({0, 0, 1, 1}));
  const test::ScratchFolder folder;
  ASSERT_TRUE(coco.write(folder / "labels.json").ok());
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "labels.json").value()), json);
}

}  // namespace
}  // namespace neritic
