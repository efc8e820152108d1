#include "testbed/sensors/sonar_sensor.hpp"

namespace neritic::testbed {
namespace {

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

// Empty where nothing is drawn larger in this ping: the scene's own table counts.
std::vector<float> strengths_of(const std::vector<float>& table, const render::DrawList& draws,
                                const HeadState& state, std::span<const float> weights) {
  if (draws.larger.empty()) return {};
  return sample_strengths(table, draws.larger, state.head().samples, weights);
}

}  // namespace

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
  // Readers of the arrays expect a plain pinhole.
  if (!capture.echoes || state.sampled.lean != 0.0) {
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
  std::span<const float> weights;
  if (const auto& echo = state.head().echo) weights = echo->weights;
  work.strengths =
      strengths_of(tables_.values_of(sonar.made_from), work.sampled.draws, state, weights);
  sonar::HeadGather::Table own = table;
  own.strengths = work.strengths;
  state.gather->begin(frame.graph, view_of(g, work.world_from_head), own, ping);
  NERITIC_TRY_STATUS(declare_ghosts(frame, sonar, table, work));
  state.gather->end(frame.graph, ping);
  return g;
}

// Ghosts of a mirror: the scene as the head's mirror image sees it, added to the head's sums.
Status SonarSensor::declare_ghosts(const FrameParts& frame, const SonarState& sonar,
                                   const sonar::HeadGather::Table& table, HeadWork& work) const {
  const HeadState& state = *work.state;
  work.ghost_strengths.reserve(sonar.mirrors.size());
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
    work.ghost_strengths.push_back(
        strengths_of(tables_.values_of(sonar.made_from), ghost.draws, state, {}));
    sonar::HeadGather::Table own = table;
    own.strengths = work.ghost_strengths.back();
    state.gather->add_ghost(frame.graph, view_of(g, pose), own, prefix, work.ping);
  }
  return {};
}

}  // namespace neritic::testbed
