#include "sonar/label_spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/check.hpp"

namespace neritic::sonar {
namespace {

// Energy of one (class, instance) by range bin; zero outside [from, upto).
struct LabelTrace {
  std::uint32_t key = 0;
  std::uint32_t from = 0, upto = 0;
  std::vector<float> energy;  // [n_range]
};

// The traces of a column or a beam: few.
class LabelTraces {
 public:
  LabelTrace& of(std::uint32_t key, std::uint32_t n_range) {
    for (LabelTrace& t : traces_)
      if (t.key == key) return t;
    traces_.push_back({key, n_range, 0, std::vector<float>(n_range)});
    return traces_.back();
  }
  void add(std::uint32_t key, std::uint32_t row, std::uint32_t n_range, float energy) {
    if (last_ >= traces_.size() || traces_[last_].key != key)
      last_ = static_cast<std::size_t>(&of(key, n_range) - traces_.data());
    LabelTrace& t = traces_[last_];
    t.from = std::min(t.from, row);
    t.upto = std::max(t.upto, row + 1);
    t.energy[row] += energy;
  }
  void clear() { traces_.clear(); }
  const std::vector<LabelTrace>& all() const { return traces_; }

 private:
  std::vector<LabelTrace> traces_;
  std::size_t last_ = 0;
};

// Without the taps that weigh next to nothing.
PowerTaps main_part(const PowerTaps& taps) {
  PowerTaps out = taps;
  const float peak =
      taps.weights.empty() ? 0.0f : *std::max_element(taps.weights.begin(), taps.weights.end());
  for (float& w : out.weights)
    if (w < kLeastPart * peak) w = 0.0f;
  return out;
}

class Spreader {
 public:
  Spreader(const LabelSpread& spread, LabelImage& labels)
      : s_(spread),
        across_(main_part(spread.across)),
        range_(main_part(spread.range)),
        beams_(spread.n_beams),
        labels_(labels) {
    if (across_.weights.empty()) across_.weights = {1.0f};
  }

  // A column's rays, all rows of all layers.
  void hear(LabelTraces& column, const EnergyRecord& r) const {
    if (r.counts == 0) return;
    if (r.bin != kShared) {
      if (r.bin < s_.n_range) add(column, r, r.bin, static_cast<float>(r.counts));
      return;
    }
    const std::uint32_t last = std::min<std::uint32_t>(r.farthest, s_.n_range - 1);
    const float each =
        static_cast<float>(r.counts) / static_cast<float>(r.farthest - r.nearest + 1);
    for (std::uint32_t row = r.nearest; row <= last; ++row) add(column, r, row, each);
  }

  // To the beams that hear the column.
  void spread_across(std::uint32_t column, const LabelTraces& traces) {
    const int n = static_cast<int>(s_.n_columns), at = static_cast<int>(column);
    const bool turns = s_.first_shift != 0.0 || s_.shift != 0.0;
    const int most = turns ? static_cast<int>(std::ceil(std::abs(s_.first_shift) +
                                                        std::abs(s_.shift) * s_.n_range)) +
                                 1
                           : 0;
    for (const int ring : {-n, 0, n}) {
      if (ring != 0 && !s_.wrap) continue;
      // Kernels that hold the column: stride b + first <= column < stride b + first + size.
      const int stride = static_cast<int>(s_.stride), top = at + ring - across_.first;
      const int low = std::max(0, floor_div(top - across_.size() - most, stride) + 1);
      const int high = std::min(static_cast<int>(s_.n_beams) - 1, floor_div(top + most, stride));
      for (int b = low; b <= high; ++b)
        for (const LabelTrace& t : traces.all()) {
          if (turns)
            add_turned(b, top - b * stride, t);
          else
            add_weighed(b, tap(b, top - b * stride), t);
        }
    }
  }

  // Along range, and the labels.
  void resolve() {
    std::vector<float> most(s_.n_range), heard;
    std::vector<std::uint32_t> key(s_.n_range);
    std::vector<float> energy(labels_.classes.size());
    LabelImage found = labels_;
    for (std::uint32_t b = 0; b < s_.n_beams; ++b) {
      std::fill(most.begin(), most.end(), 0.0f);
      for (const LabelTrace& t : beams_[b].all()) {
        const auto [from, upto] = spread_range(t, heard);
        for (std::uint32_t row = from; row < upto; ++row) {
          const float e = heard[row];
          energy[at(row, b)] += e;
          if (e > most[row] || (e == most[row] && e > 0.0f && t.key < key[row])) {
            most[row] = e;
            key[row] = t.key;
          }
        }
      }
      for (std::uint32_t row = 0; row < s_.n_range; ++row) {
        const std::size_t i = at(row, b);
        if (!(energy[i] > 0.0f)) continue;
        found.classes[i] = static_cast<std::uint16_t>(key[row] >> 16);
        found.instances[i] = static_cast<std::uint16_t>(key[row]);
        found.fraction[i] = std::min(1.0f, most[row] / energy[i]);
      }
    }
    keep_shadows(energy, found);
    labels_ = std::move(found);
  }

 private:
  static constexpr std::size_t kBeside = 5;  // bins to a side that tell what is heard there

  std::size_t at(std::uint32_t row, std::uint32_t beam) const {
    return std::size_t{row} * s_.n_beams + beam;
  }

  // The middle of the first bins that are heard and in no shadow, from one bin on in steps; 0:
  // none.
  float beside(const std::vector<float>& energy, std::size_t from, std::size_t count,
               std::ptrdiff_t step) const {
    std::array<float, kBeside> some{};
    std::size_t n = 0;
    for (std::size_t k = 1; k <= count && n < kBeside; ++k) {
      const std::size_t i = from + static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) * step);
      if (energy[i] > 0.0f && labels_.classes[i] != kShadow) some[n++] = energy[i];
    }
    if (n == 0) return 0.0f;
    std::sort(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(n));
    return some[n / 2];
  }

  // labels_ tells the bins that are hidden, found what the spread fills.
  void keep_shadows(const std::vector<float>& energy, LabelImage& found) const {
    const auto along = static_cast<std::ptrdiff_t>(s_.n_beams);
    for (std::uint32_t row = 0; row < s_.n_range; ++row)
      for (std::uint32_t b = 0; b < s_.n_beams; ++b) {
        const std::size_t i = at(row, b);
        if (labels_.classes[i] != kShadow || !(energy[i] > 0.0f)) continue;
        const float port = beside(energy, i, b, -1);
        const float starboard = beside(energy, i, s_.n_beams - 1 - b, 1);
        float around =
            port > 0.0f && starboard > 0.0f ? std::min(port, starboard) : std::max(port, starboard);
        if (around == 0.0f) around = beside(energy, i, s_.n_range - 1 - row, along);
        if (energy[i] > kShadowPart * around) continue;
        found.classes[i] = kShadow;
        found.instances[i] = labels_.instances[i];
        found.fraction[i] = labels_.fraction[i];
      }
  }

  static int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

  void add(LabelTraces& column, const EnergyRecord& r, std::uint32_t row, float counts) const {
    const float gain = row < s_.gain.size() ? s_.gain[row] : 1.0f;
    column.add(std::uint32_t{r.class_id} << 16 | r.instance, row, s_.n_range, counts * gain);
  }

  float tap(int beam, int k) const {
    if (k < 0 || k >= across_.size()) return 0.0f;
    const int kernel = std::min(beam, static_cast<int>(across_.kernels) - 1);
    return across_.weights[static_cast<std::size_t>(kernel * across_.size() + k)];
  }

  void add_weighed(int beam, float weight, const LabelTrace& t) {
    if (!(weight > 0.0f)) return;
    LabelTrace& to = beams_[static_cast<std::size_t>(beam)].of(t.key, s_.n_range);
    to.from = std::min(to.from, t.from);
    to.upto = std::max(to.upto, t.upto);
    for (std::uint32_t row = t.from; row < t.upto; ++row) to.energy[row] += weight * t.energy[row];
  }

  // Bearings turn while the echo returns: a row's columns are shifted, in general by a fraction.
  void add_turned(int beam, int k, const LabelTrace& t) {
    LabelTraces& to = beams_[static_cast<std::size_t>(beam)];
    for (std::uint32_t row = t.from; row < t.upto; ++row) {
      const double turned = s_.first_shift + s_.shift * row, whole = std::floor(turned);
      const auto part = static_cast<float>(turned - whole);
      const int at = k - static_cast<int>(whole);
      const float energy =
          t.energy[row] * ((1.0f - part) * tap(beam, at) + part * tap(beam, at - 1));
      if (energy > 0.0f) to.add(t.key, row, s_.n_range, energy);
    }
  }

  // The rows that a trace then fills.
  std::pair<std::uint32_t, std::uint32_t> spread_range(const LabelTrace& t,
                                                       std::vector<float>& heard) const {
    if (range_.weights.empty()) {
      heard = t.energy;
      return {t.from, t.upto};
    }
    const int bins = static_cast<int>(s_.n_range), reach = range_.size();
    const int from = std::max(0, static_cast<int>(t.from) - range_.first - reach + 1);
    const int upto = std::min(bins, static_cast<int>(t.upto) - range_.first);
    heard.assign(s_.n_range, 0.0f);
    // Row `to` hears what lies at to + first + k.
    for (int k = 0; k < reach; ++k) {
      const float w = range_.weights[static_cast<std::size_t>(k)];
      const int off = range_.first + k;
      const int low = std::max(from, static_cast<int>(t.from) - off);
      const int high = std::min(upto, static_cast<int>(t.upto) - off);
      for (int row = low; row < high; ++row)
        heard[static_cast<std::size_t>(row)] += w * t.energy[static_cast<std::size_t>(row + off)];
    }
    return {static_cast<std::uint32_t>(std::max(from, 0)),
            static_cast<std::uint32_t>(std::max(upto, 0))};
  }

  const LabelSpread& s_;
  PowerTaps across_, range_;
  std::vector<LabelTraces> beams_;
  LabelImage& labels_;
};

}  // namespace

void spread_labels(std::span<const EnergyRecord> records, const LabelSpread& spread,
                   LabelImage& labels) {
  const std::size_t columns = spread.n_columns;
  NERITIC_CHECK(labels.n_range == spread.n_range && labels.n_beams == spread.n_beams &&
                    columns > 0 && records.size() % columns == 0,
                "labels of {} x {} bins, a spread of {} x {} from {} columns and {} records",
                labels.n_range, labels.n_beams, spread.n_range, spread.n_beams, columns,
                records.size());
  Spreader spreader(spread, labels);
  constexpr std::size_t kBlock = 8;  // columns, whose records share lines of memory
  std::vector<LabelTraces> block(kBlock);
  for (std::size_t from = 0; from < columns; from += kBlock) {
    const std::size_t upto = std::min(from + kBlock, columns);
    for (LabelTraces& traces : block) traces.clear();
    for (std::size_t row = 0; row < records.size() / columns; ++row)
      for (std::size_t c = from; c < upto; ++c)
        spreader.hear(block[c - from], records[row * columns + c]);
    for (std::size_t c = from; c < upto; ++c)
      spreader.spread_across(static_cast<std::uint32_t>(c), block[c - from]);
  }
  spreader.resolve();
}

}  // namespace neritic::sonar
