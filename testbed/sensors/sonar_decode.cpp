// What a sonar's heads heard, from the buffers that the host reads.
#include "sonar/head_decode.hpp"
#include "testbed/sensors/sonar_station.hpp"

namespace neritic::testbed {
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
    if (const auto level = sonar::quality_level(sonar); level.ok()) frame.quality = *level;
    frame.max_error = sonar.max_error;
    frame.heading_rad = head->heading_rad;
    frame.world_from_sonar = head->world_from_sonar;
    frame.world_from_head =
        head->sampled.views.views.front().world_from_view *
        Pose{Vec3(0.0), glm::angleAxis(state.sectors.front().yaw_rad, Vec3(0, 1, 0))};
    frame.fixed_scale = state.gather->fixed_scale();
    frame.gbuffer_width = state.upright.size.width;
    frame.gbuffer_height = state.upright.size.height;
    const sonar::PixelSize& sampled = state.sampled.size;
    const FrustumTangents& leaning = state.sampled.tangents;
    frame.sampled_width = sampled.width;
    frame.sampled_height = sampled.height;
    frame.shift_px = state.sampled.lean * sampled.width / (leaning.right - leaning.left) *
                     (leaning.top - leaning.bottom) / sampled.height;
    frame.pixels_per_cell = work.state->pixels_per_cell;
    const FrustumTangents& t = state.upright.tangents;
    frame.pixels_per_cell_used = {
        state.upright.size.width * state.head.samples.azimuth_step_rad() / (t.right - t.left),
        state.upright.size.height * state.head.samples.elevation_step_rad() / (t.top - t.bottom)};
    if (!sonar.terms.level) frame.reflectivity = reflectivities_;
    const auto keys = state.keys.mapped<std::uint32_t>();
    if (state.receiver) {
      const auto power = state.power.mapped<float>();
      frame.image = {frame.grid.bins.range,
                     frame.grid.bins.azimuth,
                     {power.begin(), power.end()},
                     sonar::beam_labels(state.head, keys)};
      frame.sound_speed_m_s = head->ping.sound_speed_m_s;
      if (head->ping.noise_power > 0.0f)
        for (const glm::vec2& gain : head->ping.gains)
          frame.noise_power.push_back(head->ping.noise_power * gain.y);
      frame.absorption_db_per_m = head->ping.absorption_db_per_m;
      if (state.records.size() > 0) {
        std::vector<std::span<const shared::SonarRecord>> layers{
            state.records.mapped<shared::SonarRecord>()};
        for (const gpu::Buffer& ghost : state.ghost_records)
          layers.push_back(ghost.mapped<shared::SonarRecord>());
        frame.label_energy = sonar::beam_energies(state.head, head->ping, layers);
      }
    } else {
      frame.image = state.gather->to_image(state.sums.mapped<std::uint32_t>(), keys);
    }
    if (head->depth) frame.sectors = decode_views(*head);
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace neritic::testbed
