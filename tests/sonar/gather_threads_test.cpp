// However threads share a gather's work, its bits are the same: one thread a column, that has what
// it saw of one row at hand for the next, or many that look anew.
#include <gtest/gtest.h>

#include "engine/core/intrinsics.hpp"
#include "engine/gpu/frames.hpp"
#include "tests/sonar/analytic.hpp"
#include "tests/sonar/gpu_fixture.hpp"

namespace neritic {
namespace {

using sonar::BeamGrid;
using sonar::Gather;
using sonar::SonarImage;
using test::seabed_with_two_spheres;
using test::total;

class SonarThreads : public test::SonarGpuTest {
 protected:
  // Upright images, taken for a view with leaning sides.
  Result<std::vector<std::uint32_t>> leaning_sums(const BeamGrid& grid,
                                                  const sonar::GatherOptions& options);
};

// A thread a column in texel buffers, in storage buffers, and a workgroup a column with atomics.
constexpr sonar::GatherThreads kWaysToSum[] = {
    {.atomics = false}, {.atomics = false, .texels = false}, {.atomics = true}};

TEST_F(SonarThreads, GiveTheSameBits) {
  // The second with rows that are taller than a range bin.
  for (const auto& bins : {sonar::Bins{300, 301, 199}, sonar::Bins{900, 301, 40}}) {
    const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), bins);
    const auto inputs = test::sector_images(grid, seabed_with_two_spheres(), 0.7);
    for (const Gather gather : {Gather::kNearest, Gather::kPlane}) {
      std::vector<SonarImage> images;
      for (const sonar::GatherThreads& threads : kWaysToSum) {
        auto made = sonar::ImageGather::create(device(), grid, inputs, gather, threads);
        ASSERT_TRUE(made.ok()) << made.error().message;
        auto image = (*made)->run();
        ASSERT_TRUE(image.ok());
        images.push_back(std::move(*image));
      }
      EXPECT_GT(total(images[0]), 1.0);
      for (std::size_t i = 1; i < images.size(); ++i) {
        EXPECT_EQ(images[0].intensity, images[i].intensity) << i;
        EXPECT_EQ(images[0].labels, images[i].labels) << i;
      }
    }
  }
}

TEST_F(SonarThreads, GiveTheSameBitsOfTerms) {
  scene::Sonar sonar;
  sonar.azimuth_rad = radians(60.0);
  sonar.elevation_rad = radians(28.0);
  sonar.bins_azimuth = 64;
  sonar.terms.level = scene::SonarLevel{};
  // Rows that are lower than a range bin, then taller.
  for (const bool tall : {false, true})
    for (const bool speckle : {false, true}) {
      SCOPED_TRACE(fmt::format("tall {} speckle {}", tall, speckle));
      sonar.bins_range = tall ? 1500 : 200;
      sonar.bins_elevation = tall ? 60 : 300;
      sonar.terms.speckle.reset();
      if (speckle) sonar.terms.speckle = scene::SonarSpeckle{};
      NERITIC_ASSERT_OK(const auto heads, sonar::plan_heads(sonar));
      const sonar::Head& head = heads.front();
      EXPECT_EQ(sonar::footprint_of(head.samples, {}),
                tall ? shared::kSonarFootprintBounded : shared::kSonarFootprintShared);
      // A bin's power of all low rows overflows 32 bits: what is carried counts too.
      ASSERT_GT(head.samples.bins.elevation, tall ? 16u : 2 * 16u);
      const auto seen = tall ? seabed_with_two_spheres() : test::sphere(Vec3(0.0), 3.004, 4);
      const auto inputs = test::sector_images(head.samples, seen, 1.0);
      std::vector<SonarImage> images;
      for (const sonar::GatherThreads& threads : kWaysToSum) {
        NERITIC_ASSERT_OK(
            const auto made,
            sonar::ImageGather::create(device(), sonar, head, inputs[0], Gather::kPlane, threads));
        NERITIC_ASSERT_OK(SonarImage image, made->run());
        images.push_back(std::move(image));
      }
      EXPECT_GT(total(images[0]), 0.0);
      for (std::size_t i = 1; i < images.size(); ++i) {
        EXPECT_EQ(images[0].intensity, images[i].intensity) << i;
        EXPECT_EQ(images[0].labels, images[i].labels) << i;
      }
    }
}

// Sums that a gather leaves for the host.
Result<std::vector<std::uint32_t>> SonarThreads::leaning_sums(const BeamGrid& grid,
                                                              const sonar::GatherOptions& options) {
  const std::vector<sonar::Sector> sectors = sonar::plan_sectors(grid);
  const sonar::LeaningView view = sonar::leaning_view(grid, sectors[0], 2.0);
  const auto [width, height] = std::pair(view.size.width, view.size.height);
  const Intrinsics pinhole = intrinsics_of(view.tangents, width, height);
  const auto in = test::images_of(seabed_with_two_spheres(), width, height, pinhole);
  std::vector<glm::vec4> texels(in.depth.size());
  for (std::size_t i = 0; i < texels.size(); ++i)
    texels[i] = {in.normals[3 * i], in.normals[3 * i + 1], in.normals[3 * i + 2], in.depth[i]};
  NERITIC_TRY(gpu::Image surfaces,
              gpu::Image::create(
                  device(), {.name = "surfaces",
                             .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                             .width = width,
                             .height = height,
                             .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                             .array_view = true}));
  NERITIC_TRY_STATUS(gpu::upload_image(device(), surfaces, std::as_bytes(std::span(texels))));
  const sonar::GBufferLayout layout{
      .width = width, .height = height, .intrinsics = pinhole, .packed = true, .lean = view.lean};
  NERITIC_TRY(const auto gather,
              sonar::SonarGather::create(device(), grid, sectors, layout, options));
  NERITIC_TRY(gpu::Buffer host,
              gpu::Buffer::create(device(), {.name = "sums",
                                             .size = gather.sums_bytes(),
                                             .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                             .memory = gpu::MemoryUse::kReadback}));
  NERITIC_TRY(const auto frames, gpu::Frames::create(device(), 1));
  graph::Executor executor(*frames);
  graph::FrameGraph graph;
  sonar::SonarGather::Inputs inputs;
  inputs.normals =
      graph.import_image(surfaces, {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  const auto sums = gather.declare(graph, inputs).sums;
  graph.output(graph::copy_buffer(graph, "sums to host", sums, "sums", host),
               graph::Access::kHostRead);
  NERITIC_TRY(gpu::Commands * commands, frames->begin());
  NERITIC_TRY([[maybe_unused]] const graph::Plan* plan, executor.run(graph, *commands));
  NERITIC_TRY(const std::uint64_t done, frames->submit());
  NERITIC_TRY_STATUS(frames->wait(done));
  const auto words = host.mapped<std::uint32_t>();
  return std::vector<std::uint32_t>(words.begin(), words.end());
}

// Rows of pixels that are shifted against each other, under rows that are taller than a bin: an
// even number of them, an odd one, one.
TEST_F(SonarThreads, GiveTheSameBitsOfLeaningViews) {
  for (const std::uint32_t n_elevation : {60u, 61u, 1u})
    for (const bool terms : {false, true}) {
      SCOPED_TRACE(fmt::format("{} rows, terms {}", n_elevation, terms));
      const BeamGrid grid =
          sonar::symmetric_grid(1, 5, radians(110), radians(28), {1500, 64, n_elevation});
      std::vector<std::vector<std::uint32_t>> sums;
      for (const sonar::GatherThreads& threads : kWaysToSum) {
        sonar::GatherOptions options{.labels = false, .reflectivity = false, .threads = threads};
        if (terms) options.echo.emplace();
        EXPECT_EQ(sonar::footprint_of(grid, options), shared::kSonarFootprintBounded);
        NERITIC_ASSERT_OK(sums.emplace_back(), leaning_sums(grid, options));
      }
      EXPECT_GT(std::ranges::count_if(sums[0], [](std::uint32_t n) { return n > 0; }), 100);
      for (std::size_t i = 1; i < sums.size(); ++i) EXPECT_EQ(sums[0], sums[i]) << i;
    }
}

}  // namespace
}  // namespace neritic
