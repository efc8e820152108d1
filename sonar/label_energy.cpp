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
  BeamBlock(std::uint32_t n_range, std::uint32_t beams, std::uint32_t samples)
      : n_range_(n_range),
        samples_(samples),
        cells_(std::size_t{n_range} * beams),
        hidden_((std::size_t{n_range} + 1) * beams),
        ended_(cells_.size()),
        surface_(cells_.size()),
        rays_(beams),
        below_(std::size_t{beams} * samples) {}

  void clear() {
    std::fill(cells_.begin(), cells_.end(), Heard{});
    std::fill(hidden_.begin(), hidden_.end(), 0);
    std::fill(ended_.begin(), ended_.end(), 0);
    std::fill(rays_.begin(), rays_.end(), 0);
    std::fill(surface_.begin(), surface_.end(), 0);
    std::fill(below_.begin(), below_.end(), Span{});
    more_.clear();
  }

  // The next row's record of a column.
  void add(std::uint32_t beam, std::uint32_t sample, const EnergyRecord& r, std::uint32_t weight) {
    if (r.class_id != kGhost) {
      hide_between(beam, below_[beam * samples_ + sample], r);
      rays_[beam] += weight;
      if (r.bin != kNoReturn) end_ray(beam, r, weight);
    }
    if (r.counts == 0) return;
    if (r.bin != kShared) {
      if (r.bin < n_range_) hear(beam, r.bin, key_of(r), r.counts);
      return;
    }
    const std::uint32_t bins = r.farthest - r.nearest + 1u,
                        last = std::min<std::uint32_t>(r.farthest, n_range_ - 1);
    for (std::uint32_t bin = r.nearest; bin <= last; ++bin)
      hear(beam, bin, key_of(r), std::max(r.counts / bins, 1u));
  }

  // Writes the block's columns, from_column on, of the image.
  void resolve(std::uint32_t beams, std::uint32_t from_column, LabelImage& out) const {
    std::vector<std::int32_t> hidden(beams);
    std::vector<std::uint64_t> ended(beams);  // rays that end nearer than the row
    for (std::uint32_t row = 0; row < n_range_; ++row)
      for (std::uint32_t beam = 0; beam < beams; ++beam) {
        hidden[beam] += hidden_[std::size_t{beam} * (n_range_ + 1) + row];
        const std::size_t at = std::size_t{row} * out.n_beams + from_column + beam;
        resolve_bin(beam, row, hidden_part(beam, row, hidden[beam], ended[beam]), at, out);
        ended[beam] += ended_[std::size_t{beam} * n_range_ + row];
      }
  }

 private:
  // Rows that a ray spans; none: it ended on nothing.
  struct Span {
    bool ended = false;
    int nearest = 0, farthest = 0;
  };

  void end_ray(std::uint32_t beam, const EnergyRecord& r, std::uint32_t weight) {
    const std::size_t first = std::size_t{beam} * n_range_;
    if (r.nearest < n_range_) surface_[first + r.nearest] = 1;
    if (r.farthest >= n_range_) return;
    surface_[first + r.farthest] = 1;
    ended_[first + r.farthest] += weight;
  }

  void hide_between(std::uint32_t beam, Span& below, const EnergyRecord& r) {
    const Span here{r.bin != kNoReturn, r.nearest, r.farthest};
    if (here.ended && below.ended) {
      const Span& near = here.nearest < below.nearest ? here : below;
      const Span& far = &near == &here ? below : here;
      const int spans = near.farthest - near.nearest + far.farthest - far.nearest;
      const int from = near.farthest + 1, bins = static_cast<int>(n_range_);
      if (4 * (far.nearest - from) > std::max(4, spans) && from < bins) {
        std::int32_t* hidden = &hidden_[std::size_t{beam} * (n_range_ + 1)];
        ++hidden[from];
        --hidden[std::min(far.nearest, bins)];
      }
    }
    below = here;
  }

  void hear(std::uint32_t beam, std::uint32_t row, std::uint32_t key, std::uint32_t counts) {
    Heard& first = cells_[std::size_t{beam} * n_range_ + row];
    if (first.sum == 0) first.key = key;
    if (first.key == key)
      first.sum += counts;
    else
      add_to_chain(first, key, counts);
  }

  // The part of a beam for which a nearer surface hides the bin; 0: too little for a shadow.
  // columns: those with a range jump about the bin. ended: the beam's rays that hit nearer.
  float hidden_part(std::uint32_t beam, std::uint32_t row, std::int32_t columns,
                    std::uint64_t ended) const {
    const float of_columns = static_cast<float>(columns) / static_cast<float>(samples_);
    const bool most = 2 * ended > rays_[beam] && surface_[std::size_t{beam} * n_range_ + row] == 0;
    const float of_rays =
        most ? static_cast<float>(static_cast<double>(ended) / static_cast<double>(rays_[beam]))
             : 0.0f;
    return std::min(1.0f, std::max(of_columns, of_rays));
  }

  void resolve_bin(std::uint32_t beam, std::uint32_t row, float hidden, std::size_t at,
                   LabelImage& out) const {
    const Heard& first = cells_[std::size_t{beam} * n_range_ + row];
    if (first.sum == 0) {
      if (hidden == 0.0f) return;
      out.classes[at] = kShadow;
      out.fraction[at] = hidden;
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

  std::uint32_t n_range_, samples_;
  std::vector<Heard> cells_;           // [beams][n_range]
  std::vector<std::int32_t> hidden_;   // [beams][n_range + 1]: what each bin has more than the last
  std::vector<std::uint32_t> ended_;   // [beams][n_range]: weight of the rays that end there
  std::vector<std::uint8_t> surface_;  // [beams][n_range]: whether a ray's height ends there
  std::vector<std::uint64_t> rays_;    // weight of all
  std::vector<Span> below_;            // the last row's, by column
  std::vector<Heard> more_;            // the rest of the chains
};

}  // namespace

LabelImage label_by_energy(std::span<const EnergyRecord> records, std::uint32_t n_range,
                           std::uint32_t n_beams, std::uint32_t samples_per_beam,
                           std::span<const std::uint8_t> weights) {
  const std::size_t columns = std::size_t{n_beams} * samples_per_beam;
  NERITIC_CHECK(n_range > 0 && columns > 0 && records.size() % columns == 0,
                "{} records for {} beams of {} samples, {} bins", records.size(), n_beams,
                samples_per_beam, n_range);
  const std::size_t rows = records.size() / columns, cells = std::size_t{n_range} * n_beams;
  LabelImage out{n_range, n_beams, std::vector<std::uint16_t>(cells, kWater),
                 std::vector<std::uint16_t>(cells), std::vector<float>(cells)};
  constexpr std::uint32_t kBeams = 8;
  BeamBlock block(n_range, std::min(kBeams, n_beams), samples_per_beam);
  for (std::uint32_t from = 0; from < n_beams; from += kBeams) {
    const std::uint32_t beams = std::min(kBeams, n_beams - from);
    block.clear();
    for (std::size_t row = 0; row < rows; ++row) {
      std::size_t at = row * columns + std::size_t{from} * samples_per_beam;
      for (std::uint32_t beam = 0; beam < beams; ++beam)
        for (std::uint32_t k = 0; k < samples_per_beam; ++k, ++at)
          block.add(beam, k, records[at], at < weights.size() ? weights[at] : 1u);
    }
    block.resolve(beams, from, out);
  }
  return out;
}

}  // namespace neritic::sonar
