// What a sonar's heads heard, from the buffers that the host reads.
#include <algorithm>
#include <cstddef>

#include "tools/session/sonar_station.hpp"

namespace neritic::tools {
namespace {

// A beam's label is that of its strongest gathered column, its margin's not counted.
std::vector<std::uint16_t> beam_labels(const sonar::Head& head, const sonar::SonarGather& gather,
                                       std::span<const std::uint32_t> keys) {
  const std::uint32_t columns = head.samples.bins.azimuth, beams = head.beams.bins.azimuth;
  if (columns == beams) return gather.to_labels(keys);
  std::vector<std::uint32_t> strongest(std::size_t{head.beams.bins.range} * beams, 0);
  for (std::uint32_t row = 0; row < head.beams.bins.range; ++row)
    for (std::uint32_t beam = 0; beam < beams; ++beam)
      for (std::uint32_t i = 0; i < head.samples_per_beam; ++i) {
        const std::uint32_t column = head.margin + beam * head.samples_per_beam + i;
        std::uint32_t& key = strongest[std::size_t{row} * beams + beam];
        key = std::max(key, keys[std::size_t{row} * columns + column]);
      }
  std::vector<std::uint16_t> labels(strongest.size());
  for (std::size_t i = 0; i < labels.size(); ++i)
    labels[i] = strongest[i] == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(~strongest[i]);
  return labels;
}

// The records of the beams' own columns, direct and by mirrors, for labels by energy.
sonar::LabelImage energies(const HeadState& state) {
  static_assert(sizeof(sonar::EnergyRecord) == sizeof(shared::SonarRecord) &&
                offsetof(sonar::EnergyRecord, class_id) == offsetof(shared::SonarRecord, label));
  const std::uint32_t columns = state.head.samples.bins.azimuth, margin = state.head.margin;
  const std::uint32_t own = state.head.beams.bins.azimuth * state.head.samples_per_beam;
  std::vector<sonar::EnergyRecord> records;
  const auto add = [&](const gpu::Buffer& buffer) {
    const auto all = buffer.mapped<sonar::EnergyRecord>();
    for (std::size_t row = 0; row < state.head.samples.bins.elevation; ++row) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(row * columns + margin);
      records.insert(records.end(), begin, begin + own);
    }
  };
  add(state.records);
  for (const gpu::Buffer& ghost : state.ghost_records) add(ghost);
  return sonar::label_by_energy(records, state.head.beams.bins.range, state.head.beams.bins.azimuth,
                                state.head.samples_per_beam);
}

}  // namespace

std::vector<SonarFrame> SonarStation::decode(const SonarWork& work) const {
  const scene::Sonar& sonar = scene_.sonars[work.index];
  std::vector<SonarFrame> frames;
  for (const auto& head : work.heads) {
    const HeadState& state = *head->state;
    SonarFrame frame;
    frame.name = sonar.name;
    frame.head = state.head.name;
    frame.kind = sonar.kind;
    frame.gather = sonar::name_of(work.state->mode);
    frame.grid = state.head.beams;
    frame.level = sonar.terms.level.has_value();
    frame.terms = sonar.terms;
    frame.heading_rad = head->heading_rad;
    frame.world_from_head =
        head->views.views.front().world_from_view *
        Pose{Vec3(0.0), glm::angleAxis(state.sectors.front().yaw_rad, Vec3(0, 1, 0))};
    frame.fixed_scale = state.gather->fixed_scale();
    frame.gbuffer_width = state.size.width;
    frame.gbuffer_height = state.size.height;
    frame.pixels_per_cell = work.state->pixels_per_cell;
    const FrustumTangents& t = state.sectors.front().tangents;
    frame.pixels_per_cell_used = {
        state.size.width * state.head.samples.azimuth_step_rad() / (t.right - t.left),
        state.size.height * state.head.samples.elevation_step_rad() / (t.top - t.bottom)};
    frame.reflectivity = table_of(sonar) != nullptr;
    const auto keys = state.keys.mapped<std::uint32_t>();
    if (state.receiver) {
      const auto power = state.power.mapped<float>();
      frame.image = {frame.grid.bins.range,
                     frame.grid.bins.azimuth,
                     {power.begin(), power.end()},
                     beam_labels(state.head, *state.gather, keys)};
      frame.sound_speed_m_s = head->ping.sound_speed_m_s;
      frame.absorption_db_per_m = head->ping.absorption_db_per_m;
      if (state.records.size() > 0) frame.label_energy = energies(state);
    } else {
      frame.image = state.gather->to_image(state.sums.mapped<std::uint32_t>(), keys);
    }
    if (head->depth) frame.sectors = decode_views(*head);
    frames.push_back(std::move(frame));
  }
  return frames;
}

Status check_sonar(const scene::Sonar& sonar) {
  const auto heads = sonar::plan_heads(sonar);
  return heads.ok() ? Status() : Status(heads.error());
}

}  // namespace neritic::tools
