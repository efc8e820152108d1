#include "sonar/coco.hpp"

#include <gtest/gtest.h>

#include <random>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/image_file.hpp"
#include "sonar/coco_pictures.hpp"
#include "sonar/ping_labels.hpp"
#include "tests/support/gpu_fixture.hpp"
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
  ASSERT_TRUE(coco.write(folder / "labels.json", nlohmann::json::object()).ok());
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "labels.json").value()), json);
}

// Rows of letters: '.' water, '#' shadow, '_' seabed (class 1), 'a' and 'b' instances of class 3.
LabelImage drawn(const std::vector<std::string>& rows) {
  LabelImage out;
  out.n_range = static_cast<std::uint32_t>(rows.size());
  out.n_beams = static_cast<std::uint32_t>(rows[0].size());
  for (const std::string& row : rows)
    for (const char c : row) {
      out.classes.push_back(c == '.' ? 0 : c == '#' ? sonar::kShadow : c == '_' ? 1 : 3);
      out.instances.push_back(c == 'a' ? 1 : c == 'b' ? 2 : c == '_' ? 9 : 0);
      out.fraction.push_back(1.0f);
    }
  return out;
}
const std::map<std::uint16_t, std::string> kDrawnClasses{
    {1, "seabed"}, {3, "rock"}, {sonar::kShadow, "shadow"}};

// Each connected shadow has its box and the annotation of what lies before it in its beams; one
// that has only seabed before it names nothing; specks are a crowd.
TEST(Coco, EveryShadowIsAnAnnotationOfItsOwnWithWhatCastsIt) {
  const LabelImage labels = drawn({"_______________",  //
                                   "_aaa_____bb____",  //
                                   "_aaa______b__##",  //
                                   "_###______#__##",  //
                                   "_###_____#___##",  //
                                   "__##_____##__##",  //
                                   "__##__#__##__##",  //
                                   "_________##____"});
  sonar::CocoFile coco(kDrawnClasses);
  coco.add("a.png", labels);
  const auto annotations = coco.json()["annotations"];
  ASSERT_EQ(annotations.size(), 7u);  // seabed, a, b, specks, three shadows
  const auto shadow_at = [&](int left, int top, int width, int height) {
    for (const auto& a : annotations)
      if (a["category_id"] == sonar::kShadow &&
          a["bbox"] == nlohmann::json({left, top, width, height}))
        return a;
    ADD_FAILURE() << left << ' ' << top;
    return nlohmann::json::object();
  };
  const auto behind_a = shadow_at(1, 3, 3, 4), behind_b = shadow_at(9, 3, 2, 5),
             behind_none = shadow_at(13, 2, 2, 5), speck = shadow_at(6, 6, 1, 1);
  EXPECT_EQ(behind_a["area"], 10);
  EXPECT_EQ(behind_b["area"], 8);  // joined by corners
  EXPECT_EQ(annotations[behind_a["cast_by"].get<std::size_t>() - 1]["instance"], 1);
  EXPECT_EQ(annotations[behind_b["cast_by"].get<std::size_t>() - 1]["instance"], 2);
  EXPECT_FALSE(behind_none.contains("cast_by"));
  EXPECT_EQ(speck["iscrowd"], 1);
  for (const auto& a : {behind_a, behind_b, behind_none}) EXPECT_EQ(a["iscrowd"], 0);
  EXPECT_EQ(annotations[0]["category_id"], 1);
  EXPECT_EQ(annotations[0]["iscrowd"], 1);
}

// A side-scan's pictures have range from their middle outwards: the same shadow is cast by what is
// nearer to the middle, and not by what lies beyond it.
TEST(Coco, ASideScansShadowsAreCastOutwards) {
  const LabelImage labels = drawn({"b###a______a###b",  //
                                   "b###a______a###b",  //
                                   "b###a______a###b"});
  sonar::CocoFile coco(kDrawnClasses, sonar::RangeAxis::kOutwards);
  coco.add("a.png", labels);
  const auto annotations = coco.json()["annotations"];
  int shadows = 0;
  for (const auto& a : annotations) {
    if (a["category_id"] != sonar::kShadow) continue;
    ++shadows;
    EXPECT_EQ(annotations[a["cast_by"].get<std::size_t>() - 1]["instance"], 1);
  }
  EXPECT_EQ(shadows, 2);
}

sonar::SonarImage image_of(const std::vector<float>& values) {
  return {static_cast<std::uint32_t>(values.size() / 2), 2, values, {}};
}

// One grey is one level in every picture of a run, whichever is loudest, and the scale says which.
TEST(CocoPictures, AreOnOneScaleWhateverComesLater) {
  const test::ScratchFolder folder;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> levels_db(40.0, 120.0);
  std::vector<std::vector<float>> powers;
  for (const double more_db : {0.0, 21.3, -10.0, 37.7, 5.0}) {
    powers.emplace_back();
    for (int i = 0; i < 100; ++i)
      powers.back().push_back(
          static_cast<float>(std::pow(10.0, 0.1 * (levels_db(random) + more_db))));
  }
  powers.push_back(std::vector<float>(100, 0.0f));
  sonar::CocoPictures pictures(folder.path(), true, {});
  for (std::size_t i = 0; i < powers.size(); ++i)
    ASSERT_TRUE(pictures.add(fmt::format("coco/{}.png", i), image_of(powers[i])).ok());
  ASSERT_TRUE(pictures.finish().ok());
  const auto scale = pictures.scale();
  const double floor_db = scale["floor_db"], full_db = scale["full_scale_db"];
  EXPECT_NEAR(full_db - floor_db, 76.5, 1e-9);
  int brightest = 0;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    NERITIC_ASSERT_OK(const ImageU8 picture,
                      scene::read_image8(folder / fmt::format("coco/{}.png", i)));
    ASSERT_EQ(picture.data.size(), powers[i].size());
    for (std::size_t k = 0; k < powers[i].size(); ++k) {
      const double db = powers[i][k] > 0 ? 10.0 * std::log10(powers[i][k]) : -1e9;
      EXPECT_NEAR(picture.data[k], std::clamp((db - floor_db) / 0.3, 0.0, 255.0), 0.5 + 1e-4);
      brightest = std::max<int>(brightest, picture.data[k]);
    }
  }
  EXPECT_GE(brightest, 254);
}

// Where the output is named its counts are the greys, whatever is heard.
TEST(CocoPictures, ShowTheOutputsCountsWhereItIsNamed) {
  const test::ScratchFolder folder;
  sonar::CocoPictures pictures(folder.path(), true,
                               {.bits = 16, .floor_db = 60.0, .span_db = 51.0, .named = true});
  ASSERT_TRUE(pictures.add("a.png", image_of({1e7f, 1e5f, 1e20f, 0.0f})).ok());
  ASSERT_TRUE(pictures.finish().ok());
  NERITIC_ASSERT_OK(const ImageU8 picture, scene::read_image8(folder / "a.png"));
  EXPECT_EQ(picture.data, (std::vector<std::uint8_t>{50, 0, 255, 0}));
  EXPECT_EQ(pictures.scale()["floor_db"], 60.0);
  EXPECT_EQ(pictures.scale()["full_scale_db"], 111.0);
}

// Pings side by side, a row or a column each, a fixed number of pings a picture.
TEST(PingLabels, LieSideBySideAsTheirRecordDoes) {
  const test::ScratchFolder folder;
  const std::size_t pings = sonar::PingLabels::kPingsAPicture + 3;
  sonar::PingLabels labels;
  for (std::size_t i = 0; i < pings; ++i) {
    const auto v = static_cast<std::uint16_t>(i % 5);
    const sonar::PingLine near_first{{3, 1, v}, {1, 0, v}, {1.0f, 0.5f, 0.0f}};
    labels.append(sonar::ping_line(near_first, near_first));
  }
  for (const auto along : {sonar::PingsAlong::kRows, sonar::PingsAlong::kColumns}) {
    ASSERT_TRUE(labels.write(folder.path(), "s", along).ok());
    NERITIC_ASSERT_OK(const NpyArray array, read_npy(folder / "s_labels.npy"));
    const bool rows = along == sonar::PingsAlong::kRows;
    EXPECT_EQ(array.shape,
              (rows ? std::vector<std::size_t>{pings, 6} : std::vector<std::size_t>{6, pings}));
    const std::vector<double> values = array.to_doubles();
    const std::vector<double> line{4, 1, 3, 3, 1, 4};  // of ping 9
    for (std::size_t bin = 0; bin < 6; ++bin)
      EXPECT_EQ(values[rows ? 9 * 6 + bin : bin * pings + 9], line[bin]);
    sonar::CocoFile coco(kDrawnClasses);
    sonar::CocoPictures pictures(folder.path(), false, {});
    ASSERT_TRUE(labels.add_to(coco, pictures, along).ok());
    const auto images = coco.json()["images"];
    ASSERT_EQ(images.size(), 2u);
    EXPECT_EQ(images[1][rows ? "height" : "width"], 3);
    EXPECT_EQ(images[1][rows ? "width" : "height"], 6);
    NERITIC_ASSERT_OK(const ImageU8 picture,
                      scene::read_image8(folder / images[1]["file_name"].get<std::string>()));
    EXPECT_EQ(picture.width, images[1]["width"]);
    EXPECT_EQ(picture.height, images[1]["height"]);
  }
}

}  // namespace
}  // namespace neritic
