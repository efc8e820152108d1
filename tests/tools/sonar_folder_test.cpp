// `neritic sonar` on folders: the same as one by one, going on where it stopped, leaving out what
// cannot be read, a thousand frames.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"
#include "tests/tools/sonar_command.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;
using test::numbers_of;
using test::sonar_command;
using test::sum;
using test::Words;
using test::operator+;

// Walls farther and farther off, in small images: d/depth_000.npy, n/normal_000.npy.
class SonarFolder : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kWidth = 32, kHeight = 24;

  void write_frames(int count, std::uint32_t width = kWidth, std::uint32_t height = kHeight) {
    ASSERT_TRUE(make_folder(folder_ / "d").ok() && make_folder(folder_ / "n").ok());
    std::vector<float> normals;
    for (std::uint32_t i = 0; i < width * height; ++i) normals.insert(normals.end(), {0, 0, 1});
    for (int i = 0; i < count; ++i) {
      const std::vector<float> depth(width * height, 1.2f + 0.003f * float(i % 1000));
      ASSERT_TRUE(write_npy(depth_file(i), std::span<const float>(depth), {height, width}).ok());
      ASSERT_TRUE(
          write_npy(normal_file(i), std::span<const float>(normals), {height, width, 3}).ok());
    }
  }
  static std::string name(int i) { return fmt::format("{:03}", i); }
  fs::path depth_file(int i) { return folder_ / "d" / ("depth_" + name(i) + ".npy"); }
  fs::path normal_file(int i) { return folder_ / "n" / ("normal_" + name(i) + ".npy"); }
  fs::path result(int i) { return folder_ / "out" / name(i); }
  Words settings() {
    Words all = Words{"--intrinsics", "20,20,16,12", "--bins", "32,16,16"} + test::by_any_method();
    if (!pictures_) all.push_back("--no-pictures");
    return all;
  }
  Words words(const Words& more = {}) {
    return Words{"imaging",
                 "--depth",
                 (folder_ / "d").string(),
                 "--normals",
                 (folder_ / "n").string(),
                 "--out",
                 (folder_ / "out").string()} +
           settings() + more;
  }
  void expect_done(const Words& all) {
    const Status done = sonar_command(all);
    EXPECT_TRUE(done.ok()) << done.error().message;
  }
  void expect_refused(const Words& all, const std::string& named) {
    const Status status = sonar_command(all);
    ASSERT_FALSE(status.ok()) << named;
    EXPECT_EQ(status.error().code, ErrorCode::kBadInput);
    EXPECT_NE(status.error().message.find(named), std::string::npos) << status.error().message;
    EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
  }
  nlohmann::json run_facts() {
    return parse_json(read_text(folder_ / "out" / "run.json").value()).value();
  }
  std::string list_of(const char* name) {
    const auto text = read_text(folder_ / "out" / name);
    return text.ok() ? *text : "";
  }
  std::string skipped() { return list_of("skipped.csv"); }
  bool pictures_ = false;  // which cost more than all else
  test::ScratchFolder folder_;
};

TEST_F(SonarFolder, GivesEachFrameWhatItGivesAlone) {
  pictures_ = true;
  write_frames(4);
  expect_done(words({"--workers", "3"}));
  for (int i = 0; i < 4; ++i) {
    const fs::path alone = folder_ / ("alone_" + name(i));
    expect_done(Words{"imaging", "--depth", depth_file(i).string(), "--normals",
                      normal_file(i).string(), "--out", alone.string()} +
                settings());
    for (const char* file : {"sonar.npy", "sonar_labels.npy", "sonar.png"})
      EXPECT_EQ(read_text(result(i) / file).value(), read_text(alone / file).value())
          << i << " " << file;
  }
  EXPECT_NE(numbers_of(result(0) / "sonar.npy"), numbers_of(result(3) / "sonar.npy"));
  EXPECT_EQ(run_facts()["made"], 4);
  EXPECT_EQ(skipped(), "");
  for (const auto& entry : fs::directory_iterator(folder_ / "out"))
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
}

TEST_F(SonarFolder, LinksThatLoopOrDangleAreSkippedAndListed) {
  write_frames(3);
  fs::create_symlink("depth_007.npy", folder_ / "d" / "depth_007.npy");
  fs::create_symlink("gone.npy", folder_ / "d" / "depth_008.npy");
  fs::create_symlink("normal_007.npy", folder_ / "n" / "normal_007.npy");
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 3);
  for (const char* name : {"depth_007.npy", "depth_008.npy", "normal_007.npy"})
    EXPECT_NE(skipped().find(name), std::string::npos) << skipped();
  EXPECT_NE(skipped().find("a link that leads nowhere"), std::string::npos) << skipped();
}

TEST_F(SonarFolder, GoesOnWhereItStopped) {
  write_frames(5);
  expect_done(words());
  const std::string whole = read_text(result(3) / "sonar.npy").value();
  // As a run leaves it that was stopped: one frame half-written, one not begun.
  fs::remove_all(result(3));
  ASSERT_TRUE(make_folder(folder_ / "out" / ".003.partial").ok());
  ASSERT_TRUE(write_text(folder_ / "out" / ".003.partial" / "sonar.npy", "half").ok());
  fs::remove_all(result(4));
  const auto kept = fs::last_write_time(result(0) / "sonar.json");
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 2);
  EXPECT_EQ(run_facts()["already_there"], 3);
  EXPECT_EQ(fs::last_write_time(result(0) / "sonar.json"), kept);
  EXPECT_EQ(read_text(result(3) / "sonar.npy").value(), whole);
  EXPECT_FALSE(fs::exists(folder_ / "out" / ".003.partial"));
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 0);
}

TEST_F(SonarFolder, MakesFramesAgainWhoseImagesAreNewer) {
  write_frames(3);
  expect_done(words());
  fs::last_write_time(depth_file(1),
                      fs::last_write_time(result(1) / "sonar.json") + std::chrono::seconds(5));
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 1);
}

TEST_F(SonarFolder, FilesOfTheSameNamesElsewhereAreOtherFiles) {
  write_frames(3);
  expect_done(words());
  const std::string before = read_text(result(1) / "sonar.npy").value();
  // The same names, sizes and times in another tree, but other depths.
  fs::rename(folder_ / "d", folder_ / "first");
  fs::create_directory(folder_ / "d");
  const std::vector<float> depth(kWidth * kHeight, 3.0f);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(write_npy(depth_file(i), std::span<const float>(depth), {kHeight, kWidth}).ok());
    fs::last_write_time(depth_file(i),
                        fs::last_write_time(folder_ / "first" / depth_file(i).filename()));
  }
  fs::rename(folder_ / "d", folder_ / "second");
  Words all = words();
  all[2] = (folder_ / "second").string();
  expect_done(all);
  EXPECT_EQ(run_facts()["made"], 3);
  EXPECT_NE(read_text(result(1) / "sonar.npy").value(), before);
  expect_done(all);
  EXPECT_EQ(run_facts()["made"], 0);
}

TEST_F(SonarFolder, MakesFramesAgainThatAreOlderButNotTheSame) {
  write_frames(3);
  expect_done(words());
  fs::last_write_time(depth_file(1), fs::last_write_time(depth_file(1)) - std::chrono::hours(5));
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 1);
}

TEST_F(SonarFolder, AResultGoesWithTheImageThatCannotBeReadAnyMore) {
  write_frames(3);
  expect_done(words());
  ASSERT_TRUE(write_text(depth_file(1), "junk").ok());
  fs::remove(normal_file(2));
  expect_done(words());
  EXPECT_EQ(run_facts()["skipped"], 2);
  EXPECT_TRUE(fs::exists(result(0) / "sonar.json"));
  for (const int i : {1, 2}) EXPECT_FALSE(fs::exists(result(i))) << i;
}

TEST_F(SonarFolder, ADamagedResultIsMadeAgain) {
  write_frames(4);
  expect_done(words());
  const std::string whole = read_text(result(1) / "sonar.npy").value();
  const std::string facts = read_text(result(1) / "sonar.json").value();
  ASSERT_TRUE(write_text(result(0) / "sonar.json", "").ok());
  ASSERT_TRUE(write_text(result(1) / "sonar.json", facts.substr(0, facts.size() / 2)).ok());
  fs::remove(result(2) / "sonar.npy");
  fs::remove(result(3) / "sonar.json");
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 4);
  EXPECT_EQ(read_text(result(1) / "sonar.npy").value(), whole);
}

TEST_F(SonarFolder, AResultOfWhichAFileIsCutOrMissingIsMadeAgain) {
  pictures_ = true;
  write_frames(4);
  expect_done(words());
  const std::string whole = read_text(result(0) / "sonar.npy").value();
  fs::resize_file(result(0) / "sonar.npy", 100);
  fs::remove(result(1) / "sonar_labels.npy");
  fs::resize_file(result(2) / "sonar.png", fs::file_size(result(2) / "sonar.png") - 1);
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 3);
  EXPECT_EQ(read_text(result(0) / "sonar.npy").value(), whole);
  EXPECT_TRUE(fs::exists(result(1) / "sonar_labels.npy"));
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 0);
}

TEST_F(SonarFolder, EachFrameHasNoiseOfItsOwn) {
  if (!test::have_device()) GTEST_SKIP() << "no Vulkan device";
  const std::vector<float> depth(kWidth * kHeight, 2.0f);
  for (const char* frame : {"frame_0", "frame_1"}) {
    ASSERT_TRUE(make_folder(folder_ / frame / "camera").ok());
    ASSERT_TRUE(write_npy(folder_ / frame / "camera" / "depth.npy", std::span<const float>(depth),
                          {kHeight, kWidth})
                    .ok());
  }
  ASSERT_TRUE(write_text(folder_ / "sensor.toml",
                         "range_m = [1, 4]\nazimuth_deg = 40\nelevation_deg = 20\n"
                         "bins = [32, 16, 16]\nlevel = {}\nnoise = { level_db = 90 }\n")
                  .ok());
  expect_done({"imaging", "--depth", (folder_ / "frame_*" / "camera" / "depth.npy").string(),
               "--intrinsics", "20,20,16,12", "--sensor", (folder_ / "sensor.toml").string(),
               "--out", (folder_ / "out").string()});
  const auto a = numbers_of(folder_ / "out" / "0" / "sonar.npy"),
             b = numbers_of(folder_ / "out" / "1" / "sonar.npy");
  ASSERT_EQ(a.size(), 32u * 16u);
  EXPECT_NE(a, b);
}

TEST_F(SonarFolder, OtherSettingsAreRefusedUnlessToOverwrite) {
  pictures_ = true;
  write_frames(3);
  expect_done(words());
  const std::string before = read_text(result(2) / "sonar.npy").value();
  expect_refused(words({"--range", "1,6"}), "range_m");
  expect_refused(words({"--no-pictures"}), "pictures");
  EXPECT_EQ(read_text(result(2) / "sonar.npy").value(), before);
  expect_done(words({"--range", "1,6", "--overwrite"}));
  EXPECT_EQ(run_facts()["made"], 3);
  EXPECT_NE(read_text(result(2) / "sonar.npy").value(), before);
}

TEST_F(SonarFolder, LeavesOutAndListsWhatItCannotRead) {
  write_frames(6);
  ASSERT_TRUE(write_text(depth_file(1), "not an array, \"really\"").ok());
  fs::remove(normal_file(3));
  ASSERT_TRUE(write_npy(normal_file(4), std::vector<float>(12, 1.0f), {2, 2, 3}).ok());
  expect_done(words());
  EXPECT_EQ(run_facts()["skipped"], 3);
  EXPECT_TRUE(fs::exists(result(0) / "sonar.json") && fs::exists(result(5) / "sonar.json"));
  for (const int i : {1, 3, 4}) {
    EXPECT_FALSE(fs::exists(result(i)));
    EXPECT_NE(skipped().find(depth_file(i).string()), std::string::npos) << skipped();
  }
  EXPECT_NE(skipped().find("--normals"), std::string::npos);
  const std::string list = skipped();
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 4);
  // Put right, they are made, and the list goes.
  write_frames(6);
  expect_done(words());
  EXPECT_EQ(skipped(), "");
  EXPECT_TRUE(fs::exists(result(4) / "sonar.json"));
}

// Frames that are readable and hold nothing to hear are made, and listed with the reason; a run
// that goes on lists those that were there; put right, they leave the list.
TEST_F(SonarFolder, ListsSilentFramesWithTheirReasons) {
  write_frames(6);
  const std::size_t pixels = read_npy(depth_file(0))->to_doubles().size();
  NERITIC_ASSERT_OK(const NpyArray depth, read_npy(depth_file(0)));
  const auto put = [&](int i, float value) {
    ASSERT_TRUE(write_npy(depth_file(i), std::vector<float>(pixels, value),
                          {depth.shape[0], depth.shape[1]})
                    .ok());
  };
  put(1, std::numeric_limits<float>::quiet_NaN());
  put(4, 1e4f);
  for (const int made : {6, 1}) {  // the second run goes on
    expect_done(words());
    EXPECT_EQ(run_facts()["made"], made);
    EXPECT_EQ(run_facts()["silent"], 2);
    EXPECT_EQ(run_facts()["skipped"], 0);
    const std::string list = list_of("silent.csv");
    EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 3) << list;
    EXPECT_NE(list.find(depth_file(1).string() + "\",\"no pixel has a depth"), std::string::npos);
    EXPECT_NE(list.find(depth_file(4).string() + "\",\"nothing lies between"), std::string::npos);
    fs::remove_all(result(2));
  }
  write_frames(6);
  expect_done(words());
  EXPECT_EQ(run_facts()["silent"], 0);
  EXPECT_EQ(list_of("silent.csv"), "");
}

// Noise hides silence from the bins, not from the list.
TEST_F(SonarFolder, ListsSilentFramesBehindNoise) {
  if (!test::have_device()) GTEST_SKIP() << "no Vulkan device";
  write_frames(3);
  NERITIC_ASSERT_OK(const NpyArray depth, read_npy(depth_file(0)));
  ASSERT_TRUE(write_npy(depth_file(1), std::vector<float>(depth.to_doubles().size(), -1.0f),
                        {depth.shape[0], depth.shape[1]})
                  .ok());
  ASSERT_TRUE(write_text(folder_ / "noisy.toml",
                         "range_m = [0.5, 3]\nazimuth_deg = 60\nelevation_deg = 40\nlevel = {}\n"
                         "noise = { level_db = 60 }\n")
                  .ok());
  expect_done(words({"--sensor", (folder_ / "noisy.toml").string()}));
  const std::vector<double> heard = numbers_of(result(1) / "sonar.npy");
  EXPECT_GT(*std::max_element(heard.begin(), heard.end()), 0.0);
  EXPECT_EQ(run_facts()["silent"], 1);
  EXPECT_NE(list_of("silent.csv").find(depth_file(1).string()), std::string::npos);
}

TEST_F(SonarFolder, ListsFilesThatAreNoFrames) {
  write_frames(4);
  fs::remove(depth_file(2));
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 3);
  EXPECT_EQ(run_facts()["skipped"], 0);
  EXPECT_NE(skipped().find(normal_file(2).string()), std::string::npos) << skipped();
  EXPECT_NE(skipped().find("--depth"), std::string::npos) << skipped();
  const std::string list = skipped();
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 2);
}

TEST_F(SonarFolder, NothingReadableIsBadInput) {
  write_frames(2);
  for (const int i : {0, 1}) ASSERT_TRUE(write_text(depth_file(i), "junk").ok());
  expect_refused(words(), "none of 2 frames");
  EXPECT_NE(skipped(), "");
}

TEST_F(SonarFolder, FilesOfOthersAreLeftAlone) {
  write_frames(2);
  ASSERT_TRUE(make_folder(result(1)).ok());
  ASSERT_TRUE(write_text(result(1) / "diary.txt", "mine").ok());
  for (const Words& more : {Words{}, Words{"--overwrite"}})
    expect_refused(words(more), result(1).string());
  EXPECT_EQ(read_text(result(1) / "diary.txt").value(), "mine");
}

TEST_F(SonarFolder, FoldersThatDoNotFitAreRefusedByName) {
  write_frames(2);
  Words all = words();
  all[4] = normal_file(0).string();
  expect_refused(all, "--normals");
  all = words();
  all[2] = (folder_ / "d" / "*.exr").string();
  expect_refused(all, "*.exr");
  ASSERT_TRUE(make_folder(folder_ / "empty").ok());
  all[2] = (folder_ / "empty").string();
  expect_refused(all, "empty");
}

TEST_F(SonarFolder, ImagesOfDifferentSizesAreAllTaken) {
  write_frames(4);
  const std::vector<float> depth(48 * 40, 2.0f);
  std::vector<float> normals;
  for (int i = 0; i < 48 * 40; ++i) normals.insert(normals.end(), {0, 0, 1});
  ASSERT_TRUE(write_npy(depth_file(2), depth, {40, 48}).ok());
  ASSERT_TRUE(write_npy(normal_file(2), normals, {40, 48, 3}).ok());
  expect_done(words());
  EXPECT_EQ(run_facts()["made"], 4);
}

// Pictures, a ping each, from 3 m above a flat bottom.
TEST_F(SonarFolder, PicturesMakeASideScanWaterfall) {
  ASSERT_TRUE(make_folder(folder_ / "p").ok());
  ImageU8 picture(64, 48, 3);
  for (std::uint8_t i = 0; i < 5; ++i) {
    std::fill(picture.data.begin(), picture.data.end(), static_cast<std::uint8_t>(50 * i + 50));
    ASSERT_TRUE(scene::write_png8(folder_ / "p" / fmt::format("rgb_{}.png", i), picture).ok());
  }
  const Words all{
      "sidescan",   "--method", "image",        "--picture",   (folder_ / "p").string(),
      "--altitude", "3",        "--intrinsics", "40,40,32,24", "--range",
      "2,5",        "--bins",   "30,1,1",       "--out",       (folder_ / "out").string()};
  expect_done(all);
  const std::vector<double> waterfall = numbers_of(folder_ / "out" / "waterfall.npy");
  ASSERT_EQ(waterfall.size(), 5u * 60u);
  double before = 0.0;
  for (int i = 0; i < 5; ++i) {
    const auto row = waterfall.begin() + 60 * i;
    const double port = sum({row, row + 30}), starboard = sum({row + 30, row + 60});
    EXPECT_NEAR(port, starboard, 1e-3 * port);  // an even bottom
    EXPECT_GT(port, before);                    // brighter and brighter
    before = port;
    EXPECT_EQ(row[29], 0.0f);  // water: nothing is nearer than 3 m
  }
  EXPECT_TRUE(fs::exists(folder_ / "out" / "waterfall.png"));
  expect_done(all);
  EXPECT_EQ(run_facts()["made"], 0);
}

// To measure with: NERITIC_FRAMES, another number of frames; NERITIC_FRAME_SIZE=large, 640 x 480
// pixels and 512 x 500 x 500 bins (5 MB a frame of scratch disk).
TEST_F(SonarFolder, ManyFramesGoThrough) {
  const char *asked = std::getenv("NERITIC_FRAMES"), *size = std::getenv("NERITIC_FRAME_SIZE");
  const int count = asked != nullptr ? std::atoi(asked) : test::is_thorough() ? 1000 : 250;
  const bool large = size != nullptr && std::string(size) == "large";
  write_frames(count, large ? 640 : 160, large ? 480 : 120);
  Words all = words();
  *(std::find(all.begin(), all.end(), "--bins") + 1) = large ? "512,500,500" : "128,64,64";
  *(std::find(all.begin(), all.end(), "--intrinsics") + 1) =
      large ? "320,320,320,240" : "80,80,80,60";
  expect_done(all);
  const nlohmann::json facts = run_facts();
  EXPECT_EQ(facts["made"], count);
  for (int i = 0; i < count; ++i) ASSERT_TRUE(fs::exists(result(i) / "sonar.json")) << i;
  fmt::print("{} frames of {} pixels: {:.0f} frames/s with {} workers\n", count,
             large ? "640 x 480" : "160 x 120", facts["frames_per_s"].get<double>(),
             facts["workers"].get<int>());
}

}  // namespace
}  // namespace neritic
