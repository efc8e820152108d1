// A sonar's state while its settings stay: planned once, and again after a change.
#include <algorithm>

#include "engine/core/intrinsics.hpp"
#include "sonar/backscatter.hpp"
#include "sonar/quality.hpp"
#include "testbed/sensors/session.hpp"
#include "testbed/sensors/sonar_sensor.hpp"

namespace neritic::testbed {
namespace {

Result<gpu::Buffer> table_buffer(gpu::Device& device, const char* name,
                                 const std::vector<float>& table) {
  if (table.empty()) return gpu::Buffer{};
  NERITIC_TRY(gpu::Buffer buffer,
              gpu::Buffer::create(
                  device, {name, table.size() * sizeof(float),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  NERITIC_TRY_STATUS(gpu::upload_buffer(device, buffer, std::as_bytes(std::span(table))));
  return buffer;
}

}  // namespace

Result<EchoTables> EchoTables::create(gpu::Device& device, const scene::Scene& scene) {
  EchoTables made;
  if (scene.sonars.empty()) return made;
  made.least_object_m = testbed::least_object_m(scene);
  made.reflectivities = sonar::reflectivity_table(scene);
  NERITIC_TRY(made.reflectivity, table_buffer(device, "reflectivity", made.reflectivities));
  if (std::ranges::any_of(scene.sonars, [](const auto& s) { return s.terms.level.has_value(); })) {
    const sonar::BackscatterTable table = sonar::backscatter_table(scene);
    made.backscatter_scale = table.scale;
    made.strengths = table.strength;
    NERITIC_TRY(made.backscatter, table_buffer(device, "backscatter", table.strength));
  }
  return made;
}

const gpu::Buffer* EchoTables::of(const scene::Sonar& sonar) const {
  const gpu::Buffer& table = sonar.terms.level ? backscatter : reflectivity;
  return table ? &table : nullptr;
}

Result<HeadState> SonarSensor::make_head(gpu::Device& device, const scene::Sonar& sonar,
                                         const SonarState& state, sonar::Head head) const {
  const std::uint32_t max_extent = device.limits().maxImageDimension2D;
  HeadState h;
  h.name = head.name.empty() ? sonar.name : sonar.name + " " + head.name;
  h.sectors = sonar::plan_sectors(head.samples);
  const sonar::Sector& first = h.sectors.front();
  // The published gather reads whole pixels of cells. A cone sees a bottom that is smooth beside
  // its cells, which upright pixels tell best in their middles.
  const bool upright = state.mode == sonar::Gather::kPublished || head.folded;
  h.shown = head.samples;
  if (!upright && head.beams.bins.azimuth > 1)
    h.shown.bins.azimuth = std::max(1u, head.samples.bins.azimuth / head.samples_per_beam);
  h.upright = {first.tangents, 0.0,
               sonar::gbuffer_size(h.shown, first, state.pixels_per_cell, max_extent)};
  h.sampled = upright ? h.upright
                      : sonar::leaning_view(head.samples, first, state.pixels_per_cell, max_extent);
  // The published algorithm has every pixel count alike.
  if (state.mode != sonar::Gather::kPublished) {
    const render::LeastDrawn least = least_drawn(head, sonar, state.pixels_per_cell);
    const double least_rad = tables_.least_object_m / sonar.range_max_m;
    if (tables_.least_object_m > 0.0 && least_rad < 2.0 * std::max(least.wide_rad, least.high_rad))
      h.least = least;
  }
  sonar::GBufferLayout layout;
  layout.width = h.sampled.size.width;
  layout.height = h.sampled.size.height;
  layout.intrinsics = intrinsics_of(h.sampled.tangents, layout.width, layout.height);
  layout.lean = h.sampled.lean;
  layout.near_m = sonar.near_m;
  NERITIC_TRY(sonar::HeadGather gather,
              sonar::HeadGather::create(
                  device, {.sonar = state.made_from,
                           .head = std::move(head),
                           .sectors = h.sectors,
                           .layout = layout,
                           .options = {.gather = state.mode,
                                       .reflectivity = tables_.of(sonar) != nullptr || h.least,
                                       .larger = h.least.has_value()},
                           .mirrors = state.mirrors}));
  h.gather = std::make_unique<sonar::HeadGather>(std::move(gather));
  return h;
}

Result<Pin<SonarState>> SonarSensor::state_of(gpu::Device& device, scene::Sonar sonar) {
  if (!states_.empty() && scene::same_settings(states_.back()->value.made_from, sonar))
    return Pin<SonarState>(*states_.back());
  auto slot = std::make_unique<PinSlot<SonarState>>();
  SonarState& state = slot->value;
  state.made_from = sonar;
  NERITIC_TRY_STATUS(sonar::apply_quality(sonar));
  NERITIC_TRY(state.mode, sonar::gather_of(sonar.gather.empty() ? kDefaultGather : sonar.gather));
  state.pixels_per_cell = sonar.gbuffer_scale > 0.0 ? sonar.gbuffer_scale : kDefaultGBufferScale;
  state.mirrors = sonar::mirrors_of(sonar);
  if (!state.mirrors.empty() && !device.features().shaderClipDistance)
    return failure(ErrorCode::kUnsupported,
                   "ghosts: {} has no shaderClipDistance, which a mirror's view is cut by",
                   device.info().name);
  NERITIC_TRY(std::vector<sonar::Head> heads, sonar::plan_heads(sonar));
  for (sonar::Head& head : heads) {
    NERITIC_TRY(HeadState made, make_head(device, sonar, state, std::move(head)));
    state.heads.push_back(std::move(made));
  }
  // Frames in flight may read what the old settings made, after their SensorFrame is gone.
  if (!states_.empty()) device.wait_idle();
  std::erase_if(states_, [](const auto& old) { return old->pins == 0; });
  states_.push_back(std::move(slot));
  return Pin<SonarState>(*states_.back());
}

}  // namespace neritic::testbed
