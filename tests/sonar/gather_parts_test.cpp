// A gather that would take too many turns of a thread is cut into parts, and loses nothing.
#include <gtest/gtest.h>

#include "tests/sonar/analytic.hpp"
#include "tests/sonar/gpu_fixture.hpp"

namespace neritic {
namespace {

using sonar::BeamGrid;
using sonar::Gather;
using sonar::GatherPart;

class SonarParts : public test::SonarGpuTest {};

sonar::SonarInput floor_and_spheres(std::uint32_t width, std::uint32_t height) {
  const double f = width / 2.0;
  return test::images_of(test::seabed_with_two_spheres(), width, height,
                         {f, f, width / 2.0, height / 2.0});
}

// Columns of up to 250 000 pixels, cells of up to all of them.
TEST_F(SonarParts, LargeCellsOfThePublishedGatherAreTheReferences) {
  const auto in = floor_and_spheres(600, 420);
  for (const sonar::Bins& bins : {sonar::Bins{300, 4, 40}, sonar::Bins{300, 1, 40},
                                  sonar::Bins{300, 3, 2}, sonar::Bins{40, 1, 1}}) {
    SCOPED_TRACE(fmt::format("{} x {} x {}", bins.range, bins.azimuth, bins.elevation));
    const BeamGrid grid = sonar::symmetric_grid(0.3, 5, radians(90), radians(60), bins);
    const auto inputs = std::span(&in, 1);
    const sonar::SonarImage heard = run(grid, inputs, Gather::kPublished);
    const sonar::SonarImage expected = sonar::reference_image(grid, inputs);
    ASSERT_GT(test::total(expected), 0.0);
    EXPECT_NEAR(test::total(heard) / test::total(expected), 1.0, 1e-3);
    double off = 0.0;
    for (std::size_t i = 0; i < heard.intensity.size(); ++i)
      off += std::abs(heard.intensity[i] - expected.intensity[i]);
    EXPECT_LT(off, 0.01 * test::total(expected));
  }
}

// More bins than one part takes: what all bins of a column hear is what few bins hear.
TEST_F(SonarParts, ManyBinsHearWhatFewDo) {
  const auto in = floor_and_spheres(400, 300);
  const auto grid_of = [](std::uint32_t n_range) {
    return sonar::symmetric_grid(0.3, 5, radians(90), radians(60), {n_range, 24, 700});
  };
  sonar::GBufferLayout layout;
  layout.width = in.width;
  layout.height = in.height;
  layout.intrinsics = in.intrinsics;
  EXPECT_EQ(gather_parts(grid_of(500), {}, layout, {}).size(), 1u);
  EXPECT_EQ(gather_parts(grid_of(16000), {}, layout, {}).size(), 3u);
  const auto few = run(grid_of(500), std::span(&in, 1), Gather::kPlane);
  const auto many = run(grid_of(16000), std::span(&in, 1), Gather::kPlane);
  for (std::uint32_t c = 0; c < 24; ++c) {
    double sum_few = 0.0, sum_many = 0.0;
    for (std::uint32_t r = 0; r < 500; ++r) sum_few += few.intensity[r * 24 + c];
    for (std::uint32_t r = 0; r < 16000; ++r) sum_many += many.intensity[r * 24 + c];
    EXPECT_NEAR(sum_many, sum_few, 0.002 * sum_few) << c;
  }
}

// Every row once and in turn; a cell that is too large from its last rows of pixels to its first.
TEST(SonarGatherParts, HoldEveryRowOnceInTurn) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(60), {500, 2, 30});
  sonar::GBufferLayout layout;
  layout.width = layout.height = 4000;
  layout.intrinsics = {2000.0, 2000.0, 2000.0, 2000.0};
  const auto sectors = sonar::plan_sectors(grid);
  const auto parts = gather_parts(grid, sectors, layout, {.gather = Gather::kPublished});
  ASSERT_GT(parts.size(), 30u);
  std::uint32_t row = 0, v = 0;
  for (const GatherPart& part : parts) {
    if (part.first_row == row && part.end_row > row) {
      row = part.end_row;
    } else {  // the same cells, further up
      EXPECT_EQ(part.end_row, row);
      EXPECT_EQ(part.first_row + 1, row);
      EXPECT_EQ(part.end_v, v);
    }
    EXPECT_LT(part.first_v, part.end_v);
    v = part.first_v;
  }
  EXPECT_EQ(row, 30u);
}

}  // namespace
}  // namespace neritic
