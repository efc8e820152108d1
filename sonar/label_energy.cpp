#include "sonar/label_energy.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace neritic::sonar {
namespace {

constexpr std::uint32_t kEnd = 0xffffffff;  // of a chain

// One (class, instance) that a bin hears; most bins hear one. sum 0: unused.
struct Heard {
  std::uint32_t key = 0, next = kEnd;
  std::uint64_t sum = 0;
};
std::uint32_t key_of(const EnergyRecord& r) {
  return std::uint32_t{r.class_id} << 16 | r.instance;
}

// Sums of a few beams side by side, so that the lines of memory that a row of records lies in are
// read once and the sums stay in cache.
class BeamBlock {
 public:
  BeamBlock(std::uint32_t n_range, std::uint32_t beams)
      : n_range_(n_range), cells_(std::size_t{n_range} * beams), nearest_(beams) {}

  void clear() {
    std::fill(cells_.begin(), cells_.end(), Heard{});
    std::fill(nearest_.begin(), nearest_.end(), n_range_);
    more_.clear();
  }

  void add(std::uint32_t beam, const EnergyRecord& r) {
    if (r.bin >= n_range_) return;
    if (r.class_id != kGhost) nearest_[beam] = std::min(nearest_[beam], r.bin);
    if (r.counts == 0) return;
    Heard& first = cells_[std::size_t{beam} * n_range_ + r.bin];
    const std::uint32_t key = key_of(r);
    if (first.sum == 0) first.key = key;
    if (first.key == key)
      first.sum += r.counts;
    else
      add_to_chain(first, key, r.counts);
  }

  // Writes the block's columns, from_column on, of the image.
  void resolve(std::uint32_t beams, std::uint32_t from_column, LabelImage& out) const {
    for (std::uint32_t row = 0; row < n_range_; ++row)
      for (std::uint32_t beam = 0; beam < beams; ++beam)
        resolve_bin(beam, row, std::size_t{row} * out.n_beams + from_column + beam, out);
  }

 private:
  void resolve_bin(std::uint32_t beam, std::uint32_t row, std::size_t at, LabelImage& out) const {
    const Heard& first = cells_[std::size_t{beam} * n_range_ + row];
    if (first.sum == 0) {
      if (row > nearest_[beam]) out.classes[at] = kShadow;
      return;
    }
    Heard most = first;
    std::uint64_t all = first.sum;
    for (std::uint32_t i = first.next; i != kEnd; i = more_[i].next) {
      const Heard& h = more_[i];
      all += h.sum;
      if (h.sum > most.sum || (h.sum == most.sum && h.key < most.key)) most = h;
    }
    out.classes[at] = static_cast<std::uint16_t>(most.key >> 16);
    out.instances[at] = static_cast<std::uint16_t>(most.key);
    out.fraction[at] =
        all == most.sum
            ? 1.0f
            : static_cast<float>(static_cast<double>(most.sum) / static_cast<double>(all));
  }
  void add_to_chain(Heard& first, std::uint32_t key, std::uint32_t counts) {
    for (std::uint32_t i = first.next; i != kEnd; i = more_[i].next)
      if (more_[i].key == key) {
        more_[i].sum += counts;
        return;
      }
    more_.push_back({key, first.next, counts});
    first.next = static_cast<std::uint32_t>(more_.size() - 1);
  }

  std::uint32_t n_range_;
  std::vector<Heard> cells_;            // [beams][n_range]
  std::vector<std::uint32_t> nearest_;  // row of each beam's first return; n_range: none
  std::vector<Heard> more_;             // the rest of the chains
};

}  // namespace

LabelImage label_by_energy(std::span<const EnergyRecord> records, std::uint32_t n_range,
                           std::uint32_t n_beams, std::uint32_t samples_per_beam) {
  const std::size_t columns = std::size_t{n_beams} * samples_per_beam;
  NERITIC_CHECK(n_range > 0 && columns > 0 && records.size() % columns == 0,
                "{} records for {} beams of {} samples, {} bins", records.size(), n_beams,
                samples_per_beam, n_range);
  const std::size_t rows = records.size() / columns, cells = std::size_t{n_range} * n_beams;
  LabelImage out{n_range, n_beams, std::vector<std::uint16_t>(cells, kWater),
                 std::vector<std::uint16_t>(cells), std::vector<float>(cells)};
  constexpr std::uint32_t kBeams = 8;
  BeamBlock block(n_range, std::min(kBeams, n_beams));
  for (std::uint32_t from = 0; from < n_beams; from += kBeams) {
    const std::uint32_t beams = std::min(kBeams, n_beams - from);
    block.clear();
    for (std::size_t row = 0; row < rows; ++row) {
      const EnergyRecord* r = &records[row * columns + std::size_t{from} * samples_per_beam];
      for (std::uint32_t beam = 0; beam < beams; ++beam)
        for (std::uint32_t k = 0; k < samples_per_beam; ++k) block.add(beam, *r++);
    }
    block.resolve(beams, from, out);
  }
  return out;
}

}  // namespace neritic::sonar
