// Cost against the sizes: range, azimuth and elevation bins, G-buffer pixels, triangles drawn.
#include <algorithm>

#include "engine/scene/shapes.hpp"
#include "sonar/image_gather.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

Status sweep_bins(Suite& suite, gpu::Device& device, const std::string& axis,
                  std::uint32_t sonar::Bins::*bins, const std::vector<std::uint32_t>& counts,
                  sonar::Gather mode = sonar::Gather::kPlane) {
  std::vector<std::unique_ptr<sonar::ImageGather>> gathers;
  std::vector<Contender> contenders;
  for (const std::uint32_t count : counts) {
    sonar::BeamGrid grid;
    grid.bins.*bins = count;
    const sonar::SonarInput input = relief_input(grid, 500, 500);
    NERITIC_TRY(auto gather, sonar::ImageGather::create(device, grid, std::span(&input, 1), mode));
    gathers.push_back(std::move(gather));
    sonar::ImageGather& g = *gathers.back();
    NERITIC_TRY(const sonar::SonarImage heard, g.run());
    const auto cells = std::ranges::count_if(heard.intensity, [](float i) { return i > 0.0f; });
    contenders.push_back({fmt::format("sweep/{}_{}", axis, count),
                          [&g]() -> Result<Sample> {
                            NERITIC_TRY(const sonar::SonarImage image, g.run());
                            Sample sample{0.0, parts_of(g.pass_times()), hash_of(image)};
                            sample.parts["wall"] = g.wall_ms();
                            sample.ms = sample.parts["sonar clear"] + sample.parts["sonar gather"];
                            return sample;
                          },
                          {{axis, double(count)}, {"heard_cells", double(cells)}}});
  }
  return suite.measure(std::move(contenders));
}

Status sweep_pixels(Suite& suite, gpu::Device& device) {
  std::vector<std::unique_ptr<testbed::Session>> sessions;
  std::vector<Contender> contenders;
  for (const double scale : {0.25, 0.5, 1.0, 2.0}) {
    NERITIC_TRY(auto session,
                open_scene(suite, device, "benchmark_23k.toml",
                           [&](scene::Scene& scene) { scene.sonars.at(0).gbuffer_scale = scale; }));
    testbed::FrameRequest request;
    request.sonars = {0};
    request.capture = testbed::Capture{.color = false, .motion = false}.without_geometry();
    contenders.push_back(
        frames_of(fmt::format("sweep/gbuffer_scale_{}", scale), *session, request));
    contenders.back().facts = {{"gbuffer_scale", scale}};
    sessions.push_back(std::move(session));
  }
  return suite.measure(std::move(contenders));
}

// A sphere ahead of a sonar, of more and more triangles.
Status sweep_triangles(Suite& suite, gpu::Device& device) {
  std::vector<std::unique_ptr<testbed::Session>> sessions;
  std::vector<Contender> contenders;
  for (const int segments : {16, 50, 100, 160, 320, 500}) {
    scene::Scene scene;
    scene.models.push_back(std::make_shared<const scene::Model>(scene::make_sphere(0.8, segments)));
    scene::Object sphere;
    sphere.name = "sphere";
    sphere.model = 0;
    sphere.instance = 1;
    sphere.mount.pose.position_m = Vec3(0.0, 0.0, -3.0);
    scene.objects.push_back(sphere);
    scene::Sonar sonar;
    sonar.name = "sonar";
    scene.sonars.push_back(sonar);
    const std::size_t triangles = scene::triangle_count(*scene.models[0]);
    NERITIC_TRY(auto session, testbed::Session::create(device, std::move(scene)));
    testbed::FrameRequest request;
    request.sonars = {0};
    request.capture = testbed::Capture{.color = false, .motion = false}.without_geometry();
    contenders.push_back(
        frames_of(fmt::format("sweep/triangles_{}", triangles), *session, request));
    contenders.back().facts = {{"triangles", static_cast<double>(triangles)}};
    sessions.push_back(std::move(session));
  }
  return suite.measure(std::move(contenders));
}

}  // namespace

Status bench_sweeps(Suite& suite, gpu::Device& device) {
  if (!suite.options().sweep || !suite.wants("sweep")) return {};
  NERITIC_TRY_STATUS(
      sweep_bins(suite, device, "n_range", &sonar::Bins::range, {50, 500, 2000, 5000}));
  NERITIC_TRY_STATUS(sweep_bins(suite, device, "n_range_nearest", &sonar::Bins::range,
                                {50, 500, 2000, 5000}, sonar::Gather::kNearest));
  NERITIC_TRY_STATUS(
      sweep_bins(suite, device, "n_azimuth", &sonar::Bins::azimuth, {125, 250, 500, 1000, 2000}));
  NERITIC_TRY_STATUS(sweep_bins(suite, device, "n_elevation", &sonar::Bins::elevation,
                                {125, 250, 500, 1000, 2000}));
  NERITIC_TRY_STATUS(sweep_pixels(suite, device));
  return sweep_triangles(suite, device);
}

}  // namespace neritic::bench
