// A sonar image's files over those of an earlier one: what lies there is of one image, and a .json
// lies there only where all of it is.
#include "sonar/write_sonar.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;
using sonar::BeamGrid;
using sonar::SonarImage;

BeamGrid grid_of(std::uint32_t ranges) {
  return sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(20.0), {ranges, 6, 4});
}

SonarImage image_of(const BeamGrid& grid, float value) {
  SonarImage image;
  image.n_range = grid.bins.range;
  image.n_azimuth = grid.bins.azimuth;
  image.intensity.assign(image.n_range * image.n_azimuth, value);
  image.labels.assign(image.n_range * image.n_azimuth, std::uint16_t{1});
  return image;
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

TEST(WriteSonar, WhatAnEarlierImageLeftIsGone) {
  const test::ScratchFolder folder;
  const BeamGrid tall = grid_of(8), low = grid_of(3);
  const SonarImage first = image_of(tall, 100.0f), second = image_of(low, 0.5f);
  sonar::LabelImage energy;
  energy.classes = energy.instances = first.labels;
  energy.fraction.assign(first.labels.size(), 1.0f);
  scene::SonarOutput counts;
  counts.bits = 8;
  counts.named = true;
  NERITIC_ASSERT_STATUS(sonar::write_sonar(
      folder.path(),
      {.grid = tall, .image = first, .level = true, .output = counts, .label_energy = &energy},
      nlohmann::json::object()));
  EXPECT_EQ(names_in(folder.path()),
            (std::set<std::string>{"sonar.json", "sonar.npy", "sonar.png", "sonar_counts.npy",
                                   "sonar_instances.npy", "sonar_label_fraction.npy",
                                   "sonar_labels.npy"}));
  // The picture shows what the counts do, whatever is in it.
  const auto json = nlohmann::json::parse(read_text(folder / "sonar.json").value());
  EXPECT_NEAR(json["display"]["full_scale"].get<double>(), 1e12, 1.0);  // 40 + 80 dB
  EXPECT_EQ(json["display"]["span_db"], 80.0);
  NERITIC_ASSERT_STATUS(sonar::write_sonar(
      folder.path(), {.grid = low, .image = second, .picture = false}, nlohmann::json::object()));
  EXPECT_EQ(names_in(folder.path()),
            (std::set<std::string>{"sonar.json", "sonar.npy", "sonar_labels.npy"}));
  NERITIC_ASSERT_OK(const NpyArray array, read_npy(folder / "sonar.npy"));
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{3, 6}));
}

TEST(WriteSonar, WhereWritingFailsNoJsonDescribesTheArrays) {
  // The failing write comes after the arrays, among them, or before the first.
  for (const char* name : {"sonar.png", "sonar_labels.npy", "sonar.npy"}) {
    const test::ScratchFolder folder;
    const BeamGrid tall = grid_of(8), low = grid_of(3);
    NERITIC_ASSERT_STATUS(sonar::write_sonar(
        folder.path(), {.grid = tall, .image = image_of(tall, 100.0f)}, nlohmann::json::object()));
    EXPECT_TRUE(fs::exists(folder / "sonar.json"));
    // A folder with something in it can be neither removed nor written over as a file.
    fs::remove(folder / name);
    fs::create_directories(folder / name / "inside");
    const Status written = sonar::write_sonar(
        folder.path(), {.grid = low, .image = image_of(low, 0.5f)}, nlohmann::json::object());
    ASSERT_FALSE(written.ok()) << name;
    EXPECT_EQ(written.error().code, ErrorCode::kIo);
    EXPECT_NE(written.error().message.find(name), std::string::npos) << written.error().message;
    EXPECT_FALSE(fs::exists(folder / "sonar.json")) << name;
  }
}

}  // namespace
}  // namespace neritic
