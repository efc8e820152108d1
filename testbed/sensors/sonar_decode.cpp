// A sonar's results, from the buffers that the host reads.
#include "sonar/quality.hpp"
#include "testbed/sensors/sonar_sensor.hpp"

namespace neritic::testbed {

std::vector<SonarFrame> SonarSensor::decode(const SonarWork& work) const {
  std::vector<SonarFrame> frames;
  for (const auto& head : work.heads)
    if (head->buffers || head->arrays.at_host()) frames.push_back(decode_head(*work.state, *head));
  return frames;
}

SonarFrame SonarSensor::decode_head(const SonarState& made, const HeadWork& work) const {
  const scene::Sonar& sonar = made.made_from;
  const HeadState& state = *work.state;
  const sonar::Head& head = state.head();
  SonarFrame frame;
  frame.name = sonar.name;
  frame.head = head.name;
  frame.kind = sonar.kind;
  frame.gather = sonar::name_of(made.mode);
  frame.grid = head.beams;
  if (work.buffers) {
    frame.image = state.gather->image(work.ping);
    frame.label_energy = state.gather->label_energy(work.ping);
  }
  frame.level = sonar.terms.level.has_value();
  frame.terms = sonar.terms;
  if (const auto level = sonar::quality_level(sonar); level.ok()) frame.quality = *level;
  frame.max_error = sonar.max_error;
  frame.quality_chosen = sonar.quality_chosen;
  frame.heading_rad = work.heading_rad;
  frame.world_from_sonar = work.world_from_sonar;
  frame.world_from_head =
      work.sampled.views.views.front().world_from_view *
      Pose{Vec3(0.0), glm::angleAxis(state.sectors.front().yaw_rad, Vec3(0, 1, 0))};
  frame.fixed_scale = state.gather->gather().fixed_scale();
  frame.gbuffer_width = state.upright.size.width;
  frame.gbuffer_height = state.upright.size.height;
  const sonar::PixelSize& sampled = state.sampled.size;
  const FrustumTangents& leaning = state.sampled.tangents;
  frame.sampled_width = sampled.width;
  frame.sampled_height = sampled.height;
  frame.shift_px = state.sampled.lean * sampled.width / (leaning.right - leaning.left) *
                   (leaning.top - leaning.bottom) / sampled.height;
  frame.pixels_per_cell = made.pixels_per_cell;
  const FrustumTangents& t = state.upright.tangents;
  frame.pixels_per_cell_used = {
      state.upright.size.width * state.shown.azimuth_step_rad() / (t.right - t.left),
      state.upright.size.height * state.shown.elevation_step_rad() / (t.top - t.bottom)};
  if (!sonar.terms.level) frame.reflectivity = tables_.reflectivities;
  if (work.buffers && state.gather->has_receiver()) {
    const sonar::Ping& ping = work.ping.ping;
    frame.sound_speed_m_s = ping.sound_speed_m_s;
    frame.absorption_db_per_m = ping.absorption_db_per_m;
    if (ping.noise_power > 0.0f)
      for (const glm::vec2& gain : ping.gains)
        frame.noise_power.push_back(ping.noise_power * gain.y);
  }
  if (work.arrays.at_host()) frame.sectors = decode_views(work.arrays);
  return frame;
}

}  // namespace neritic::testbed
