// The files of a folder that belong together.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "sonar/offline_frames.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;
using Names = std::vector<std::string>;
constexpr const char* kMaps[] = {"npy", "png", "exr"};

TEST(OfflineFrames, NamesAreStemsWithoutWhatAllShare) {
  EXPECT_EQ(sonar::frame_names(Paths{"a/depth_0001.png", "a/depth_0002.png"}),
            (Names{"0001", "0002"}));
  EXPECT_EQ(sonar::frame_names(Paths{"0010_depth_m.exr", "0011_depth_m.exr"}),
            (Names{"0010", "0011"}));
  EXPECT_EQ(sonar::frame_names(Paths{"frame_0000_depth_m.exr", "frame_0001_depth_m.exr"}),
            (Names{"0000", "0001"}));
  EXPECT_EQ(sonar::frame_names(Paths{"o/frame_0000/cam/depth.npy", "o/frame_0001/cam/depth.npy"}),
            (Names{"0000", "0001"}));
  EXPECT_EQ(sonar::frame_names(Paths{"o/1/port/depth.npy", "o/1/star/depth.npy"}),
            (Names{"port", "star"}));
  EXPECT_EQ(sonar::frame_names(Paths{"o/1/a/depth.npy", "o/2/b/depth.npy"}), (Names{"1_a", "2_b"}));
  EXPECT_EQ(sonar::frame_names(Paths{"depth7.npy", "depth12.npy"}), (Names{"7", "12"}));
  // No word is cut either: wall and wreck share a letter.
  EXPECT_EQ(sonar::frame_names(Paths{"wall_depth.npy", "wreck_depth.npy"}),
            (Names{"wall", "wreck"}));
  EXPECT_EQ(sonar::frame_names(Paths{"1.5_depth.npy", "1.7_depth.npy"}), (Names{"5", "7"}));
  EXPECT_EQ(sonar::frame_names(Paths{"depth.npy", "depth_1.npy"}), (Names{"depth", "depth_1"}));
  EXPECT_EQ(sonar::frame_names(Paths{"a_a.npy", "a_b_a.npy"}), (Names{"a", "b_a"}));
  EXPECT_EQ(sonar::frame_names(Paths{"frame_00012_depth_m.npy"}), (Names{"00012"}));
  EXPECT_EQ(sonar::frame_names(Paths{"wall.npy"}), (Names{"wall"}));
  EXPECT_TRUE(sonar::frame_names(Paths{}).empty());
}

TEST(OfflineFrames, FilesOfOneNameBelongTogether) {
  const Paths groups[] = {{"d/depth_01.png", "d/depth_02.png", "d/depth_03.png"},
                          {"n/normal_01.exr", "n/normal_03.exr"},
                          {}};
  const auto frames = sonar::pair_frames(groups);
  ASSERT_TRUE(frames.ok()) << frames.error().message;
  ASSERT_EQ(frames->size(), 3u);
  EXPECT_EQ((*frames)[0].name, "01");
  EXPECT_EQ((*frames)[0].paths, (Paths{"d/depth_01.png", "n/normal_01.exr", ""}));
  EXPECT_EQ((*frames)[1].paths, (Paths{"d/depth_02.png", "", ""}));
  EXPECT_EQ((*frames)[2].paths, (Paths{"d/depth_03.png", "n/normal_03.exr", ""}));
}

TEST(OfflineFrames, FoldersNameFramesWhoseFilesAreCalledTheSame) {
  const Paths groups[] = {{"o/frame_0000/depth.npy", "o/frame_0001/depth.npy"},
                          {"o/frame_0000/normals.npy", "o/frame_0001/normals.npy"}};
  const auto frames = sonar::pair_frames(groups);
  ASSERT_TRUE(frames.ok()) << frames.error().message;
  EXPECT_EQ((*frames)[1].name, "0001");
  EXPECT_EQ((*frames)[1].paths[1], "o/frame_0001/normals.npy");
}

TEST(OfflineFrames, WholeStemsCountWhereTheyAreTheLeadersOwn) {
  // Without the rule the normals' names would be 1 and 2, and depth's x_1 and y_2.
  const Paths groups[] = {{"d/x_1.png", "d/y_2.png"}, {"n/x_1.png", "n/x_2.png"}};
  const auto frames = sonar::pair_frames(groups);
  ASSERT_TRUE(frames.ok());
  EXPECT_EQ((*frames)[0].paths[1], "n/x_1.png");
  EXPECT_EQ((*frames)[1].paths[1], "");
}

TEST(OfflineFrames, OneFrameIsPairedByItsNumber) {
  const Paths groups[] = {{"frame_0002_depth_m.exr"},
                          {"frame_0000_normal.exr", "frame_0002_normal.exr"}};
  const auto frames = sonar::pair_frames(groups);
  ASSERT_TRUE(frames.ok());
  EXPECT_EQ((*frames)[0].paths[1], "frame_0002_normal.exr");
}

TEST(OfflineFrames, TwoFilesOfOneFrameAreRefusedByName) {
  const Paths groups[] = {{"d/a_1.npy", "d/a_1.png", "d/a_2.npy"}};
  const auto frames = sonar::pair_frames(groups);
  ASSERT_FALSE(frames.ok());
  EXPECT_NE(frames.error().message.find("d/a_1.png"), std::string::npos) << frames.error().message;
}

TEST(OfflineFrames, FoldersAndPatternsListTheirImages) {
  std::vector<sonar::UnusableFile> unusable;
  const test::ScratchFolder folder;
  for (const char* name : {"b.npy", "a.PNG", "c.txt", ".hidden.npy", "d[1].npy"})
    ASSERT_TRUE(write_text(folder / name, "x").ok());
  ASSERT_TRUE(make_folder(folder / "below.npy").ok());
  EXPECT_TRUE(sonar::names_many(folder.path().string()));
  EXPECT_TRUE(sonar::names_many((folder / "*.npy").string()));
  EXPECT_FALSE(sonar::names_many((folder / "b.npy").string()));
  EXPECT_FALSE(sonar::names_many((folder / "d[1].npy").string()));
  EXPECT_FALSE(sonar::names_many((folder / "absent.npy").string()));

  const auto in_folder = sonar::list_files(folder.path().string(), kMaps, unusable);
  ASSERT_TRUE(in_folder.ok());
  EXPECT_EQ(*in_folder, (Paths{folder / "a.PNG", folder / "b.npy", folder / "d[1].npy"}));
  const auto like = sonar::list_files((folder / "?.*").string(), kMaps, unusable);
  ASSERT_TRUE(like.ok());
  EXPECT_EQ(*like, (Paths{folder / "a.PNG", folder / "b.npy", folder / "c.txt"}));

  const auto none = sonar::list_files((folder / "*.exr").string(), kMaps, unusable);
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().message.find("*.exr"), std::string::npos);
  const auto empty = sonar::list_files((folder / "below.npy").string(), kMaps, unusable);
  ASSERT_FALSE(empty.ok());
  EXPECT_NE(empty.error().message.find(".exr"), std::string::npos);
  EXPECT_TRUE(unusable.empty());
}

TEST(OfflineFrames, LinksThatLoopOrDangleAreLeftOutWithTheReason) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "a.npy", "x").ok());
  std::filesystem::create_symlink(folder / "a.npy", folder / "good.npy");
  std::filesystem::create_symlink("loop.npy", folder / "loop.npy");
  std::filesystem::create_symlink("gone", folder / "dangling.npy");
  for (const std::string& pattern : {folder.path().string(), (folder / "*.npy").string()}) {
    std::vector<sonar::UnusableFile> unusable;
    const auto files = sonar::list_files(pattern, kMaps, unusable);
    ASSERT_TRUE(files.ok()) << files.error().message;
    EXPECT_EQ(*files, (Paths{folder / "a.npy", folder / "good.npy"}));
    ASSERT_EQ(unusable.size(), 2u) << pattern;
    EXPECT_EQ(unusable[0].path, folder / "dangling.npy");
    EXPECT_EQ(unusable[0].reason, "a link that leads nowhere");
    EXPECT_EQ(unusable[1].path, folder / "loop.npy");
    EXPECT_FALSE(unusable[1].reason.empty());
  }
}

}  // namespace
}  // namespace neritic
