#include "tools/session/session.hpp"

#include "engine/core/clock.hpp"
#include "engine/render/lighting.hpp"
#include "tools/session/decode.hpp"

namespace neritic::tools {
namespace {

// What one camera has in the graph: its CPU data (which must outlive the run) and readback buffers.
struct CameraWork {
  std::size_t index = 0;
  render::ViewSet views;
  render::DrawList draws;
  const gpu::Buffer *depth = nullptr, *normal = nullptr, *label = nullptr, *color = nullptr, *motion = nullptr;
};

template <class T>
std::span<const T> layer_of(const gpu::Buffer& buffer, std::size_t layer, std::size_t elements) {
  return std::span<const T>(buffer.mapped<T>()).subspan(layer * elements, elements);
}

CameraFrame decode_camera(const scene::Camera& camera, const CameraWork& work) {
  CameraFrame frame;
  frame.name = camera.name;
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
    frame.eyes.push_back(std::move(eye));
  }
  return frame;
}

}  // namespace

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
    view.world_from_view.position_m += center.rotation * Vec3(side * camera.stereo_baseline_m, 0.0, 0.0);
    view.next_world_from_view = view.world_from_view;
    set.views.push_back(view);
  }
  return set;
}

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
  NERITIC_TRY(session->gpu_scene_, render::GpuScene::create(device, session->scene_, session->renderer_->material_layout()));
  return session;
}

Result<FrameResult> Session::render(const FrameRequest& request) {
  const TimeNs start = now_ns();
  const std::uint32_t limit = device_.limits().maxImageDimension2D;
  const bool motion = request.capture.motion;
  const render::FrameState state =
      render::evaluate_frame(scene_, *gpu_scene_, request.time_s, request.next_time_s, motion);
  graph::FrameGraph graph;
  NERITIC_TRY(const render::DeformedGeometry deformed, renderer_->declare_deform(graph, *gpu_scene_, state));

  std::vector<std::unique_ptr<CameraWork>> cameras;
  for (const std::size_t index : request.cameras) {
    const scene::Camera& camera = scene_.cameras[index];
    if (camera.width == 0 || camera.height == 0 || camera.width > limit || camera.height > limit)
      return bad_input("camera {}: size {}x{}; 1 to {} pixels a side are accepted", camera.name, camera.width, camera.height, limit);
    auto work = std::make_unique<CameraWork>();
    work->index = index;
    work->views = camera_views(scene_, camera);
    work->draws = render::build_draw_list(scene_, *gpu_scene_, state, work->views);
    const std::string prefix = camera.name + " ";
    const std::uint32_t w = work->views.width, h = work->views.height, layers = work->views.layers();
    NERITIC_TRY(const render::GBuffer g, renderer_->declare_gbuffer(graph, prefix, request.capture.color ? render::GBufferKind::kSurface : render::GBufferKind::kGeometry,
                                                                    *gpu_scene_, state, deformed, work->views, work->draws));
    const auto bring = [&](const char* name, graph::ImageHandle image, VkFormat format) {
      return readback_.declare(graph, device_, prefix + name, image, format, w, h, layers);
    };
    if (request.capture.color) {
      NERITIC_TRY(const shared::Lighting lighting,
                  render::make_lighting(scene_, work->views.origin_m(), camera.exposure, gpu_scene_->has_emission()));
      NERITIC_TRY(graph::ImageHandle hdr, renderer_->declare_shade(graph, prefix, g, work->views, lighting));
      NERITIC_TRY(hdr, renderer_->declare_forward(graph, prefix, hdr, g, *gpu_scene_, deformed, work->views, work->draws, lighting));
      NERITIC_TRY(const graph::ImageHandle color, renderer_->declare_tonemap(graph, prefix, hdr, w, h, layers));
      NERITIC_TRY(work->color, bring("color", color, render::kColorFormat));
    }
    if (request.capture.geometry) {
      NERITIC_TRY(work->depth, bring("depth", g.depth, render::kDepthFormat));
      NERITIC_TRY(work->normal, bring("normal", g.normal, render::kNormalFormat));
      NERITIC_TRY(work->label, bring("label", g.label, render::kLabelFormat));
    }
    if (g.motion) {
      NERITIC_TRY(work->motion, bring("motion", g.motion, render::kMotionFormat));
    }
    cameras.push_back(std::move(work));
  }

  NERITIC_TRY(gpu::Commands * commands, frames_->begin());
  NERITIC_TRY(const graph::Plan* plan, executor_->run(graph, *commands));
  if (keep_dump_) {
    plan_text_ = graph::dump_text(*plan);
    plan_graphviz_ = graph::dump_graphviz(*plan);
  }
  NERITIC_TRY(const std::uint64_t done, frames_->submit());
  NERITIC_TRY_STATUS(frames_->wait(done));

  FrameResult result;
  for (const auto& work : cameras) result.cameras.push_back(decode_camera(scene_.cameras[work->index], *work));
  result.passes = frames_->pass_times();
  result.frame_ms = to_ms(now_ns() - start);
  return result;
}

}  // namespace neritic::tools
