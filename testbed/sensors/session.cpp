#include "testbed/sensors/session.hpp"

#include <algorithm>
#include <future>

#include "engine/core/check.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/memory.hpp"
#include "engine/render/lighting.hpp"
#include "testbed/sensors/decode.hpp"
#include "testbed/sensors/session_work.hpp"
#include "testbed/sensors/sonar_check.hpp"
#include "testbed/sensors/sonar_station.hpp"

namespace neritic::testbed {
namespace {

template <class T>
std::span<const T> layer_of(const gpu::Buffer& buffer, std::size_t layer, std::size_t elements) {
  return std::span<const T>(buffer.mapped<T>()).subspan(layer * elements, elements);
}

// Below this a thread costs what it saves (0.1 ms here).
constexpr std::size_t kWorthAThread = 1 << 16;

}  // namespace

std::vector<ViewImages> decode_views(const ViewWork& work) {
  std::vector<ViewImages> views;
  for (std::size_t i = 0; i < work.views.views.size(); ++i) {
    const render::ViewDesc& view = work.views.views[i];
    ViewImages eye;
    eye.world_from_view = view.world_from_view;
    eye.intrinsics = intrinsics_of(view.tangents, work.views.width, work.views.height);
    eye.near_m = view.near_m;
    eye.width = work.views.width;
    eye.height = work.views.height;
    const std::size_t pixels = std::size_t{eye.width} * eye.height;
    // Two halves of about the same bytes, which share nothing but the sizes.
    const auto shape = [&] {
      if (work.depth) decode_depth(layer_of<float>(*work.depth, i, pixels), eye);
      if (work.normal) decode_normals(layer_of<std::uint32_t>(*work.normal, i, pixels), eye);
    };
    const auto look = [&] {
      if (work.label) decode_labels(layer_of<std::uint32_t>(*work.label, i, pixels), eye);
      if (work.color) decode_color(layer_of<std::uint32_t>(*work.color, i, pixels), eye);
      if (work.motion)
        decode_motion(
            layer_of<float>(*work.motion, i, pixels * 2),
            work.depth ? layer_of<float>(*work.depth, i, pixels) : std::span<const float>(),
            glm::conjugate(view.next_world_from_view.rotation) * view.world_from_view.rotation,
            eye);
    };
    if (pixels < kWorthAThread || !(work.depth && (work.color || work.motion))) {
      shape();
      look();
    } else {
      auto other = std::async(std::launch::async, look);
      shape();
      other.get();
    }
    views.push_back(std::move(eye));
  }
  return views;
}

render::ViewSet camera_views(const scene::MotionSource& motion, const scene::Camera& camera,
                             double time_s, double next_time_s) {
  render::ViewSet set;
  set.width = camera.width;
  set.height = camera.height;
  render::ViewDesc view;
  view.tangents = tangents_from_fov(camera.vertical_fov_rad, double(camera.width) / camera.height);
  view.near_m = camera.near_m;
  const Pose center = motion.world_from(camera.mount, time_s);
  const Pose next_center = motion.world_from(camera.mount, next_time_s);
  const int eyes = camera.stereo_baseline_m > 0.0 ? 2 : 1;
  for (int i = 0; i < eyes; ++i) {
    const double side = eyes == 1 ? 0.0 : (i == 0 ? -0.5 : 0.5);
    const Vec3 eye_m(side * camera.stereo_baseline_m, 0.0, 0.0);
    view.world_from_view = {center * eye_m, center.rotation};
    view.next_world_from_view = {next_center * eye_m, next_center.rotation};
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
  NERITIC_TRY(session->sonars_, SonarStation::create(device, session->scene_));
  return session;
}

// Adds everything one camera needs to the graph.
Status Session::declare_camera(graph::FrameGraph& graph, const scene::MotionSource& motion,
                               const render::FrameState& state,
                               const render::DeformedGeometry& deformed, const Capture& capture,
                               CameraWork& work) {
  const scene::Camera& camera = scene_.cameras[work.index];
  NERITIC_TRY_STATUS(check_size("camera " + camera.name, camera.width, camera.height));
  work.views = camera_views(motion, camera, state.time_s, state.next_time_s);
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
                render::make_lighting(scene_, state, work.views.origin_m(), camera.exposure,
                                      gpu_scene_->has_emission()));
    NERITIC_TRY(graph::ImageHandle hdr,
                renderer_->declare_shade(graph, prefix, {g, work.views, lighting}));
    NERITIC_TRY(hdr, renderer_->declare_forward(graph, prefix, hdr, g, *gpu_scene_, deformed,
                                                work.views, work.draws, lighting));
    NERITIC_TRY(work.color_image,
                renderer_->declare_picture(graph, prefix, hdr, w, h, layers, camera.antialias));
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
  const scene::MotionSource motion(scene_, request.simulated);
  const bool next = request.capture.motion && !request.cameras.empty() && request.capture.color;
  work.state =
      render::evaluate_frame(motion, *gpu_scene_, request.time_s, request.next_time_s, next);
  NERITIC_TRY(const render::DeformedGeometry deformed,
              renderer_->declare_deform(graph, *gpu_scene_, work.state));
  for (const std::size_t index : request.cameras) {
    work.cameras.push_back(std::make_unique<CameraWork>());
    work.cameras.back()->index = index;
    NERITIC_TRY_STATUS(
        declare_camera(graph, motion, work.state, deformed, request.capture, *work.cameras.back()));
  }
  NERITIC_CHECK(request.pings.empty() || request.pings.size() == request.sonars.size(),
                "{} pings of {} sonars", request.pings.size(), request.sonars.size());
  for (std::size_t i = 0; i < request.sonars.size(); ++i) {
    work.sonars.push_back(std::make_unique<SonarWork>());
    work.sonars.back()->index = request.sonars[i];
    const std::uint32_t ping = request.pings.empty() ? request.frame : request.pings[i];
    const Status declared =
        sonars_->declare({graph, *renderer_, *gpu_scene_, motion, work.state, deformed, readback_,
                          request.capture, request.time_s, ping},
                         *work.sonars.back());
    if (!declared.ok()) return of_sonar(scene_, scene_.sonars[request.sonars[i]], declared.error());
  }
  return {};
}

FrameWork::FrameWork() = default;
FrameWork::~FrameWork() = default;
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
    for (const auto& head : work->heads) {
      const HeadState& state = *head->state;
      frame->sonars.push_back({work->index, state.head.beams,
                               head->power ? head->power : head->sums, bool(head->power),
                               state.gather->image_scale()});
    }
  return frame;
}

// What a person can do about a frame that does not fit: its largest picture by name and size.
Error Session::advised(const Error& error, const FrameRequest& request) const {
  if (error.code != ErrorCode::kOutOfMemory || request.cameras.empty()) return error;
  const scene::Camera* largest = &scene_.cameras[request.cameras.front()];
  for (const std::size_t i : request.cameras) {
    const scene::Camera& camera = scene_.cameras[i];
    if (std::uint64_t{camera.width} * camera.height >
        std::uint64_t{largest->width} * largest->height)
      largest = &camera;
  }
  const std::size_t others = request.cameras.size() + request.sonars.size() - 1;
  return failure(error.code,
                 "camera {} of {}x{}{}: too large for this device: {}; a smaller size{} will do",
                 largest->name, largest->width, largest->height,
                 others > 0 ? fmt::format(" (and {} more sensors in the frame)", others) : "",
                 error.message, others > 0 ? " or fewer sensors at once" : "");
}

// A CPU's driver promises memory that the machine does not have, and the system ends who uses it.
Status Session::check_memory(const FrameRequest& request) {
  // Measured, a pixel: the device's images and read-backs; the host's arrays and their files.
  constexpr std::uint64_t kDevice_bytes = 36, kHost_bytes = 66, kHostColor_bytes = 16;
  const std::uint64_t pixel_bytes =
      (device_.info().kind == "CPU" ? kDevice_bytes : 0) +
      (request.capture.geometry || request.capture.motion ? kHost_bytes : kHostColor_bytes);
  std::uint64_t bytes = 0;
  for (const std::size_t i : request.cameras) {
    const scene::Camera& camera = scene_.cameras[i];
    bytes += std::uint64_t{camera.width} * camera.height * pixel_bytes *
             (camera.stereo_baseline_m > 0.0 ? 2 : 1);
  }
  const std::uint64_t available = available_memory_bytes();
  if (bytes <= room_found_bytes_ || available == 0) return {};
  if (bytes > available)
    return failure(ErrorCode::kOutOfMemory, "{:.1f} GB are needed, the machine has {:.1f} left",
                   double(bytes) * 1e-9, double(available) * 1e-9);
  room_found_bytes_ = bytes;
  return {};
}

Result<FrameResult> Session::render(const FrameRequest& request) {
  if (const Status room = check_memory(request); !room.ok()) return advised(room.error(), request);
  auto result = render_frame(request);
  if (!result.ok()) return advised(result.error(), request);
  return result;
}

Result<FrameResult> Session::render_frame(const FrameRequest& request) {
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
    for (SonarFrame& head : sonars_->decode(*sonar)) result.sonars.push_back(std::move(head));
  result.passes = frames_->pass_times();
  result.frame_ms = to_ms(now_ns() - start);
  return result;
}

}  // namespace neritic::testbed
