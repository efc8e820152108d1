// A sonar's settings, planned once and again after a change; a ping's part of the graph; and its
// results, from the buffers that the host reads.
#include "testbed/sensors/sonar_sensor.hpp"

#include <algorithm>

#include "engine/core/intrinsics.hpp"
#include "sonar/backscatter.hpp"
#include "sonar/head_pattern.hpp"
#include "sonar/quality.hpp"
#include "testbed/sensors/session.hpp"

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

// A view a sector, all through one pinhole.
render::ViewSet head_views(const scene::Sonar& sonar, const HeadState& head,
                           const sonar::LeaningView& pinhole, const Pose& world_from_head) {
  render::ViewSet set;
  set.width = pinhole.size.width;
  set.height = pinhole.size.height;
  for (const sonar::Sector& sector : head.sectors) {
    render::ViewDesc view;
    view.tangents = pinhole.tangents;
    view.lean = pinhole.lean;
    view.near_m = sonar.near_m;
    view.world_from_view =
        world_from_head * Pose{Vec3(0.0), glm::angleAxis(-sector.yaw_rad, Vec3(0, 1, 0))};
    view.next_world_from_view = view.world_from_view;
    set.views.push_back(view);
  }
  return set;
}

// The geometry G-buffer of work.views.
Result<render::GBuffer> declare_geometry(const FrameParts& frame, const std::string& prefix,
                                         render::DrawListOptions options, ViewsWork& work,
                                         const render::GBufferParts& parts = {}) {
  options.deform_need = &frame.deform_need;
  work.draws =
      render::build_draw_list(frame.scene, frame.gpu_scene, frame.state, work.views, options);
  return frame.renderer.declare_gbuffer(frame.graph, prefix, render::GBufferKind::kGeometry,
                                        frame.gpu_scene, frame.state, frame.deformed, work.views,
                                        work.draws, parts);
}

sonar::HeadGather::View view_of(const render::GBuffer& g, const Pose& world_from_head) {
  return {g.depth, g.normal, g.label, glm::mat3_cast(glm::conjugate(world_from_head.rotation))};
}

// From outside, a closed mesh shows its front faces only.
constexpr render::DrawListOptions kFrontFaces{.hide_back_faces = true};

// The things that are drawn larger, as a view of the head (or of its mirror image) sees them.
std::optional<render::LeastDrawn> seen_from(const HeadState& state, const Pose& world_from_head) {
  std::optional<render::LeastDrawn> least = state.least;
  if (least) least->world_from_eye = world_from_head.rotation;
  return least;
}

// Empty where nothing is drawn larger in this ping: the scene's own table counts. direct: of a
// ghost's ping, the draws of the sonar's own view.
HeadWork::Larger larger_of(const std::vector<float>& table, const scene::Sonar& sonar,
                           const render::DrawList& draws,
                           const render::DrawList* direct = nullptr) {
  HeadWork::Larger out;
  if (!draws.larger.empty())
    out.strengths = sample_strengths(table, draws.larger, sonar::counts_solid_angle(sonar));
  out.places = direct ? places_of(draws.larger, direct->larger) : places_of(draws.larger);
  return out;
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
                   "ghosts: {} has no shaderClipDistance, which cuts a mirror's view",
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

Result<std::unique_ptr<SonarWork>> SonarSensor::declare(const FrameParts& frame,
                                                        const Capture& capture,
                                                        std::uint32_t ping) {
  const scene::Sonar& sonar = frame.scene.sonars[index_];
  auto work = std::make_unique<SonarWork>();
  work->index = index_;
  NERITIC_TRY(work->state, state_of(frame.device, sonar));
  SonarState& state = *work->state;
  const Motion motion = frame.motion.at(sonar.mount, frame.state.time_s).motion;
  for (std::size_t place = 0; place < state.heads.size(); ++place) {
    work->heads.push_back(std::make_unique<HeadWork>());
    HeadWork& head = *work->heads.back();
    head.state = &state.heads[place];
    head.heading_rad = sonar::scan_heading_rad(sonar, ping);
    const Pose turned{Vec3(0.0), glm::angleAxis(-head.heading_rad, Vec3(0, 1, 0))};
    head.world_from_sonar = motion.pose;
    head.world_from_head = motion.pose * turned * head.state->head().sonar_from_head;
    sonar::PingState& at = head.ping.state;
    at.world_from_sonar = head.world_from_head;
    at.velocity_m_s = motion.velocity_m_s;
    // About the head's own y: a side-scan looks down, so a part of the yaw turns its bearings.
    at.yaw_rate_rad_s =
        (glm::conjugate(head.world_from_head.rotation) * motion.angular_velocity_rad_s).y;
    at.seed = frame.seed;
    at.stream = static_cast<std::uint32_t>(index_ * 2 + place);
    at.ping = ping;
    at.backscatter_scale = tables_.backscatter_scale;
    at.in_water = frame.scene.water.has_value();
    NERITIC_TRY_STATUS(declare_head(frame, capture, state, head));
  }
  return work;
}

Status SonarSensor::declare_head(const FrameParts& frame, const Capture& capture,
                                 const SonarState& sonar, HeadWork& work) const {
  HeadState& state = *work.state;
  sonar::HeadPing& ping = work.ping;
  ping.prefix = state.name + " ";
  work.arrays.capture = capture;
  work.sampled.views = head_views(sonar.made_from, state, state.sampled, work.world_from_head);
  work.arrays.views = head_views(sonar.made_from, state, state.upright, work.world_from_head);
  const bool arrays_wanted = capture.to_host && capture.geometry();
  render::GBuffer arrays;
  if (capture.echoes) {
    NERITIC_TRY(arrays, declare_echoes(frame, capture, sonar, work));
  }
  if (!arrays_wanted) return {};
  // Readers of the arrays expect a plain pinhole, and things of their own size.
  if (!capture.echoes || state.sampled.lean != 0.0 || !work.sampled.draws.larger.empty()) {
    NERITIC_TRY(arrays, declare_geometry(frame, ping.prefix + "arrays ", kFrontFaces, work.arrays,
                                         parts_of(capture)));
  }
  return bring_geometry(frame, ping.prefix, arrays, work.arrays);
}

// The gather of a ping; gives the G-buffer that it reads.
Result<render::GBuffer> SonarSensor::declare_echoes(const FrameParts& frame, const Capture& capture,
                                                    const SonarState& sonar, HeadWork& work) const {
  HeadState& state = *work.state;
  sonar::HeadPing& ping = work.ping;
  if (capture.to_host) {
    NERITIC_TRY(work.buffers,
                state.buffers.take(
                    "sonar " + state.name, [](const auto&) { return true; },
                    [&] { return state.gather->make_buffers(frame.device, ping.prefix); }));
    ping.host = &*work.buffers;
  }
  render::DrawListOptions options = kFrontFaces;
  options.least_drawn = seen_from(state, work.world_from_head);
  NERITIC_TRY(const render::GBuffer g, declare_geometry(frame, ping.prefix, options, work.sampled));
  sonar::HeadGather::Table table;
  if (const gpu::Buffer* buffer = tables_.of(sonar.made_from))
    table = {
        frame.graph.import_buffer(
            ping.prefix + (sonar.made_from.terms.level ? "backscatter" : "reflectivity"), *buffer),
        static_cast<std::uint32_t>(buffer->size() / sizeof(float))};
  work.larger = larger_of(tables_.values_of(sonar.made_from), sonar.made_from, work.sampled.draws);
  sonar::HeadGather::Table own = table;
  own.strengths = work.larger.strengths;
  own.larger = work.larger.places;
  state.gather->begin(frame.graph, view_of(g, work.world_from_head), own, ping);
  NERITIC_TRY_STATUS(declare_ghosts(frame, sonar, table, work));
  state.gather->end(frame.graph, ping);
  return g;
}

// Ghosts of a mirror: the scene as the head's mirror image sees it, added to the head's sums.
Status SonarSensor::declare_ghosts(const FrameParts& frame, const SonarState& sonar,
                                   const sonar::HeadGather::Table& table, HeadWork& work) const {
  const HeadState& state = *work.state;
  work.ghosts_larger.reserve(sonar.mirrors.size());
  for (const sonar::Mirror& mirror : sonar.mirrors) {
    work.ghosts.push_back(std::make_unique<ViewsWork>());
    ViewsWork& ghost = *work.ghosts.back();
    const Pose pose = sonar::mirrored(mirror, work.world_from_head);
    ghost.views = head_views(sonar.made_from, state, state.sampled, pose);
    // A mirror does not show the things beyond it. Solids that it cuts open show their backs, which
    // echo nothing.
    const double inward = mirror.water_below ? -1.0 : 1.0;
    ghost.views.within = render::HalfSpace{{0.0, inward, 0.0}, -inward * mirror.height_m};
    // A bottom that mirrors does not stand in its own way.
    const render::DrawListOptions options{
        .without_class = mirror.water_below ? std::uint16_t{0} : scene::kClasses[0].id,
        .least_drawn = seen_from(state, pose)};
    const std::string prefix =
        work.ping.prefix + (mirror.water_below ? "surface ghosts " : "bottom ghosts ");
    NERITIC_TRY(const render::GBuffer g, declare_geometry(frame, prefix, options, ghost));
    work.ghosts_larger.push_back(larger_of(tables_.values_of(sonar.made_from), sonar.made_from,
                                           ghost.draws, &work.sampled.draws));
    sonar::HeadGather::Table own = table;
    own.strengths = work.ghosts_larger.back().strengths;
    own.larger = work.ghosts_larger.back().places;
    state.gather->add_ghost(frame.graph, view_of(g, pose), own, prefix, work.ping);
  }
  return {};
}

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
  frame.sound_speed_m_s =
      sonar::sound_speed_of(sonar.terms.water, -work.world_from_head.position_m.y);
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
    frame.absorption_db_per_m = ping.absorption_db_per_m;
    if (ping.noise_power > 0.0f)
      for (const glm::vec2& gain : ping.gains)
        frame.noise_power.push_back(ping.noise_power * gain.y);
  }
  if (work.arrays.at_host()) frame.sectors = decode_views(work.arrays);
  return frame;
}

}  // namespace neritic::testbed
