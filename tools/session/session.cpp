#include "tools/session/session.hpp"

#include <algorithm>
#include <tuple>

#include "engine/core/check.hpp"
#include "engine/core/clock.hpp"
#include "engine/render/lighting.hpp"
#include "tools/session/decode.hpp"
#include "tools/session/session_work.hpp"

namespace neritic::tools {
namespace {

template <class T>
std::span<const T> layer_of(const gpu::Buffer& buffer, std::size_t layer, std::size_t elements) {
  return std::span<const T>(buffer.mapped<T>()).subspan(layer * elements, elements);
}

std::vector<ViewImages> decode_views(const ViewWork& work) {
  std::vector<ViewImages> views;
  for (std::size_t i = 0; i < work.views.views.size(); ++i) {
    const render::ViewDesc& view = work.views.views[i];
    ViewImages eye;
    eye.world_from_view = view.world_from_view;
    eye.intrinsics = render::intrinsics_of(view.tangents, work.views.width, work.views.height);
    eye.near_m = view.near_m;
    eye.width = work.views.width;
    eye.height = work.views.height;
    const std::size_t pixels = std::size_t{eye.width} * eye.height;
    if (work.depth) decode_depth(layer_of<float>(*work.depth, i, pixels), eye);
    if (work.normal) decode_normals(layer_of<std::uint32_t>(*work.normal, i, pixels), eye);
    if (work.label) decode_labels(layer_of<std::uint32_t>(*work.label, i, pixels), eye);
    if (work.color) decode_color(layer_of<std::uint32_t>(*work.color, i, pixels), eye);
    if (work.motion) decode_motion(layer_of<float>(*work.motion, i, pixels * 2), eye);
    views.push_back(std::move(eye));
  }
  return views;
}

render::ViewSet sonar_views(const scene::Scene& scene, const scene::Sonar& sonar,
                            const Session::SonarState& state) {
  render::ViewSet set;
  set.width = state.size.width;
  set.height = state.size.height;
  const Pose world_from_sonar = scene.world_from(sonar.mount);
  for (const sonar::Sector& sector : state.gather->sectors()) {
    render::ViewDesc view;
    view.tangents = sector.tangents;
    view.near_m = sonar.near_m;
    view.world_from_view =
        world_from_sonar * Pose{Vec3(0.0), glm::angleAxis(-sector.yaw_rad, Vec3(0, 1, 0))};
    view.next_world_from_view = view.world_from_view;
    set.views.push_back(view);
  }
  return set;
}

// What a sonar's state is made from: all but its name, its rate and where it is.
auto settings_of(const scene::Sonar& s) {
  return std::tie(s.kind, s.range_min_m, s.range_max_m, s.azimuth_rad, s.elevation_rad,
                  s.bins_range, s.bins_azimuth, s.bins_elevation, s.gbuffer_scale, s.gather,
                  s.near_m);
}

SonarFrame decode_sonar(const scene::Sonar& sonar, const SonarWork& work) {
  SonarFrame frame;
  frame.name = sonar.name;
  frame.gather = sonar::name_of(work.state->mode);
  frame.grid = work.state->gather->grid();
  frame.fixed_scale = work.state->gather->fixed_scale();
  frame.gbuffer_width = work.state->size.width;
  frame.gbuffer_height = work.state->size.height;
  frame.pixels_per_cell = work.state->pixels_per_cell;
  const FrustumTangents& t = work.state->gather->sectors().front().tangents;
  frame.pixels_per_cell_used = {
      work.state->size.width * frame.grid.azimuth_step_rad() / (t.right - t.left),
      work.state->size.height * frame.grid.elevation_step_rad() / (t.top - t.bottom)};
  frame.reflectivity = work.state->reflectivity;
  frame.image = work.state->gather->to_image(work.state->sums.mapped<std::uint32_t>(),
                                             work.state->keys.mapped<std::uint32_t>());
  frame.sectors = work.depth ? decode_views(work) : std::vector<ViewImages>{};
  return frame;
}

}  // namespace

Result<sonar::BeamGrid> sonar_grid(const scene::Sonar& sonar) {
  const sonar::BeamGrid grid = sonar::symmetric_grid(
      sonar.range_min_m, sonar.range_max_m, sonar.azimuth_rad, sonar.elevation_rad,
      {sonar.bins_range, sonar.bins_azimuth, sonar.bins_elevation});
  if (const Status valid = sonar::validate(grid); !valid.ok())
    return bad_input("sonar {}: {}", sonar.name, valid.error().message);
  return grid;
}

Result<Session::SonarState*> Session::sonar_state(std::size_t index) {
  std::unique_ptr<SonarState>& slot = sonars_[index];
  const scene::Sonar& sonar = scene_.sonars[index];
  if (slot && settings_of(slot->made_from) == settings_of(sonar)) return slot.get();
  auto state = std::make_unique<SonarState>();
  state->made_from = sonar;
  NERITIC_TRY(const sonar::BeamGrid grid, sonar_grid(sonar));
  NERITIC_TRY(state->mode, sonar::gather_of(sonar.gather.empty() ? kDefaultGather : sonar.gather));
  const std::vector<sonar::Sector> sectors = sonar::plan_sectors(grid);
  state->pixels_per_cell = sonar.gbuffer_scale > 0.0 ? sonar.gbuffer_scale : kDefaultGBufferScale;
  state->reflectivity = reflectivity_.size() > 0;
  state->size = sonar::gbuffer_size(grid, sectors.front(), state->pixels_per_cell,
                                    device_.limits().maxImageDimension2D);
  sonar::GBufferLayout layout;
  layout.width = state->size.width;
  layout.height = state->size.height;
  layout.intrinsics = sonar::intrinsics_of(sectors.front().tangents, layout.width, layout.height);
  layout.near_m = sonar.near_m;
  NERITIC_TRY(auto gather, sonar::SonarGather::create(device_, grid, sectors, layout,
                                                      {state->mode, true, state->reflectivity}));
  state->gather = std::make_unique<sonar::SonarGather>(std::move(gather));
  const auto result = [&](const char* what) {
    return gpu::Buffer::create(
        device_, {sonar.name + what, state->gather->buffer_bytes(),
                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                  gpu::MemoryUse::kReadback});
  };
  NERITIC_TRY(state->sums, result(" sums"));
  NERITIC_TRY(state->keys, result(" keys"));
  if (slot) device_.wait_idle();  // frames in flight may read what the old settings made
  slot = std::move(state);
  return slot.get();
}

// Acoustic reflectivity by instance label; no table where every object's is 1.
Status Session::create_reflectivity() {
  if (std::ranges::all_of(scene_.objects,
                          [](const scene::Object& object) { return object.reflectivity == 1.0f; }))
    return {};
  std::vector<float> table(1, 0.0f);
  for (const scene::Object& object : scene_.objects) {
    const std::size_t end = object.instance + object.instance_count();
    if (table.size() < end) table.resize(end, 1.0f);
    std::fill_n(table.begin() + object.instance, object.instance_count(), object.reflectivity);
  }
  NERITIC_TRY(reflectivity_,
              gpu::Buffer::create(device_, {"reflectivity", table.size() * sizeof(float),
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  return gpu::upload_buffer(device_, reflectivity_, std::as_bytes(std::span(table)));
}

render::ViewSet camera_views(const scene::Scene& scene, const scene::Camera& camera) {
  render::ViewSet set;
  set.width = camera.width;
  set.height = camera.height;
  render::ViewDesc view;
  view.tangents = tangents_from_fov(camera.vertical_fov_rad, double(camera.width) / camera.height);
  view.near_m = camera.near_m;
  const Pose center = scene.world_from(camera.mount);
  const int eyes = camera.stereo_baseline_m > 0.0 ? 2 : 1;
  for (int i = 0; i < eyes; ++i) {
    const double side = eyes == 1 ? 0.0 : (i == 0 ? -0.5 : 0.5);
    view.world_from_view = center;
    view.world_from_view.position_m +=
        center.rotation * Vec3(side * camera.stereo_baseline_m, 0.0, 0.0);
    view.next_world_from_view = view.world_from_view;
    set.views.push_back(view);
  }
  return set;
}

Session::Session(gpu::Device& device) : device_(device) {}

Session::~Session() {
  if (device_.handle()) device_.wait_idle();
}

Result<std::unique_ptr<Session>> Session::create(gpu::Device& device, scene::Scene scene) {
  std::unique_ptr<Session> session(new Session(device));
  session->scene_ = std::move(scene);
  NERITIC_TRY(session->frames_, gpu::Frames::create(device));
  session->frames_->enable_timing(true);
  session->executor_ = std::make_unique<graph::Executor>(*session->frames_);
  NERITIC_TRY(session->renderer_, render::Renderer::create(device));
  NERITIC_TRY(session->gpu_scene_, render::GpuScene::create(device, session->scene_,
                                                            session->renderer_->material_layout()));
  if (!session->scene_.sonars.empty()) NERITIC_TRY_STATUS(session->create_reflectivity());
  return session;
}

// Adds everything one camera needs to the graph.
Status Session::declare_camera(graph::FrameGraph& graph, const render::FrameState& state,
                               const render::DeformedGeometry& deformed, const Capture& capture,
                               CameraWork& work) {
  const scene::Camera& camera = scene_.cameras[work.index];
  NERITIC_TRY_STATUS(check_size("camera " + camera.name, camera.width, camera.height));
  work.views = camera_views(scene_, camera);
  work.draws = render::build_draw_list(scene_, *gpu_scene_, state, work.views);
  const std::string prefix = camera.name + " ";
  const std::uint32_t w = work.views.width, h = work.views.height, layers = work.views.layers();
  // Always as a camera sees (single-sided materials, no blended ones in the depth), with or without
  // colour.
  constexpr auto kind = render::GBufferKind::kSurface;
  NERITIC_TRY(const render::GBuffer g,
              renderer_->declare_gbuffer(graph, prefix, kind, *gpu_scene_, state, deformed,
                                         work.views, work.draws));
  const auto bring = [&](const char* name, graph::ImageHandle image, VkFormat format) {
    return readback_.declare(graph, device_, prefix + name, image, format, w, h, layers);
  };
  if (capture.color) {
    NERITIC_TRY(const shared::Lighting lighting,
                render::make_lighting(scene_, work.views.origin_m(), camera.exposure,
                                      gpu_scene_->has_emission()));
    NERITIC_TRY(graph::ImageHandle hdr,
                renderer_->declare_shade(graph, prefix, g, work.views, lighting));
    NERITIC_TRY(hdr, renderer_->declare_forward(graph, prefix, hdr, g, *gpu_scene_, deformed,
                                                work.views, work.draws, lighting));
    NERITIC_TRY(work.color_image, renderer_->declare_tonemap(graph, prefix, hdr, w, h, layers));
    if (camera.antialias) {
      NERITIC_TRY(work.color_image,
                  renderer_->declare_antialias(graph, prefix, work.color_image, w, h, layers));
    }
  }
  if (!capture.to_host) return {};
  if (capture.color) {
    NERITIC_TRY(work.color, bring("color", work.color_image, render::kColorFormat));
  }
  if (capture.geometry) {
    NERITIC_TRY(work.depth, bring("depth", g.depth, render::kDepthFormat));
    NERITIC_TRY(work.normal, bring("normal", g.normal, render::kNormalFormat));
    NERITIC_TRY(work.label, bring("label", g.label, render::kLabelFormat));
  }
  if (g.motion) {
    NERITIC_TRY(work.motion, bring("motion", g.motion, render::kMotionFormat));
  }
  return {};
}

// Adds one sonar: its own geometry G-buffer, then the gather into buffers that the host reads.
Status Session::declare_sonar(graph::FrameGraph& graph, const render::FrameState& state,
                              const render::DeformedGeometry& deformed, const Capture& capture,
                              SonarWork& work) {
  const scene::Sonar& sonar = scene_.sonars[work.index];
  NERITIC_TRY(work.state, sonar_state(work.index));
  work.views = sonar_views(scene_, sonar, *work.state);
  work.draws = render::build_draw_list(scene_, *gpu_scene_, state, work.views);
  const std::string prefix = sonar.name + " ";
  NERITIC_TRY(const render::GBuffer g,
              renderer_->declare_gbuffer(graph, prefix, render::GBufferKind::kGeometry, *gpu_scene_,
                                         state, deformed, work.views, work.draws));
  sonar::SonarGather::Inputs inputs;
  inputs.prefix = prefix;
  inputs.depth = g.depth;
  inputs.normals = g.normal;
  inputs.labels = g.label;
  if (work.state->reflectivity) {
    inputs.reflectivity = graph.import_buffer(prefix + "reflectivity", reflectivity_);
    inputs.reflectivities = static_cast<std::uint32_t>(reflectivity_.size() / sizeof(float));
  }
  inputs.sonar_from_gbuffer =
      glm::mat3_cast(glm::conjugate(scene_.world_from(sonar.mount).rotation));
  if (capture.to_host) {
    inputs.sums_target = graph.import_buffer(prefix + "sums", work.state->sums);
    inputs.keys_target = graph.import_buffer(prefix + "keys", work.state->keys);
  }
  work.outputs = work.state->gather->declare(graph, inputs);
  if (!capture.to_host) return {};
  graph.output(work.outputs.sums, graph::Access::kHostRead);
  graph.output(work.outputs.keys, graph::Access::kHostRead);
  if (!capture.geometry) return {};
  const auto bring = [&](const char* name, graph::ImageHandle image, VkFormat format) {
    return readback_.declare(graph, device_, prefix + name, image, format, g.width, g.height,
                             g.layers);
  };
  NERITIC_TRY(work.depth, bring("depth", g.depth, render::kDepthFormat));
  NERITIC_TRY(work.normal, bring("normal", g.normal, render::kNormalFormat));
  NERITIC_TRY(work.label, bring("label", g.label, render::kLabelFormat));
  return {};
}

Status Session::check_size(const std::string& what, std::uint32_t width,
                           std::uint32_t height) const {
  const std::uint32_t limit = device_.limits().maxImageDimension2D;
  if (width == 0 || height == 0 || width > limit || height > limit)
    return bad_input("{}: size {}x{}; 1 to {} pixels a side are accepted", what, width, height,
                     limit);
  return {};
}

// Adds the passes of every sensor asked for; work keeps what they borrow.
Status Session::declare_sensors(graph::FrameGraph& graph, const FrameRequest& request,
                                FrameWork& work) {
  const bool motion = request.capture.motion && !request.cameras.empty() && request.capture.color;
  work.state =
      render::evaluate_frame(scene_, *gpu_scene_, request.time_s, request.next_time_s, motion);
  NERITIC_TRY(const render::DeformedGeometry deformed,
              renderer_->declare_deform(graph, *gpu_scene_, work.state));
  for (const std::size_t index : request.cameras) {
    work.cameras.push_back(std::make_unique<CameraWork>());
    work.cameras.back()->index = index;
    NERITIC_TRY_STATUS(
        declare_camera(graph, work.state, deformed, request.capture, *work.cameras.back()));
  }
  for (const std::size_t index : request.sonars) {
    work.sonars.push_back(std::make_unique<SonarWork>());
    work.sonars.back()->index = index;
    NERITIC_TRY_STATUS(
        declare_sonar(graph, work.state, deformed, request.capture, *work.sonars.back()));
  }
  return {};
}

LiveFrame::LiveFrame() : work_(std::make_unique<FrameWork>()) {}
LiveFrame::~LiveFrame() = default;

Result<std::unique_ptr<LiveFrame>> Session::declare(graph::FrameGraph& graph,
                                                    FrameRequest request) {
  request.capture = {.color = true, .geometry = false, .motion = false, .to_host = false};
  auto frame = std::make_unique<LiveFrame>();
  NERITIC_TRY_STATUS(declare_sensors(graph, request, *frame->work_));
  for (const auto& work : frame->work_->cameras)
    frame->cameras.push_back({work->index, work->color_image, work->views.width, work->views.height,
                              work->views.layers()});
  for (const auto& work : frame->work_->sonars)
    frame->sonars.push_back({work->index, work->outputs.sums, work->state->gather.get()});
  return frame;
}

Result<FrameResult> Session::render(const FrameRequest& request) {
  const TimeNs start = now_ns();
  NERITIC_CHECK(request.capture.to_host, "frame {}: render brings its images to the host",
                request.frame);
  graph::FrameGraph graph;
  FrameWork work;
  NERITIC_TRY_STATUS(declare_sensors(graph, request, work));

  NERITIC_TRY(gpu::Commands * commands, frames_->begin());
  NERITIC_TRY(const graph::Plan* plan, executor_->run(graph, *commands));
  if (keep_dump_) {
    plan_text_ = graph::dump_text(*plan);
    plan_graphviz_ = graph::dump_graphviz(*plan);
  }
  NERITIC_TRY(const std::uint64_t done, frames_->submit());
  NERITIC_TRY_STATUS(frames_->wait(done));

  FrameResult result;
  for (const auto& camera : work.cameras) {
    result.cameras.push_back({scene_.cameras[camera->index].name, decode_views(*camera)});
  }
  for (const auto& sonar : work.sonars)
    result.sonars.push_back(decode_sonar(scene_.sonars[sonar->index], *sonar));
  result.passes = frames_->pass_times();
  result.frame_ms = to_ms(now_ns() - start);
  return result;
}

}  // namespace neritic::tools
