#include "sonar/label_energy.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <random>

namespace neritic {
namespace {

using sonar::EnergyRecord;
using sonar::LabelImage;

// The definition, with maps.
LabelImage plain_labels(const std::vector<EnergyRecord>& records, std::uint32_t n_range,
                        std::uint32_t n_beams, std::uint32_t samples) {
  const std::size_t cells = std::size_t{n_range} * n_beams;
  std::vector<std::map<std::pair<int, int>, std::uint64_t>> heard(cells);
  std::vector<bool> behind(cells);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const EnergyRecord& r = records[i];
    const std::size_t beam = i % (std::size_t{n_beams} * samples) / samples;
    if (r.bin >= n_range) continue;
    if (r.counts > 0) heard[r.bin * n_beams + beam][{r.class_id, r.instance}] += r.counts;
    if (r.class_id != sonar::kGhost)
      for (std::uint32_t row = r.bin + 1; row < n_range; ++row) behind[row * n_beams + beam] = true;
  }
  LabelImage out{n_range, n_beams, std::vector<std::uint16_t>(cells),
                 std::vector<std::uint16_t>(cells), std::vector<float>(cells)};
  for (std::size_t i = 0; i < cells; ++i) {
    if (heard[i].empty() && behind[i]) out.classes[i] = sonar::kShadow;
    std::uint64_t all = 0, most = 0;
    for (const auto& [key, sum] : heard[i]) {
      all += sum;
      if (sum > most) {
        most = sum;
        out.classes[i] = static_cast<std::uint16_t>(key.first);
        out.instances[i] = static_cast<std::uint16_t>(key.second);
      }
    }
    if (all > 0)
      out.fraction[i] = static_cast<float>(static_cast<double>(most) / static_cast<double>(all));
  }
  return out;
}

std::vector<EnergyRecord> random_records(std::size_t n, std::uint32_t n_range, int classes,
                                         std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<EnergyRecord> out(n);
  for (EnergyRecord& r : out) {
    const auto kind = random() % 20;
    r.bin = kind == 0 ? sonar::kNoReturn : kind == 1 ? n_range + random() % 9 : random() % n_range;
    r.counts = kind == 2 ? 0 : random() % 4 == 0 ? 0xffffffff : random() % 5;
    r.class_id = kind == 3 ? sonar::kGhost : static_cast<std::uint16_t>(1 + random() % classes);
    r.instance = static_cast<std::uint16_t>(random() % 3);
  }
  return out;
}

TEST(LabelEnergy, EveryBinHasTheLabelThatGaveMost) {
  const struct {
    std::uint32_t n_range, beams, samples, elevations;
    int classes;
  } cases[] = {{64, 37, 1, 50, 4}, {7, 5, 3, 200, 60}, {500, 1, 1, 300, 2}, {1, 16, 2, 11, 3}};
  for (const auto& c : cases) {
    auto records = random_records(std::size_t{c.beams} * c.samples * c.elevations, c.n_range,
                                  c.classes, c.n_range);
    const LabelImage labels = sonar::label_by_energy(records, c.n_range, c.beams, c.samples);
    const LabelImage plain = plain_labels(records, c.n_range, c.beams, c.samples);
    EXPECT_EQ(labels.classes, plain.classes);
    EXPECT_EQ(labels.instances, plain.instances);
    EXPECT_EQ(labels.fraction, plain.fraction);
    // Rays in another order (rows exchanged) change nothing.
    const std::size_t width = std::size_t{c.beams} * c.samples;
    for (std::size_t row = 0; row + 1 < c.elevations; row += 2)
      std::swap_ranges(records.begin() + row * width, records.begin() + (row + 1) * width,
                       records.begin() + (row + 1) * width);
    EXPECT_EQ(sonar::label_by_energy(records, c.n_range, c.beams, c.samples).classes,
              plain.classes);
  }
}

TEST(LabelEnergy, ShadowLiesBehindWhatIsNearerAndWaterBefore) {
  // One beam, rays from the top: far wall, a pole before the wall, the pole's back side without an
  // echo, something beyond the range, nothing at all.
  const std::vector<EnergyRecord> records{
      {8, 100, 2, 1}, {3, 50, 5, 7}, {5, 0, 5, 7}, {12, 90, 9, 9}, {sonar::kNoReturn, 0, 0, 0}};
  const LabelImage labels = sonar::label_by_energy(records, 10, 1);
  const std::uint16_t s = sonar::kShadow;
  EXPECT_EQ(labels.classes, (std::vector<std::uint16_t>{0, 0, 0, 5, s, s, s, s, 2, s}));
  EXPECT_EQ(labels.instances[3], 7);
  EXPECT_EQ(labels.fraction[3], 1.0f);
  EXPECT_EQ(labels.instances[4], 0);
  EXPECT_EQ(labels.fraction[4], 0.0f);
}

TEST(LabelEnergy, AGhostIsHeardButCastsNoShadow) {
  const std::vector<EnergyRecord> records{{4, 10, sonar::kGhost, 0}, {6, 10, 3, 0}, {6, 10, 2, 5}};
  const LabelImage labels = sonar::label_by_energy(records, 8, 1);
  EXPECT_EQ(labels.classes,
            (std::vector<std::uint16_t>{0, 0, 0, 0, sonar::kGhost, 0, 2, sonar::kShadow}));
  EXPECT_EQ(labels.instances[6], 5);  // a tie: the smaller class
  EXPECT_EQ(labels.fraction[6], 0.5f);
}

TEST(LabelEnergy, AFrameTakesMilliseconds) {
  // 512 x 512 rays on a floor with objects before it, as in a real frame.
  std::vector<EnergyRecord> records(512 * 512);
  for (std::uint32_t e = 0; e < 512; ++e)
    for (std::uint32_t a = 0; a < 512; ++a) {
      const bool object = (a / 40 + e / 50) % 5 == 0;
      records[e * 512 + a] = {object ? 200 + a % 30 : 60 + e * 440 / 512, 1000 + a,
                              static_cast<std::uint16_t>(object ? 2 + a / 40 % 4 : 1),
                              static_cast<std::uint16_t>(object ? a / 40 : 0)};
    }
  double best_ms = 1e9;
  for (int i = 0; i < 10; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const LabelImage labels = sonar::label_by_energy(records, 500, 512);
    EXPECT_EQ(labels.n_beams, 512u);
    best_ms = std::min(
        best_ms, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                     .count());
  }
  fmt::print("512 x 512 records, 500 bins: {:.2f} ms\n", best_ms);
  EXPECT_LT(best_ms, 100.0);  // 3 ms and less on one core; sanitizers and busy machines take longer
}

}  // namespace
}  // namespace neritic
