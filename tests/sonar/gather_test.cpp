#include <gtest/gtest.h>

#include "engine/core/hash.hpp"
#include "sonar/image_gather.hpp"
#include "tests/sonar/analytic.hpp"
#include "tests/sonar/gpu_fixture.hpp"

namespace neritic {
namespace {

using sonar::BeamGrid;
using sonar::Gather;
using sonar::SonarImage;
using sonar::SonarInput;
using test::seabed_with_two_spheres;
using test::total;

class SonarGpu : public test::SonarGpuTest {};

// Share of a's energy that has a partner in b within one range row and one column: what b's cells
// can take up when each may move by one bin.
double energy_within_one_bin(const SonarImage& a, const SonarImage& b) {
  std::vector<double> left(b.intensity.begin(), b.intensity.end());
  std::vector<double> need(a.intensity.begin(), a.intensity.end());
  const int rows = int(a.n_range), columns = int(a.n_azimuth);
  double matched = 0.0;
  const auto match = [&](int dr, int dc) {
    for (int r = std::max(0, -dr); r < rows - std::max(0, dr); ++r)
      for (int c = std::max(0, -dc); c < columns - std::max(0, dc); ++c) {
        double& want = need[std::size_t(r) * columns + c];
        double& have = left[std::size_t(r + dr) * columns + c + dc];
        const double moved = std::min(want, have);
        want -= moved;
        have -= moved;
        matched += moved;
      }
  };
  match(0, 0);
  for (const auto& [dr, dc] :
       {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}})
    match(dr, dc);
  return matched / total(a);
}

TEST_F(SonarGpu, ASphereAroundTheSonarIsOneRowOfOnesInEveryColumn) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {500, 500, 500});
  for (const double radius : {3.0, 3.004}) {  // on a bin's edge, and in a bin's middle
    for (const double scale : {0.25, 0.5, 1.3}) {
      const auto inputs = test::sector_images(grid, test::sphere(Vec3(0.0), radius), scale);
      for (const Gather gather : {Gather::kNearest, Gather::kPlane}) {
        const SonarImage image = run(grid, inputs, gather);
        // The plane's incidence at a pixel's corner is off by half the square of its angle.
        for (std::uint32_t r = 0; r < 500; ++r)
          for (std::uint32_t c = 0; c < 500; ++c)
            ASSERT_NEAR(image.intensity[r * 500 + c], r == 250 ? 1.0f : 0.0f, 3e-5f)
                << radius << ' ' << scale << ' ' << name_of(gather) << ' ' << r << ',' << c;
      }
    }
  }
  const auto inputs = test::sector_images(grid, test::sphere(Vec3(0.0), 3.004), 1.3);
  const SonarImage image = run(grid, inputs, Gather::kPublished);
  for (std::uint32_t r = 0; r < 500; ++r)
    for (std::uint32_t c = 0; c < 500; ++c)
      ASSERT_NEAR(image.intensity[r * 500 + c], r == 250 ? 1.0f : 0.0f, 3e-5f) << r << ',' << c;
}

TEST_F(SonarGpu, SeveralSectorsMakeOneWedge) {
  for (const double aperture : {170.0, 360.0}) {
    const BeamGrid grid =
        sonar::symmetric_grid(1, 5, radians(aperture), radians(40), {100, 360, 64});
    const auto inputs = test::sector_images(grid, test::sphere(Vec3(0.0), 3.01), 1.5);
    for (const Gather gather : {Gather::kNearest, Gather::kPlane, Gather::kPublished}) {
      const SonarImage image = run(grid, inputs, gather);
      for (std::uint32_t r = 0; r < 100; ++r)
        for (std::uint32_t c = 0; c < 360; ++c)
          ASSERT_NEAR(image.intensity[r * 360 + c], r == 50 ? 1.0f : 0.0f, 3e-5f)
              << aperture << ' ' << name_of(gather) << ' ' << r << ',' << c;
    }
  }
}

TEST_F(SonarGpu, ASmallSphereIsWhereTheClosedFormSays) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {500, 500, 500});
  const auto inputs = test::sector_images(grid, test::sphere(Vec3(0, 0, -3.0), 0.25), 1.0);
  for (const Gather gather : {Gather::kNearest, Gather::kPlane, Gather::kPublished}) {
    const SonarImage image = run(grid, inputs, gather);
    std::uint32_t first_row = 500, columns = 0;
    for (std::uint32_t c = 0; c < 500; ++c) {
      bool seen = false;
      for (std::uint32_t r = 0; r < 500; ++r)
        if (image.intensity[r * 500 + c] > 0.0f) {
          seen = true;
          first_row = std::min(first_row, r);
        }
      columns += seen;
    }
    EXPECT_NEAR(first_row, 218, 1) << name_of(gather);
    EXPECT_NEAR(columns, 54, 2) << name_of(gather);
  }
}

TEST_F(SonarGpu, PublishedGatherAgreesWithTheLiteralReference) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {500, 500, 500});
  // Fine enough that every cell has a pixel, and far coarser, and an odd pinhole that sees a part.
  for (const double scale : {1.3, 0.4}) {
    const auto inputs = test::sector_images(grid, seabed_with_two_spheres(), scale);
    const SonarImage expected = sonar::reference_image(grid, inputs);
    const SonarImage image = run(grid, inputs, Gather::kPublished);
    EXPECT_NEAR(total(image) / total(expected), 1.0, 0.01);
    EXPECT_GT(energy_within_one_bin(expected, image), 0.99);
    std::size_t differing = 0, labels_differing = 0;
    for (std::size_t i = 0; i < image.intensity.size(); ++i) {
      differing += std::abs(image.intensity[i] - expected.intensity[i]) > 2e-6f;
      labels_differing += image.labels[i] != expected.labels[i];
    }
    EXPECT_LT(differing, 250u) << scale;  // of 250 000: floats near a bin's edge
    EXPECT_LT(labels_differing, 250u) << scale;
  }
}

TEST_F(SonarGpu, PublishedGatherCountsManyPixelsOfACellOnce) {
  // 1 x 1 bins in angle: the whole image is one cell, in which each range bin counts once.
  const auto fine = sonar::symmetric_grid(1, 5, radians(90), radians(28), {50, 64, 64});
  const auto inputs = test::sector_images(fine, seabed_with_two_spheres(), 1.0);
  for (const sonar::Bins bins :
       {sonar::Bins{50, 1, 1}, sonar::Bins{1, 7, 3}, sonar::Bins{1, 1, 1}}) {
    const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), bins);
    const SonarImage expected = sonar::reference_image(grid, inputs);
    const SonarImage image = run(grid, inputs, Gather::kPublished);
    for (std::size_t i = 0; i < image.intensity.size(); ++i)
      EXPECT_NEAR(image.intensity[i], expected.intensity[i], 2e-6f) << i;
  }
}

TEST_F(SonarGpu, BeamGathersAgreeWithTheReferenceWhereEveryCellHasAPixel) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {500, 500, 500});
  const auto inputs = test::sector_images(grid, test::sphere(Vec3(0, 0, -3), 1.4), 1.0);
  // The reference counts a cell's pixels in two range bins twice, so the truth is one ray a beam.
  double truth = 0.0;
  const auto shape = test::sphere(Vec3(0, 0, -3), 1.4);
  for (std::uint32_t c = 0; c < 500; ++c)
    for (std::uint32_t e = 0; e < 500; ++e) {
      const Vec3 d = sonar::direction(grid.azimuth_rad(c), grid.elevation_rad(e));
      if (const auto hit = shape(d)) truth += std::max(0.0, -glm::dot(hit->normal, d)) / 500.0;
    }
  for (const Gather gather : {Gather::kNearest, Gather::kPlane})
    EXPECT_NEAR(total(run(grid, inputs, gather)) / truth, 1.0, 0.005) << name_of(gather);
}

TEST_F(SonarGpu, GivesTheSameBitsEveryRun) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {500, 501, 499});
  const auto inputs = test::sector_images(grid, seabed_with_two_spheres(), 0.5);
  for (const Gather gather : {Gather::kNearest, Gather::kPlane, Gather::kPublished}) {
    auto made = sonar::ImageGather::create(device(), grid, inputs, gather);
    ASSERT_TRUE(made.ok()) << made.error().message;
    std::uint64_t first = 0;
    for (int i = 0; i < 20; ++i) {
      const auto image = (*made)->run();
      ASSERT_TRUE(image.ok());
      Hash64 hash;
      hash.add_span(std::span<const float>(image->intensity));
      hash.add_span(std::span<const std::uint16_t>(image->labels));
      if (i == 0) first = hash.value();
      EXPECT_EQ(hash.value(), first) << name_of(gather);
    }
  }
}

TEST_F(SonarGpu, ADeviceWithMemoryOfItsOwnGivesTheSameBits) {
  gpu::DeviceOptions options;
  options.validation = true;
  options.shared_memory = false;
  NERITIC_ASSERT_OK(const auto other, gpu::Device::create(options));
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {300, 301, 199});
  const auto inputs = test::sector_images(grid, seabed_with_two_spheres(), 0.7);
  SonarImage images[2];
  for (gpu::Device* const at : {&device(), other.get()}) {
    NERITIC_ASSERT_OK(const auto made,
                      sonar::ImageGather::create(*at, grid, inputs, Gather::kPlane));
    NERITIC_ASSERT_OK(images[at == other.get()], made->run());
  }
  EXPECT_GT(total(images[0]), 1.0);
  EXPECT_EQ(images[0].intensity, images[1].intensity);
  EXPECT_EQ(images[0].labels, images[1].labels);
  EXPECT_TRUE(other->validation_log().messages.empty());
}

TEST_F(SonarGpu, FineRangeBinsAddUpToCoarseOnes) {
  // Within what the thousandth of a bin that guards edges may move, and rounding.
  const auto wide = sonar::symmetric_grid(1, 5, radians(90), radians(28), {16000, 50, 100});
  const auto narrow = sonar::symmetric_grid(1, 5, radians(90), radians(28), {500, 50, 100});
  const auto inputs = test::sector_images(narrow, seabed_with_two_spheres(), 1.0);
  const SonarImage many = run(wide, inputs, Gather::kNearest),
                   few = run(narrow, inputs, Gather::kNearest);
  double moved = 0.0;
  for (std::uint32_t r = 0; r < 500; ++r)
    for (std::uint32_t c = 0; c < 50; ++c) {
      double sum = 0.0;
      for (std::uint32_t k = 0; k < 32; ++k) sum += many.intensity[(r * 32 + k) * 50 + c];
      moved += std::abs(sum - few.intensity[r * 50 + c]);
    }
  EXPECT_GT(total(few), 1.0);
  EXPECT_LT(moved, 5e-3 * total(few));
}

TEST_F(SonarGpu, ExtremesOfRangeApertureAndBins) {
  struct Case {
    const char* what;
    BeamGrid grid;
    double radius;
  };
  const Case cases[] = {
      {"from range 0", sonar::symmetric_grid(0, 2, radians(90), radians(28), {100, 64, 64}), 0.05},
      {"to 10 km", sonar::symmetric_grid(1, 10000, radians(90), radians(28), {2000, 64, 64}),
       9876.0},
      {"half a degree of elevation",
       sonar::symmetric_grid(1, 5, radians(90), radians(.5), {99, 65, 3}), 2.22},
      {"one bin", sonar::symmetric_grid(1, 5, radians(90), radians(28), {1, 1, 1}), 2.0},
      {"2000 bins", sonar::symmetric_grid(1, 5, radians(90), radians(28), {2000, 2000, 40}),
       2.2225}};
  for (const Case& c : cases) {
    const auto inputs = test::sector_images(c.grid, test::sphere(Vec3(0.0), c.radius), 1.2);
    const auto row = *sonar::bin_index(c.radius, c.grid.limits.range_min_m,
                                       c.grid.limits.range_max_m, c.grid.bins.range);
    for (const Gather gather : {Gather::kNearest, Gather::kPlane}) {
      const SonarImage image = run(c.grid, inputs, gather);
      for (std::uint32_t r = 0; r < c.grid.bins.range; ++r)
        for (std::uint32_t k = 0; k < c.grid.bins.azimuth; ++k)
          ASSERT_NEAR(image.intensity[std::size_t{r} * c.grid.bins.azimuth + k],
                      r == row ? 1.0f : 0.0f, 1e-4f)
              << c.what << ' ' << name_of(gather) << ' ' << r << ',' << k;
    }
  }
}

TEST_F(SonarGpu, AGrazingPlaneLosesNoEnergyAndStaysInItsRows) {
  // A seabed 10 cm below: 1.1 degrees grazing at 5 m. The plane gather must find the rows that the
  // closed form gives: elevation phi hits at 0.1 / sin(-phi). A row is all of its elevations.
  const BeamGrid grid = sonar::symmetric_grid(0.5, 5, radians(60), radians(28), {450, 60, 400});
  const auto inputs = test::sector_images(grid, test::plane(Vec3(0, -1, 0), 0.1), 0.5);
  const SonarImage image = run(grid, inputs, Gather::kPlane);
  std::vector<double> expected(450, 0.0);
  constexpr int kParts = 400 * 256;
  for (int e = 0; e < kParts; ++e) {
    const double phi = radians(-14.0 + 28.0 * (e + 0.5) / kParts);
    if (phi >= 0.0) continue;
    if (const auto row = sonar::bin_index(0.1 / std::sin(-phi), 0.5, 5.0, 450))
      expected[*row] += std::sin(-phi) / kParts;
  }
  double misplaced = 0.0, sum = 0.0;
  for (std::uint32_t r = 0; r < 450; ++r) {
    sum += expected[r];
    misplaced += std::abs(image.intensity[r * 60 + 30] - expected[r]);
  }
  EXPECT_GT(sum, 0.01);
  EXPECT_LT(misplaced, 0.03 * sum);
}

TEST_F(SonarGpu, NaNInfinityAndZeroNormalsAreSilence) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {50, 50, 50});
  const auto good = test::sector_images(grid, test::sphere(Vec3(0.0), 3.0), 0.5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), -1.0, 0.0})
    for (const Gather gather : {Gather::kNearest, Gather::kPlane, Gather::kPublished}) {
      auto inputs = good;
      std::fill(inputs[0].depth.begin(), inputs[0].depth.end(), bad);
      EXPECT_EQ(total(run(grid, inputs, gather)), 0.0) << bad << name_of(gather);
      if (bad == -1.0 || bad == 0.0 || std::isnan(bad)) {
        inputs = good;
        std::fill(inputs[0].normals.begin(), inputs[0].normals.end(), bad);
        EXPECT_EQ(total(run(grid, inputs, gather)), 0.0) << bad << name_of(gather);
      }
    }
}

TEST_F(SonarGpu, ReflectivityScalesTheReturn) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {50, 50, 50});
  auto inputs = test::sector_images(grid, test::sphere(Vec3(0.0), 3.01), 1.5);
  inputs[0].reflectivity.assign(inputs[0].depth.size(), 0.25f);
  for (const Gather gather : {Gather::kNearest, Gather::kPlane, Gather::kPublished})
    EXPECT_NEAR(total(run(grid, inputs, gather)), 0.25 * 50, 1e-3) << name_of(gather);
  EXPECT_NEAR(total(sonar::reference_image(grid, inputs)), 0.25 * 50, 1e-3);
}

TEST_F(SonarGpu, ImagesOfNoPixelsAreRefused) {
  SonarInput nothing;
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {50, 50, 50});
  const auto made =
      sonar::ImageGather::create(device(), grid, std::span(&nothing, 1), Gather::kPlane);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::kBadInput);
}

TEST_F(SonarGpu, AnImageThatNoBufferHoldsIsRefusedWithWhatFits) {
  const BeamGrid grid =
      sonar::symmetric_grid(1, 5, radians(90), radians(28), {sonar::kMaxBins, sonar::kMaxBins, 4});
  sonar::GatherOptions options;
  options.echo = sonar::EchoOptions{};
  const auto made =
      sonar::SonarGather::create(device(), grid, sonar::plan_sectors(grid), {}, options);
  if (made.ok()) GTEST_SKIP() << "this device holds it";
  EXPECT_EQ(made.error().code, ErrorCode::kUnsupported);
  // The range that the line names fits.
  const std::string& message = made.error().message;
  double farthest_m = 0.0;
  const std::size_t at = message.find("range_m = [1, ");
  ASSERT_NE(at, std::string::npos) << message;
  ASSERT_EQ(std::sscanf(message.c_str() + at, "range_m = [1, %lf]", &farthest_m), 1) << message;
  sonar::BeamGrid shorter = grid;
  shorter.bins.range = static_cast<std::uint32_t>(grid.bins.range * (farthest_m - 1.0) / 4.0);
  EXPECT_LE(std::uint64_t{shorter.bins.range} * grid.bins.azimuth * 2 * sizeof(std::uint32_t),
            device().limits().maxStorageBufferRange);
  EXPECT_GT(farthest_m, 1.0);
}

TEST_F(SonarGpu, RecordsThatNoDeviceHoldsAreRefusedByName) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28),
                                              {4, sonar::kMaxBins, sonar::kMaxBins});  // 4 GiB
  sonar::GatherOptions options;
  options.echo = sonar::EchoOptions{.records = true};
  const auto made =
      sonar::SonarGather::create(device(), grid, sonar::plan_sectors(grid), {}, options);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(made.error().message.find("labels.energy"), std::string::npos);
  for (const char* key : {"elevation_deg", "azimuth_deg", "quality"})
    EXPECT_NE(made.error().message.find(key), std::string::npos) << made.error().message;
}

}  // namespace
}  // namespace neritic
