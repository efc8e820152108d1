// The pictures and the contact sheet of `neritic render --sheet`, of frames made here. No device.
#include "tools/neritic/render_sheet.hpp"

#include <gtest/gtest.h>

#include <set>

#include "engine/scene/image_file.hpp"
#include "testbed/output/pictures.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

namespace fs = std::filesystem;

const ClassNames kNames = {{3, "wreck"}};
constexpr std::uint32_t kSheetWidth = 32, kHeight = 18;

CameraFrame camera_frame(const std::string& name, float motion_px) {
  CameraFrame camera;
  camera.name = name;
  ViewImages view;
  view.width = kSheetWidth;
  view.height = kHeight;
  view.color = ImageU8(kSheetWidth, kHeight, 3, 200);
  view.depth = ImageF32(kSheetWidth, kHeight, 1, 2.0f);
  view.normals = ImageF32(kSheetWidth, kHeight, 3, 0.5f);
  view.labels = ImageU16(kSheetWidth, kHeight, 1, 3);
  view.instances = ImageU16(kSheetWidth, kHeight, 1, 4);
  view.motion = ImageF32(kSheetWidth, kHeight, 2, motion_px);
  camera.eyes.push_back(view);
  return camera;
}

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

TEST(RenderSheet, PicturesLieInAFolderOfTheirOwnAndNamesDoNotCollide) {
  const test::ScratchFolder out;
  FrameResult result;
  result.cameras = {camera_frame("sheet", 1.0f), camera_frame("depth", 1.0f)};
  ASSERT_TRUE(write_sheet(out.path(), result, kNames).ok());
  EXPECT_EQ(files_in(out.path()), (std::set<std::string>{"sheet", "sheet.png"}));
  EXPECT_EQ(files_in(out / "sheet"),
            (std::set<std::string>{"sheet_color.png", "depth_color.png", "sheet_depth.png",
                                   "sheet_normals.png", "sheet_labels.png", "sheet_instances.png",
                                   "sheet_motion.png"}));
}

TEST(RenderSheet, WhereNothingMovesThereIsNoMotionPicture) {
  const test::ScratchFolder out;
  FrameResult result;
  result.cameras = {camera_frame("camera", 0.0f)};
  ASSERT_TRUE(write_sheet(out.path(), result, kNames).ok());
  EXPECT_FALSE(fs::exists(out / "sheet/camera_motion.png"));
  EXPECT_TRUE(fs::exists(out / "sheet/camera_depth.png"));
}

std::size_t pixels_of(const ImageU8& picture, const Rgb& color) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < picture.data.size(); i += 3)
    count += std::equal(color.begin(), color.end(), picture.data.begin() + std::ptrdiff_t(i));
  return count;
}

TEST(ContactSheet, AKeyOfColoursIsBesideTheCaptionAsFarAsThereIsRoom) {
  const Rgb green{10, 200, 30}, red{200, 10, 30};
  std::vector<Tile> tiles(3, Tile{ImageU8(64, 36, 3, 100), "tile"});
  tiles[1].key = {{green, "diver"}, {red, "rov"}};
  const ImageU8 sheet = contact_sheet(tiles);
  EXPECT_EQ(pixels_of(sheet, green), 121u);
  EXPECT_EQ(pixels_of(sheet, red), 121u);
  tiles[1].key.assign(100, {green, "another long word"});
  const std::size_t in_room = pixels_of(contact_sheet(tiles), green);
  EXPECT_GE(in_room, 121u);
  EXPECT_LT(in_room, 10 * 121u);
}

// Counts in the sheet itself, whose pictures have more pixels than any swatch.
TEST(RenderSheet, LabelsHaveTheirClassesNamedLargestFirst) {
  const test::ScratchFolder out;
  FrameResult result;
  result.cameras = {camera_frame("camera", 0.0f)};
  result.cameras[0].eyes[0].labels.data[5] = 77;
  const auto swatches = [&](const ClassNames& names) {
    EXPECT_TRUE(write_sheet(out.path(), result, names).ok());
    return pixels_of(scene::read_image8(out / "sheet.png", 3).value(), label_color(77));
  };
  const std::size_t named = swatches({{3, "wreck"}, {77, "buoy"}});
  // A first name so long that there is no room for the second.
  EXPECT_EQ(named, swatches({{3, std::string(200, 'w')}, {77, "buoy"}}) + 121);
}

TEST(Pictures, ADepthImageSpansWhatItShows) {
  ImageF32 depth(5, 1, 1, 0.0f);
  EXPECT_EQ(depth_span(depth), std::nullopt);
  depth.data = {INFINITY, NAN, 5.0f, 2.0f, 0.0f};
  EXPECT_EQ(depth_span(depth), (std::pair{2.0, 5.0}));
}

// Share of columns without any picture in the lowest rows of a sheet.
double empty_share(const ImageU8& sheet) {
  std::uint32_t empty = 0;
  for (std::uint32_t x = 0; x < sheet.width; ++x) {
    bool any = false;
    for (std::uint32_t y = sheet.height - 100; y < sheet.height; ++y)
      any |= sheet.at(x, y, 0) > 150;
    empty += any ? 0 : 1;
  }
  return static_cast<double>(empty) / sheet.width;
}

TEST(ContactSheet, TheLowestRowIsFilledWhateverTheNumberOfTiles) {
  for (std::size_t count = 5; count < 14; ++count) {
    const std::vector<Tile> tiles(count, Tile{ImageU8(1280, 720, 3, 200), "tile"});
    EXPECT_LT(empty_share(contact_sheet(tiles)), count == 5 ? 0.67 : 0.35) << count;
  }
}

}  // namespace
}  // namespace neritic::tools
