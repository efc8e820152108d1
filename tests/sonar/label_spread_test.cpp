// Labels after pattern and pulse, against energy images of every label spread one by one, in
// double.
#include "sonar/label_spread.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace neritic {
namespace {

using sonar::EnergyRecord;
using sonar::LabelImage;
using sonar::LabelSpread;

LabelImage silent(const LabelSpread& s) {
  const std::size_t cells = std::size_t{s.n_range} * s.n_beams;
  return {s.n_range, s.n_beams, std::vector<std::uint16_t>(cells, sonar::kWater),
          std::vector<std::uint16_t>(cells), std::vector<float>(cells)};
}

std::vector<EnergyRecord> rays(const LabelSpread& s, std::uint32_t elevations, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<EnergyRecord> out(std::size_t{elevations} * s.n_columns);
  for (EnergyRecord& r : out) {
    if (random() % 4 > 0) {
      r = {sonar::kNoReturn, 0, 0, 0, 0, 0};
      continue;
    }
    const auto bin = static_cast<std::uint32_t>(random() % (s.n_range + 5));
    r = {random() % 2 ? bin : sonar::kShared,
         static_cast<std::uint32_t>(random() % 1000),
         static_cast<std::uint16_t>(1 + random() % 3),
         static_cast<std::uint16_t>(random() % 2),
         static_cast<std::uint16_t>(bin),
         static_cast<std::uint16_t>(bin + random() % 6)};
  }
  return out;
}

using Energies =
    std::map<std::uint32_t, std::vector<double>>;  // by label: [n_range][columns or beams]

Energies of_columns(const LabelSpread& s, const std::vector<EnergyRecord>& records) {
  Energies out;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const EnergyRecord& r = records[i];
    if (r.counts == 0) continue;
    auto& image = out[std::uint32_t{r.class_id} << 16 | r.instance];
    image.resize(std::size_t{s.n_range} * s.n_columns);
    const bool shared = r.bin == sonar::kShared;
    const std::uint32_t from = shared ? r.nearest : r.bin, upto = shared ? r.farthest : r.bin;
    for (std::uint32_t row = from; row <= upto && row < s.n_range; ++row)
      image[row * s.n_columns + i % s.n_columns] +=
          s.gain[row] * double{static_cast<float>(r.counts)} / (upto - from + 1.0);
  }
  return out;
}

// As the receiver does it to a field (sonar_spread.comp): across, between columns where they turn,
// then along range.
std::vector<double> spread(const LabelSpread& s, const std::vector<double>& columns) {
  const int n = static_cast<int>(s.n_columns), bins = static_cast<int>(s.n_range);
  const auto column = [&](int c, int row) {
    if (s.wrap) c = (c % n + n) % n;
    return c >= 0 && c < n ? columns[static_cast<std::size_t>(row * n + c)] : 0.0;
  };
  std::vector<double> across(std::size_t{s.n_range} * s.n_beams), out(across.size());
  for (int row = 0; row < bins; ++row)
    for (std::uint32_t b = 0; b < s.n_beams; ++b) {
      const double turned = s.first_shift + s.shift * row, part = turned - std::floor(turned);
      const int start =
          static_cast<int>(b * s.stride) + s.across.first + static_cast<int>(std::floor(turned));
      const std::uint32_t kernel = std::min(b, s.across.kernels - 1);
      for (int k = 0; k < s.across.size(); ++k)
        across[row * s.n_beams + b] +=
            s.across.weights[kernel * s.across.size() + k] *
            ((1.0 - part) * column(start + k, row) + part * column(start + k + 1, row));
    }
  for (int row = 0; row < bins; ++row)
    for (std::uint32_t b = 0; b < s.n_beams; ++b)
      for (int k = 0; k < s.range.size(); ++k) {
        const int from = row + s.range.first + k;
        if (from >= 0 && from < bins)
          out[row * s.n_beams + b] += s.range.weights[k] * across[from * s.n_beams + b];
      }
  return out;
}

void expect_spread(const LabelSpread& s, std::uint32_t seed) {
  const auto records = rays(s, 7, seed);
  LabelImage labels = silent(s);
  sonar::spread_labels(records, s, labels);
  Energies beams;
  for (const auto& [key, image] : of_columns(s, records)) beams[key] = spread(s, image);
  std::size_t filled = 0;
  for (std::size_t i = 0; i < labels.classes.size(); ++i) {
    double all = 0.0, most = 0.0, second = 0.0;
    std::uint32_t best = 0;
    for (const auto& [key, image] : beams) {
      all += image[i];
      second = std::max(second, std::min(image[i], most));
      if (image[i] > most) most = image[i], best = key;
    }
    filled += all > 0.0;
    if (all == 0.0) {
      ASSERT_EQ(labels.classes[i], sonar::kWater) << i;
      continue;
    }
    if (second > 0.99999 * most) continue;  // a tie
    ASSERT_EQ(labels.classes[i], best >> 16) << i;
    ASSERT_EQ(labels.instances[i], best & 0xffff) << i;
    ASSERT_NEAR(labels.fraction[i], most / all, 1e-5) << i;
  }
  EXPECT_GT(filled, labels.classes.size() / 4);
}

LabelSpread beams_of_three() {
  LabelSpread s{.n_range = 40, .n_beams = 9, .n_columns = 31, .stride = 3};
  s.across = {-1, {0.1f, 0.5f, 1.0f, 0.7f, 0.2f}, 1};
  s.range = {-2, {0.05f, 0.4f, 1.0f, 0.4f, 0.05f}, 1};
  for (std::uint32_t row = 0; row < s.n_range; ++row) s.gain.push_back(1.0f / (1.0f + row));
  return s;
}

TEST(LabelSpread, IsEachLabelsEnergySpreadOneByOne) {
  LabelSpread s = beams_of_three();
  expect_spread(s, 1);
  s.first_shift = -0.3, s.shift = 0.07;  // a head that turns
  expect_spread(s, 2);
  s.first_shift = s.shift = 0.0;
  s.wrap = true;
  s.n_columns = 27;
  expect_spread(s, 3);
  s.first_shift = 0.4, s.shift = -0.11;
  expect_spread(s, 4);
  s = beams_of_three();  // a kernel a beam
  s.across.kernels = s.n_beams;
  s.across.weights.clear();
  for (std::uint32_t i = 0; i < 5 * s.n_beams; ++i)
    s.across.weights.push_back(0.1f + 0.013f * static_cast<float>(i * 7 % 61));
  expect_spread(s, 5);
  s = beams_of_three();  // all columns are one beam
  s.n_beams = 1;
  s.stride = s.n_columns;
  s.across = {0, std::vector<float>(s.n_columns, 1.0f), 1};
  expect_spread(s, 6);
}

// A bin that only far side lobes reach keeps what it was.
TEST(LabelSpread, LeavesWhatIsFarBelowThePeak) {
  LabelSpread s{.n_range = 5, .n_beams = 1, .n_columns = 1};
  s.range = {-2, {5e-4f, 0.2f, 1.0f, 0.2f, 5e-4f}, 1};
  const std::vector<EnergyRecord> records{{2, 100, 4, 9, 2, 2}};
  LabelImage labels = silent(s);
  labels.classes[4] = sonar::kShadow;
  sonar::spread_labels(records, s, labels);
  EXPECT_EQ(labels.classes, (std::vector<std::uint16_t>{0, 4, 4, 4, sonar::kShadow}));
  EXPECT_EQ(labels.instances[1], 9);
  EXPECT_EQ(labels.fraction[3], 1.0f);
}

// A floor that every column hears but six in the middle, which a thing hides at the rows 4 to 9.
// The neighbours' side lobes, 20 dB below, spill into all of them.
LabelImage behind_a_thing(float side_lobes, bool floor_beside) {
  LabelSpread s{.n_range = 12, .n_beams = 20, .n_columns = 20};
  s.across = {-7, std::vector<float>(15, side_lobes), 1};
  s.across.weights[7] = 1.0f;
  std::vector<EnergyRecord> records;
  LabelImage labels = silent(s);
  for (std::uint16_t row = 0; row < s.n_range; ++row)
    for (std::uint32_t column = 0; column < s.n_columns; ++column) {
      const bool hidden = row >= 4 && row < 10 && column >= 7 && column < 13;
      const bool heard = !hidden && (floor_beside || column == 2);
      records.push_back(heard ? EnergyRecord{row, 1000, 1, 1, row, row}
                              : EnergyRecord{sonar::kNoReturn, 0, 0, 0, 0, 0});
      if (hidden) labels.classes[row * s.n_beams + column] = sonar::kShadow;
      if (hidden) labels.fraction[row * s.n_beams + column] = 1.0f;
    }
  sonar::spread_labels(records, s, labels);
  return labels;
}

TEST(LabelSpread, AShadowIntoWhichNeighboursSpillStaysOne) {
  // Up to 14 columns spill: 13 dB below the floor, and 3 dB below it.
  const LabelImage dark = behind_a_thing(0.004f, true), lit = behind_a_thing(0.05f, true);
  for (std::uint32_t row = 0; row < dark.n_range; ++row)
    for (std::uint32_t beam = 0; beam < dark.n_beams; ++beam) {
      const bool hidden = row >= 4 && row < 10 && beam >= 7 && beam < 13;
      const std::size_t i = row * dark.n_beams + beam;
      EXPECT_EQ(dark.classes[i], hidden ? sonar::kShadow : 1) << row << ' ' << beam;
      EXPECT_EQ(dark.instances[i], hidden ? 0 : 1) << row << ' ' << beam;
      EXPECT_EQ(lit.classes[i], 1) << row << ' ' << beam;
    }
}

}  // namespace
}  // namespace neritic
