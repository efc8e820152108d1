#include "sonar/head_decode.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace neritic::sonar {

std::vector<std::uint16_t> beam_labels(const Head& head, std::span<const std::uint32_t> keys) {
  const std::uint32_t columns = head.samples.bins.azimuth, beams = head.beams.bins.azimuth;
  std::vector<std::uint16_t> labels(std::size_t{head.beams.bins.range} * beams, 0);
  if (keys.empty()) return labels;
  for (std::uint32_t row = 0; row < head.beams.bins.range; ++row)
    for (std::uint32_t beam = 0; beam < beams; ++beam) {
      const auto first =
          keys.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * columns + head.margin +
                                                     beam * head.samples_per_beam);
      const std::uint32_t strongest = *std::max_element(first, first + head.samples_per_beam);
      // 65535 less the label lies in the low half of a key; 0: nothing was heard.
      if (strongest != 0)
        labels[std::size_t{row} * beams + beam] = static_cast<std::uint16_t>(~strongest);
    }
  return labels;
}

LabelImage beam_energies(const Head& head,
                         const std::vector<std::span<const shared::SonarRecord>>& layers) {
  static_assert(sizeof(EnergyRecord) == sizeof(shared::SonarRecord) &&
                offsetof(EnergyRecord, class_id) == offsetof(shared::SonarRecord, label) &&
                offsetof(EnergyRecord, nearest) == offsetof(shared::SonarRecord, ends));
  const std::size_t columns = head.samples.bins.azimuth, rows = head.samples.bins.elevation;
  const std::size_t own = std::size_t{head.beams.bins.azimuth} * head.samples_per_beam;
  std::vector<EnergyRecord> records(layers.size() * rows * own);
  EnergyRecord* out = records.data();
  for (const auto& layer : layers)
    for (std::size_t row = 0; row < rows; ++row, out += own)
      std::memcpy(out, layer.data() + row * columns + head.margin, own * sizeof *out);
  return label_by_energy(records, head.beams.bins.range, head.beams.bins.azimuth,
                         head.samples_per_beam);
}

}  // namespace neritic::sonar
