#include "sonar/label_energy.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "tests/support/cpu_time.hpp"

namespace neritic {
namespace {

using sonar::EnergyRecord;
using sonar::LabelImage;

// A ray that spans the rows nearest to farthest, its energy in one bin.
EnergyRecord ray(std::uint32_t bin, std::uint32_t counts, int class_id, int instance, int nearest,
                 int farthest) {
  return {bin,
          counts,
          static_cast<std::uint16_t>(class_id),
          static_cast<std::uint16_t>(instance),
          static_cast<std::uint16_t>(nearest),
          static_cast<std::uint16_t>(farthest)};
}
EnergyRecord ray(std::uint32_t bin, std::uint32_t counts, int class_id, int instance) {
  const int row = static_cast<int>(std::min(bin, 65535u));
  return ray(bin, counts, class_id, instance, row, row);
}
EnergyRecord nothing() {
  return ray(sonar::kNoReturn, 0, 0, 0);
}

// The rows between two rays' spans that the nearer one hides; empty: it hides none.
std::pair<int, int> hidden_rows(const EnergyRecord& a, const EnergyRecord& b) {
  if (a.bin == sonar::kNoReturn || b.bin == sonar::kNoReturn) return {0, 0};
  const bool a_nearer = a.nearest < b.nearest;
  const EnergyRecord &near = a_nearer ? a : b, &far = a_nearer ? b : a;
  const int gap = int{far.nearest} - near.farthest - 1;
  const int spans = near.farthest - near.nearest + far.farthest - far.nearest;
  if (gap <= 1 || gap <= spans / 4.0) return {0, 0};
  return {near.farthest + 1, far.nearest};
}

// The definition, with maps.
LabelImage plain_labels(const std::vector<EnergyRecord>& records, std::uint32_t n_range,
                        std::uint32_t n_beams, std::uint32_t samples) {
  const std::size_t cells = std::size_t{n_range} * n_beams, width = std::size_t{n_beams} * samples;
  std::vector<std::map<std::pair<int, int>, std::uint64_t>> heard(cells);
  std::vector<int> hidden(cells), ended(cells), surface(cells), rays(n_beams);
  std::vector<const EnergyRecord*> below(width);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const EnergyRecord& r = records[i];
    const std::size_t beam = i % width / samples;
    if (r.counts > 0)
      for (std::uint32_t row = 0; row < n_range; ++row) {
        const bool shared = r.bin == sonar::kShared && row >= r.nearest && row <= r.farthest;
        if (shared)
          heard[row * n_beams + beam][{r.class_id, r.instance}] +=
              std::max(1u, r.counts / (r.farthest - r.nearest + 1u));
        else if (row == r.bin)
          heard[row * n_beams + beam][{r.class_id, r.instance}] += r.counts;
      }
    if (r.class_id == sonar::kGhost) continue;
    ++rays[beam];
    for (std::uint32_t row = 0; row < n_range && r.bin != sonar::kNoReturn; ++row) {
      ended[row * n_beams + beam] += r.farthest < row;
      surface[row * n_beams + beam] |= r.farthest == row || r.nearest == row;
    }
    if (below[i % width]) {
      const auto [from, to] = hidden_rows(*below[i % width], r);
      for (int row = from; row < std::min(to, int(n_range)); ++row)
        ++hidden[std::size_t(row) * n_beams + beam];
    }
    below[i % width] = &r;
  }
  LabelImage out{n_range, n_beams, std::vector<std::uint16_t>(cells),
                 std::vector<std::uint16_t>(cells), std::vector<float>(cells)};
  for (std::size_t i = 0; i < cells; ++i) {
    const int all_rays = rays[i % n_beams];
    const bool ended_nearer = 2 * ended[i] > all_rays && !surface[i];
    if (heard[i].empty() && (hidden[i] > 0 || ended_nearer)) {
      out.classes[i] = sonar::kShadow;
      out.fraction[i] = std::min(
          1.0f, std::max(float(hidden[i]) / float(samples),
                         ended_nearer ? float(double(ended[i]) / double(all_rays)) : 0.0f));
    }
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
    r.nearest =
        static_cast<std::uint16_t>(std::min(r.bin, 65535u) - (r.bin > 0 ? random() % 2 : 0));
    r.farthest =
        static_cast<std::uint16_t>(std::min(65535, r.nearest + static_cast<int>(random() % 4)));
    if (kind == 4) r.bin = sonar::kShared;
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
    // The edge of the aperture at which the rows begin does not matter.
    const std::size_t width = std::size_t{c.beams} * c.samples;
    for (std::uint32_t row = 0; row < c.elevations / 2; ++row)
      std::swap_ranges(records.begin() + row * width, records.begin() + (row + 1) * width,
                       records.begin() + (c.elevations - 1 - row) * width);
    EXPECT_EQ(sonar::label_by_energy(records, c.n_range, c.beams, c.samples).classes,
              plain.classes);
  }
}

TEST(LabelEnergy, ShadowLiesBetweenAnEdgeAndWhatIsSeenPastIt) {
  // One beam over a floor, rays from below: the floor, a box's front that has no echo, its top, the
  // floor again, nothing.
  const std::vector<EnergyRecord> records{ray(1, 90, 1, 1, 0, 1),   ray(2, 90, 1, 1, 2, 3),
                                          ray(4, 0, 5, 7),          ray(4, 50, 5, 7, 4, 4),
                                          ray(10, 70, 1, 1, 9, 11), nothing()};
  const LabelImage labels = sonar::label_by_energy(records, 14, 1);
  const std::uint16_t s = sonar::kShadow;
  // Row 3, 9 and 11 are of rays whose energy lies beside. Five of six rays ended nearer than what
  // is beyond.
  EXPECT_EQ(labels.classes, (std::vector<std::uint16_t>{0, 1, 1, 0, 5, s, s, s, s, 0, 1, 0, s, s}));
  EXPECT_EQ(labels.fraction[13], 5.0f / 6.0f);
  EXPECT_EQ(labels.instances[4], 7);
  EXPECT_EQ(labels.fraction[4], 1.0f);
  EXPECT_EQ(labels.instances[5], 0);
  EXPECT_EQ(labels.fraction[5], 1.0f);
}

TEST(LabelEnergy, ASharedRaySoundsInAllItsRowsAndLeavesNoShadow) {
  const std::vector<EnergyRecord> records{ray(sonar::kShared, 90, 1, 1, 1, 3),
                                          ray(sonar::kShared, 80, 1, 1, 4, 9), nothing()};
  const LabelImage labels = sonar::label_by_energy(records, 8, 1);
  EXPECT_EQ(labels.classes, (std::vector<std::uint16_t>{0, 1, 1, 1, 1, 1, 1, 1}));
}

TEST(LabelEnergy, AShadowTellsHowManyOfItsBeamsColumnsAreHidden) {
  // Two columns; past the first one's edge something beyond the range, the second sees no edge.
  const std::vector<EnergyRecord> records{ray(1, 9, 2, 1), ray(1, 9, 2, 1), ray(80, 0, 1, 1),
                                          ray(2, 9, 2, 1), nothing(),       nothing()};
  const LabelImage labels = sonar::label_by_energy(records, 5, 1, 2);
  EXPECT_EQ(labels.classes, (std::vector<std::uint16_t>{0, 2, 2, sonar::kShadow, sonar::kShadow}));
  EXPECT_EQ(labels.fraction[3], 0.5f);
}

TEST(LabelEnergy, AGhostIsHeardButCastsNoShadow) {
  const std::vector<EnergyRecord> records{ray(6, 10, 3, 0), ray(6, 10, 2, 5),
                                          ray(2, 10, sonar::kGhost, 0),
                                          ray(5, 10, sonar::kGhost, 0)};
  const LabelImage labels = sonar::label_by_energy(records, 8, 1);
  EXPECT_EQ(labels.classes, (std::vector<std::uint16_t>{0, 0, sonar::kGhost, 0, 0, sonar::kGhost, 2,
                                                        sonar::kShadow}));
  EXPECT_EQ(labels.instances[6], 5);  // a tie: the smaller class
  EXPECT_EQ(labels.fraction[6], 0.5f);
}

TEST(LabelEnergy, WhereMostRaysEndedNearerThereIsShadow) {
  // Two, then three of four rays end in open water: half is not most.
  std::vector<EnergyRecord> records{ray(1, 9, 2, 1), ray(1, 9, 2, 1), nothing(), nothing()};
  const auto classes = [&](std::span<const std::uint8_t> weights) {
    return sonar::label_by_energy(records, 4, 1, 1, weights).classes;
  };
  const std::uint16_t s = sonar::kShadow;
  const std::vector<std::uint16_t> open{0, 2, 0, 0}, hidden{0, 2, s, s};
  EXPECT_EQ(classes({}), open);
  records[2] = ray(1, 9, 2, 1);
  EXPECT_EQ(classes({}), hidden);
  EXPECT_EQ(sonar::label_by_energy(records, 4, 1).fraction[3], 0.75f);
  // By weight: what the pattern hears little of counts little.
  EXPECT_EQ(classes(std::vector<std::uint8_t>{10, 10, 10, 255}), open);
  EXPECT_EQ(classes(std::vector<std::uint8_t>{10, 255, 10, 10}), hidden);
}

TEST(LabelEnergy, AFrameTakesMilliseconds) {
  // 512 x 512 rays on a floor with objects before it, as in a real frame.
  std::vector<EnergyRecord> records(512 * 512);
  for (std::uint32_t e = 0; e < 512; ++e)
    for (std::uint32_t a = 0; a < 512; ++a) {
      const bool object = (a / 40 + e / 50) % 5 == 0;
      records[e * 512 + a] =
          ray(object ? 200 + a % 30 : 60 + e * 440 / 512, 1000 + a,
              static_cast<int>(object ? 2 + a / 40 % 4 : 1), static_cast<int>(object ? a / 40 : 0));
    }
  const double least_ms = test::least_cpu_ms(100.0, [&] {
    const LabelImage labels = sonar::label_by_energy(records, 500, 512);
    EXPECT_EQ(labels.n_beams, 512u);
  });
  fmt::print("512 x 512 records, 500 bins: {:.2f} ms\n", least_ms);
  // 3 ms and less on one core; sanitizers and busy machines take longer.
  EXPECT_LT(least_ms, 100.0);
}

}  // namespace
}  // namespace neritic
