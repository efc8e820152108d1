// The shape of what is written, by the sonar's kind: the file contract gives imaging sonars two
// axes, however few azimuth bins they have.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "sonar/write_sonar.hpp"
#include "tests/support/support.hpp"

namespace neritic::sonar {
namespace {

struct Written {
  std::vector<std::size_t> shape, labels_shape;
  std::string layout;
};

Written written(scene::SonarKind kind, std::uint32_t n_azimuth) {
  const BeamGrid grid = symmetric_grid(1, 5, radians(10), radians(5), {7, n_azimuth, 3});
  SonarImage image;
  image.n_range = 7;
  image.n_azimuth = n_azimuth;
  image.intensity.assign(7 * n_azimuth, 0.5f);
  image.labels.assign(7 * n_azimuth, 1);
  const test::ScratchFolder folder;
  SonarFiles files{grid, image, kind};
  files.picture = false;
  EXPECT_TRUE(write_sonar(folder.path(), files, nlohmann::json::object()).ok());
  const auto json = parse_json(read_text(folder / "sonar.json").value()).value();
  return {read_npy(folder / "sonar.npy").value().shape,
          read_npy(folder / "sonar_labels.npy").value().shape, json.at("layout")};
}

TEST(SonarShape, ImagingAndProfilingHaveTwoAxesAlsoAtOneAzimuthBin) {
  for (const auto kind : {scene::SonarKind::kImaging, scene::SonarKind::kProfiling})
    for (const std::uint32_t n_azimuth : {1u, 5u}) {
      const Written got = written(kind, n_azimuth);
      EXPECT_EQ(got.shape, (std::vector<std::size_t>{7, n_azimuth}));
      EXPECT_EQ(got.labels_shape, got.shape);
      EXPECT_EQ(got.layout.find("sonar.npy [range, azimuth]"), 0u) << got.layout;
    }
}

TEST(SonarShape, ASingleBeamHasOneAxis) {
  for (const auto kind : {scene::SonarKind::kEchoSounder, scene::SonarKind::kSideScan,
                          scene::SonarKind::kMechanical}) {
    const Written got = written(kind, 1);
    EXPECT_EQ(got.shape, (std::vector<std::size_t>{7}));
    EXPECT_EQ(got.labels_shape, got.shape);
    EXPECT_EQ(got.layout.find("sonar.npy [range]"), 0u) << got.layout;
  }
}

}  // namespace
}  // namespace neritic::sonar
