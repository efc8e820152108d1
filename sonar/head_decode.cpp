#include "sonar/head_decode.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "sonar/label_spread.hpp"

namespace neritic::sonar {

bool any_unclassed(std::span<const std::uint32_t> keys) {
  // 65535 less the label lies in the low half of a key; 0: nothing was heard.
  return std::ranges::any_of(keys, [](std::uint32_t key) { return (key & 0xffff) == 0xffff; });
}

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

namespace {

// The weight of each ray of a beam's own columns, by the pattern; empty: all alike.
std::vector<std::uint8_t> ray_weights(const Head& head) {
  const std::vector<float>& w = head.echo->weights;
  if (w.empty()) return {};
  const std::size_t columns = head.samples.bins.azimuth, rows = head.samples.bins.elevation;
  const std::size_t own = std::size_t{head.beams.bins.azimuth} * head.samples_per_beam;
  std::vector<std::uint8_t> out(rows * own);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<std::uint8_t>(
        std::lround(255.0f * std::clamp(w[i / own * columns + head.margin + i % own], 0.0f, 1.0f)));
  return out;
}

PowerTaps power_taps(const Taps& taps, bool coherent) {
  PowerTaps out{taps.first, taps.weights, taps.kernels};
  if (coherent)
    for (float& w : out.weights) w *= w;
  return out;
}

// Does to energies what the receiver does to the field.
LabelSpread label_spread_of(const Head& head, const Ping& ping) {
  const ReceiverDesc& r = head.receiver;
  LabelSpread out{.n_range = r.rows,
                  .n_beams = r.beams,
                  .n_columns = r.columns,
                  .stride = r.stride,
                  .wrap = r.wrap,
                  .across = power_taps(r.across, r.coherent),
                  .range = power_taps(r.range, r.coherent)};
  for (const glm::vec2& gain : ping.gains)
    out.gain.push_back(r.coherent ? gain.x * gain.x : gain.x);
  if (r.shift) {
    out.first_shift = ping.first_shift_columns;
    out.shift = ping.shift_columns_per_row;
  }
  return out;
}

}  // namespace

LabelImage beam_energies(const Head& head, const Ping& ping,
                         const std::vector<std::span<const shared::SonarRecord>>& layers) {
  static_assert(sizeof(EnergyRecord) == sizeof(shared::SonarRecord) &&
                offsetof(EnergyRecord, class_id) == offsetof(shared::SonarRecord, label) &&
                offsetof(EnergyRecord, nearest) == offsetof(shared::SonarRecord, ends));
  const std::size_t columns = head.samples.bins.azimuth, rows = head.samples.bins.elevation;
  const std::size_t own = std::size_t{head.beams.bins.azimuth} * head.samples_per_beam;
  std::vector<EnergyRecord> all(layers.size() * rows * columns);
  for (std::size_t i = 0; i < layers.size(); ++i)
    std::memcpy(&all[i * rows * columns], layers[i].data(), rows * columns * sizeof(EnergyRecord));
  std::vector<EnergyRecord> records(layers.size() * rows * own);  // without the margins
  for (std::size_t row = 0; row < layers.size() * rows; ++row)
    std::copy_n(&all[row * columns + head.margin], own, &records[row * own]);
  LabelImage labels = label_by_energy(records, head.beams.bins.range, head.beams.bins.azimuth,
                                      head.samples_per_beam, ray_weights(head));
  const ReceiverDesc& receiver = head.receiver;
  if (!receiver.across.weights.empty() || !receiver.range.weights.empty())
    spread_labels(all, label_spread_of(head, ping), labels);
  return labels;
}

}  // namespace neritic::sonar
