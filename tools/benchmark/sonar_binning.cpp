// The sonar's gather against the published algorithm's volume at -O3, on the same 500 x 500 pixels.
#include <numeric>

#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"
#include "sonar/image_gather.hpp"
#include "sonar/literal_volume.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

constexpr std::uint32_t kPixels = 500;  // a side
// A pinhole's pixels are no cells: the volume has holes and collisions that only the published
// gather repeats. The other two sample every cell, and agree with each other.
constexpr double kEnergyTolerance = 0.005;

double total(std::span<const float> image) {
  return std::accumulate(image.begin(), image.end(), 0.0);
}

// GPU time of the clear and the gather, or the wall time of the whole: declare, record, submit,
// run, wait, image at the host. energy: of the newest image.
Contender gather_contender(const std::string& name, sonar::ImageGather& gather, bool wall,
                           double& energy) {
  return {name, [&gather, wall, &energy]() -> Result<Sample> {
            NERITIC_TRY(const sonar::SonarImage image, gather.run());
            energy = total(image.intensity);
            Sample sample{gather.wall_ms(), parts_of(gather.pass_times()), hash_of(image)};
            if (!wall) sample.ms = sample.parts["sonar clear"] + sample.parts["sonar gather"];
            if (wall) sample.parts.clear();
            return sample;
          }};
}

void same_energy(Suite& suite, const std::string& a, double energy_a, const std::string& b,
                 double energy_b) {
  if (std::abs(energy_a / energy_b - 1.0) > kEnergyTolerance)
    suite.fail(fmt::format("sonar binning: energy {} by {}, {} by {}", energy_a, a, energy_b, b));
}

}  // namespace

Status bench_sonar_binning(Suite& suite, gpu::Device& device) {
  if (!suite.wants("sonar_binning")) return {};
  const sonar::BeamGrid grid;  // 1 to 5 m, 90 x 28 degrees, 500 bins an axis
  const sonar::SonarInput input = relief_input(grid, kPixels, kPixels);
  sonar::LiteralVolume volume(grid);
  const sonar::LiteralInput literal = sonar::literal_input(input);
  const double literal_energy = total(volume.run(literal));
  std::map<sonar::Gather, double> energies;

  std::vector<Contender> contenders;
  contenders.push_back({"sonar_binning/literal_volume_O3", [&]() -> Result<Sample> {
                          const TimeNs start = now_ns();
                          const std::span<const float> image = volume.run(literal);
                          const double ms = to_ms(now_ns() - start);
                          Hash64 hash;
                          hash.add_span(image);
                          return Sample{ms, {}, hash.hex()};
                        }});
  std::vector<std::unique_ptr<sonar::ImageGather>> gathers;
  for (const sonar::Gather mode :
       {sonar::Gather::kPlane, sonar::Gather::kNearest, sonar::Gather::kPublished}) {
    NERITIC_TRY(auto gather, sonar::ImageGather::create(device, grid, std::span(&input, 1), mode));
    gathers.push_back(std::move(gather));
    const std::string name = std::string("sonar_binning/") + sonar::name_of(mode);
    for (const bool wall : {false, true})
      contenders.push_back(gather_contender(name + (wall ? "_wall" : "_gpu"), *gathers.back(), wall,
                                            energies[mode]));
  }
  for (Contender& c : contenders) {
    c.facts = {{"pixels", double(kPixels) * kPixels}, {"bins", std::vector<double>{500, 500, 500}}};
    c.warm = true;
  }
  NERITIC_TRY_STATUS(suite.measure(std::move(contenders), 40));
  if (energies[sonar::Gather::kPublished] > 0.0)
    same_energy(suite, "the literal volume", literal_energy, "published",
                energies[sonar::Gather::kPublished]);
  if (energies[sonar::Gather::kNearest] > 0.0 && energies[sonar::Gather::kPlane] > 0.0)
    same_energy(suite, "nearest", energies[sonar::Gather::kNearest], "plane",
                energies[sonar::Gather::kPlane]);
  const char* opponent = "sonar_binning/literal_volume_O3";
  suite.ratio("sonar_binning_vs_literal", opponent, "sonar_binning/plane_gpu");
  suite.ratio("sonar_binning_wall_vs_literal", opponent, "sonar_binning/plane_wall");
  suite.ratio("sonar_binning_nearest_vs_literal", opponent, "sonar_binning/nearest_gpu");
  suite.ratio("sonar_binning_published_vs_literal", opponent, "sonar_binning/published_gpu");
  for (const char* mode : {"plane", "nearest", "published"})
    suite.must_agree(fmt::format("sonar_binning/{}_gpu", mode),
                     fmt::format("sonar_binning/{}_wall", mode));
  suite.aim_ratio("sonar binning against the literal volume", "sonar_binning_vs_literal", 20.0);
  return {};
}

}  // namespace neritic::bench
