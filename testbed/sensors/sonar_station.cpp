#include "testbed/sensors/sonar_station.hpp"

#include <algorithm>
#include <tuple>

#include "engine/core/check.hpp"
#include "engine/core/intrinsics.hpp"
#include "sonar/quality.hpp"

namespace neritic::testbed {
namespace {

// A view a sector; all are of one pinhole.
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

std::string name_of(const scene::Sonar& sonar, const HeadState& head) {
  return head.head.name.empty() ? sonar.name : sonar.name + " " + head.head.name;
}

}  // namespace

Result<std::unique_ptr<SonarStation>> SonarStation::create(gpu::Device& device,
                                                           const scene::Scene& scene) {
  std::unique_ptr<SonarStation> made(new SonarStation(device, scene));
  if (scene.sonars.empty()) return made;
  made->reflectivities_ = sonar::reflectivity_table(scene);
  NERITIC_TRY(made->reflectivity_, table_buffer(device, "reflectivity", made->reflectivities_));
  if (std::ranges::any_of(scene.sonars, [](const auto& s) { return s.terms.level.has_value(); })) {
    const sonar::BackscatterTable table = sonar::backscatter_table(scene);
    made->backscatter_scale_ = table.scale;
    NERITIC_TRY(made->backscatter_, table_buffer(device, "backscatter", table.strength));
  }
  return made;
}

const gpu::Buffer* SonarStation::table_of(const scene::Sonar& sonar) const {
  const gpu::Buffer& table = sonar.terms.level ? backscatter_ : reflectivity_;
  return table.size() > 0 ? &table : nullptr;
}

Result<std::unique_ptr<HeadState>> SonarStation::make_head(const scene::Sonar& sonar,
                                                           const SonarState& state,
                                                           sonar::Head head) {
  auto made = std::make_unique<HeadState>();
  HeadState& h = *made;
  h.head = std::move(head);
  h.sectors = sonar::plan_sectors(h.head.samples);
  h.upright = {h.sectors.front().tangents, 0.0,
               sonar::gbuffer_size(h.head.samples, h.sectors.front(), state.pixels_per_cell,
                                   device_.limits().maxImageDimension2D)};
  // The published gather takes whole pixels of cells; a cone looks at a bottom, smooth beside its
  // cells, which upright pixels in their middles tell best.
  h.sampled = state.mode == sonar::Gather::kPublished || h.head.folded
                  ? h.upright
                  : sonar::leaning_view(h.head.samples, h.sectors.front(), state.pixels_per_cell,
                                        device_.limits().maxImageDimension2D);
  sonar::GBufferLayout layout;
  layout.width = h.sampled.size.width;
  layout.height = h.sampled.size.height;
  layout.intrinsics = intrinsics_of(h.sampled.tangents, layout.width, layout.height);
  layout.lean = h.sampled.lean;
  layout.near_m = sonar.near_m;
  sonar::GatherOptions options{
      .gather = state.mode, .reflectivity = table_of(sonar) != nullptr, .echo = h.head.echo};
  const auto gather = [&]() -> Result<std::unique_ptr<sonar::SonarGather>> {
    NERITIC_TRY(auto g,
                sonar::SonarGather::create(device_, h.head.samples, h.sectors, layout, options));
    return std::make_unique<sonar::SonarGather>(std::move(g));
  };
  NERITIC_TRY(h.gather, gather());
  const std::string name = name_of(sonar, h);
  const auto readable = [&](const std::string& what, std::uint64_t bytes,
                            VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
    return gpu::Buffer::create(device_,
                               {name + " " + what, bytes, usage, gpu::MemoryUse::kReadback});
  };
  NERITIC_TRY(h.keys, readable("keys", h.gather->keys_bytes(), h.gather->sums_usage()));
  if (!h.head.echo) {
    NERITIC_TRY(h.sums, readable("sums", h.gather->sums_bytes(), h.gather->sums_usage()));
    return made;
  }
  sonar::ReceiverDesc desc = h.head.receiver;
  desc.sum_scale = h.gather->fixed_scale();
  NERITIC_TRY(sonar::Receiver receiver, sonar::Receiver::create(device_, std::move(desc)));
  h.receiver = std::make_unique<sonar::Receiver>(std::move(receiver));
  NERITIC_TRY(h.power, readable("power", h.receiver->power_bytes()));
  if (h.head.echo->records) {
    NERITIC_TRY(h.records, readable("records", h.gather->records_bytes()));
  }
  if (state.mirrors.empty()) return made;
  options.echo->ghost = true;
  options.echo->weights = sonar::ghost_weights(sonar, h.head);
  NERITIC_TRY(h.ghosts, gather());
  h.ghost_corrections.resize(state.mirrors.size());
  for (std::size_t i = 0; h.head.echo->records && i < state.mirrors.size(); ++i) {
    NERITIC_TRY(auto buffer,
                readable(fmt::format("ghost records {}", i), h.gather->records_bytes()));
    h.ghost_records.push_back(std::move(buffer));
  }
  return made;
}

Result<SonarState*> SonarStation::state_of(std::size_t index) {
  std::unique_ptr<SonarState>& slot = sonars_[index];
  scene::Sonar sonar = scene_.sonars[index];
  if (slot && scene::same_settings(slot->made_from, sonar)) return slot.get();
  auto state = std::make_unique<SonarState>();
  state->made_from = sonar;
  NERITIC_TRY_STATUS(sonar::apply_quality(sonar));
  NERITIC_TRY(state->mode, sonar::gather_of(sonar.gather.empty() ? kDefaultGather : sonar.gather));
  state->pixels_per_cell = sonar.gbuffer_scale > 0.0 ? sonar.gbuffer_scale : kDefaultGBufferScale;
  state->mirrors = sonar::mirrors_of(sonar);
  if (!state->mirrors.empty() && !device_.features().shaderClipDistance)
    return failure(ErrorCode::kUnsupported,
                   "ghosts: {} has no shaderClipDistance, which a mirror's view is cut by",
                   device_.info().name);
  NERITIC_TRY(std::vector<sonar::Head> heads, sonar::plan_heads(sonar));
  for (sonar::Head& head : heads) {
    auto made = make_head(sonar, *state, std::move(head));
    if (!made.ok()) return made.error();
    state->heads.push_back(std::move(*made));
  }
  if (slot) device_.wait_idle();  // frames in flight may read what the old settings made
  slot = std::move(state);
  return slot.get();
}

sonar::PingState SonarStation::ping_state(const Frame& frame, const HeadWork& head,
                                          const scene::Motion& sonar,
                                          const Pose& world_from_head) const {
  sonar::PingState ping;
  ping.world_from_sonar = world_from_head;
  ping.velocity_m_s = sonar.velocity_m_s;
  // About the head's own y: a side-scan looks down, and so turns its bearings by a part of a yaw.
  ping.yaw_rate_rad_s = (glm::conjugate(world_from_head.rotation) * sonar.angular_velocity_rad_s).y;
  ping.seed = scene_.seed;
  ping.stream = static_cast<std::uint32_t>(head.index * 2 + head.place);
  ping.ping = frame.ping;
  ping.backscatter_scale = backscatter_scale_;
  ping.corrections = &head.state->corrections;
  return ping;
}

Status SonarStation::declare(const Frame& frame, SonarWork& work) {
  NERITIC_TRY(work.state, state_of(work.index));
  for (const auto& state : work.state->heads) {
    work.heads.push_back(std::make_unique<HeadWork>());
    work.heads.back()->state = state.get();
    work.heads.back()->place = work.heads.size() - 1;
    NERITIC_TRY_STATUS(declare_head(frame, work, *work.heads.back()));
  }
  return {};
}

Status SonarStation::declare_head(const Frame& frame, const SonarWork& work, HeadWork& head) {
  const scene::Sonar& sonar = scene_.sonars[work.index];
  HeadState& state = *head.state;
  const bool host = frame.capture.to_host;
  head.heading_rad = sonar::scan_heading_rad(sonar, frame.ping);
  const Pose turned{Vec3(0.0), glm::angleAxis(-head.heading_rad, Vec3(0, 1, 0))};
  const scene::Motion motion = frame.motion.at(sonar.mount, frame.time_s).motion;
  head.world_from_sonar = motion.pose;
  const Pose world_from_head = motion.pose * turned * state.head.sonar_from_head;
  head.index = work.index;
  const std::string prefix = name_of(sonar, state) + " ";
  const auto gbuffer_of = [&](ViewWork& view, const std::string& of,
                              const sonar::LeaningView& hole) {
    view.views = head_views(sonar, state, hole, world_from_head);
    view.draws = render::build_draw_list(scene_, frame.gpu_scene, frame.state, view.views,
                                         {.hide_back_faces = true});
    return frame.renderer.declare_gbuffer(frame.graph, of, render::GBufferKind::kGeometry,
                                          frame.gpu_scene, frame.state, frame.deformed, view.views,
                                          view.draws);
  };
  NERITIC_TRY(const render::GBuffer g, gbuffer_of(head.sampled, prefix, state.sampled));
  const sonar::PingState ping = ping_state(frame, head, motion, world_from_head);
  sonar::SonarGather::Inputs inputs;
  inputs.prefix = prefix;
  inputs.depth = g.depth;
  inputs.normals = g.normal;
  inputs.labels = g.label;
  if (const gpu::Buffer* table = table_of(sonar)) {
    inputs.reflectivity = frame.graph.import_buffer(
        prefix + (sonar.terms.level ? "backscatter" : "reflectivity"), *table);
    inputs.reflectivities = static_cast<std::uint32_t>(table->size() / sizeof(float));
  }
  inputs.sonar_from_gbuffer = glm::mat3_cast(glm::conjugate(world_from_head.rotation));
  const auto target = [&](const gpu::Buffer& buffer, const char* name) {
    return host && buffer.size() > 0 ? frame.graph.import_buffer(prefix + name, buffer)
                                     : graph::BufferHandle{};
  };
  const bool in_place = device_.info().shared_memory;
  if (in_place) {
    inputs.sums_target = target(state.sums, "sums");
    inputs.keys_target = target(state.keys, "keys");
  }
  inputs.records_target = target(state.records, "records");
  if (state.head.echo) {
    head.ping = sonar::ping_of(sonar, state.head, ping);
    inputs.echo = head.ping.echo;
    inputs.correction = head.ping.correction;
  }
  sonar::SonarGather::Outputs out = state.gather->declare(frame.graph, inputs);
  if (host && state.records.size() > 0) frame.graph.output(out.records, graph::Access::kHostRead);
  NERITIC_TRY_STATUS(declare_ghosts(frame, work, head, ping, inputs, out));
  head.sums = out.sums;
  if (state.receiver)
    head.power = state.receiver->declare(frame.graph, out.sums, head.ping.receiver(),
                                         target(state.power, "power"), prefix);
  if (!host) return {};
  const auto at_host = [&](graph::BufferHandle from, const gpu::Buffer& to, const char* name) {
    return in_place ? from
                    : graph::copy_buffer(frame.graph, prefix + name + " to host", from,
                                         prefix + name, to);
  };
  frame.graph.output(state.receiver ? head.power : at_host(head.sums, state.sums, "sums"),
                     graph::Access::kHostRead);
  frame.graph.output(at_host(out.keys, state.keys, "keys"), graph::Access::kHostRead);
  head.views = head_views(sonar, state, state.upright, world_from_head);
  if (!frame.capture.geometry) return {};
  // Who reads arrays expects a plain pinhole.
  render::GBuffer arrays = g;
  if (state.sampled.lean != 0.0) {
    NERITIC_TRY(arrays, gbuffer_of(head, prefix + "arrays ", state.upright));
  }
  const auto bring = [&](const char* name, graph::ImageHandle image, VkFormat format) {
    return frame.readback.declare(frame.graph, device_, prefix + name, image, format, arrays.width,
                                  arrays.height, arrays.layers);
  };
  NERITIC_TRY(head.depth, bring("depth", arrays.depth, render::kDepthFormat));
  NERITIC_TRY(head.normal, bring("normal", arrays.normal, render::kNormalFormat));
  NERITIC_TRY(head.label, bring("label", arrays.label, render::kLabelFormat));
  return {};
}

// A mirror's ghosts: the scene as the head's mirror image sees it, added to what the head heard.
Status SonarStation::declare_ghosts(const Frame& frame, const SonarWork& work, HeadWork& head,
                                    const sonar::PingState& direct_ping,
                                    const sonar::SonarGather::Inputs& direct,
                                    sonar::SonarGather::Outputs& out) {
  const scene::Sonar& sonar = scene_.sonars[work.index];
  HeadState& state = *head.state;
  for (std::size_t i = 0; i < work.state->mirrors.size(); ++i) {
    const sonar::Mirror& mirror = work.state->mirrors[i];
    head.ghosts.push_back(std::make_unique<HeadWork::Ghost>());
    HeadWork::Ghost& ghost = *head.ghosts.back();
    const Pose pose = sonar::mirrored(mirror, direct_ping.world_from_sonar);
    ghost.view.views = head_views(sonar, state, state.sampled, pose);
    // What stands beyond the mirror is not what it shows. Cut open there, solids show their backs,
    // which echo nothing.
    const double inward = mirror.water_below ? -1.0 : 1.0;
    ghost.view.views.within = render::HalfSpace{{0.0, inward, 0.0}, -inward * mirror.height_m};
    // A bottom that mirrors does not stand in its own way.
    const render::DrawListOptions draw{.without_class = mirror.water_below ? std::uint16_t{0}
                                                                           : scene::kClasses[0].id};
    ghost.view.draws =
        render::build_draw_list(scene_, frame.gpu_scene, frame.state, ghost.view.views, draw);
    const std::string prefix =
        direct.prefix + (mirror.water_below ? "surface ghosts " : "bottom ghosts ");
    NERITIC_TRY(const render::GBuffer g,
                frame.renderer.declare_gbuffer(frame.graph, prefix, render::GBufferKind::kGeometry,
                                               frame.gpu_scene, frame.state, frame.deformed,
                                               ghost.view.views, ghost.view.draws));
    sonar::PingState ghost_state = direct_ping;
    ghost_state.corrections = &state.ghost_corrections[i];
    ghost.ping = sonar::ping_of(sonar, state.head, ghost_state, &mirror);
    sonar::SonarGather::Inputs inputs = direct;
    inputs.prefix = prefix;
    inputs.depth = g.depth;
    inputs.normals = g.normal;
    inputs.labels = g.label;
    inputs.direct_depth = direct.depth;
    inputs.direct_labels = direct.labels;
    inputs.sonar_from_gbuffer = glm::mat3_cast(glm::conjugate(pose.rotation));
    inputs.sums_so_far = out.sums;
    inputs.keys_so_far = out.keys;
    inputs.echo = ghost.ping.echo;
    inputs.correction = ghost.ping.correction;
    inputs.records_target = {};
    const bool records = frame.capture.to_host && i < state.ghost_records.size();
    if (records)
      inputs.records_target = frame.graph.import_buffer(prefix + "records", state.ghost_records[i]);
    const auto added = state.ghosts->declare(frame.graph, inputs);
    if (records) frame.graph.output(added.records, graph::Access::kHostRead);
    out.sums = added.sums;
    out.keys = added.keys;
  }
  return {};
}

}  // namespace neritic::testbed
