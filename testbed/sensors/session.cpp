#include "testbed/sensors/session.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/clock.hpp"
#include "testbed/sensors/frame_memory.hpp"
#include "testbed/sensors/lens_arrays.hpp"
#include "testbed/sensors/participants.hpp"
#include "testbed/sensors/sonar_check.hpp"
#include "testbed/sensors/sonar_sensor.hpp"
#include "testbed/sensors/view_sensor.hpp"

namespace neritic::testbed {

// Data that a frame's passes borrow, and pins of the buffers that the host reads.
struct FrameWork {
  TimeNs begun_ns = 0;
  std::uint32_t frame = 0;  // the request's
  render::FrameState state;
  std::vector<std::uint32_t> deform_need;  // see FrameParts
  std::vector<scene::MotionAt> poses;
  // A picture: of a camera, or of a view set.
  struct Picture {
    std::string name;
    bool to_host = false;
    ViewsWork work;
  };
  std::vector<std::unique_ptr<Picture>> cameras, views;
  std::vector<std::unique_ptr<SonarWork>> sonars;
  FrameLight light;
};

SensorFrame::SensorFrame() : work_(std::make_unique<FrameWork>()) {}
SensorFrame::~SensorFrame() = default;

Session::Session(gpu::Device& device) : device_(device) {}

Session::~Session() {
  if (device_.handle()) device_.wait_idle();
}

Result<std::unique_ptr<Session>> Session::create(gpu::Device& device, scene::Scene scene,
                                                 std::span<const scene::PicturePlace> places) {
  std::unique_ptr<Session> session(new Session(device));
  session->scene_ = std::move(scene);
  NERITIC_TRY(session->frames_, gpu::Frames::create(device));
  session->frames_->enable_timing(true);
  session->executor_ = std::make_unique<graph::Executor>(*session->frames_);
  NERITIC_TRY(session->renderer_, render::Renderer::create(device));
  NERITIC_TRY(session->gpu_scene_,
              render::GpuScene::create(device, session->scene_,
                                       session->renderer_->material_layout(), places));
  NERITIC_TRY(EchoTables tables, EchoTables::create(device, session->scene_));
  session->sun_maps_ = std::make_unique<SunMaps>();
  session->skylight_ = std::make_unique<Skylight>();
  session->snow_ = std::make_unique<render::SnowField>();
  session->bubbles_ = std::make_unique<render::BubbleField>();
  if (const auto& water = session->scene_.water; water && water->waves)
    session->waves_ = SeaWaves(*water->waves);
  session->moving_ = render::moving_objects(session->scene_);
  for (const std::uint8_t moves : session->moving_) session->still_.push_back(moves ? 0 : 1);
  session->echo_tables_ = std::make_unique<EchoTables>(std::move(tables));
  return session;
}

void Session::replace_sonar(std::size_t index, scene::Sonar sonar) {
  NERITIC_CHECK(index < scene_.sonars.size(), "sonar {} of {}", index, scene_.sonars.size());
  scene_.sonars[index] = std::move(sonar);
}

void Session::dim_lamp(std::size_t index, double share) {
  NERITIC_CHECK(index < scene_.lamps.size(), "lamp {} of {}", index, scene_.lamps.size());
  NERITIC_CHECK(share >= 0.0 && share <= 1.0, "a share of {}", share);
  if (lamp_cd_.empty())
    for (const scene::Lamp& lamp : scene_.lamps) lamp_cd_.push_back(lamp.intensity_cd);
  scene_.lamps[index].intensity_cd = share * lamp_cd_[index];
}

namespace {

// Motion is even over such a time, whatever happens.
constexpr double kEvenMotion_s = 0.05;

// From the first row's beginning to the last one's end, of the slowest shutter of the pictures that
// need motion for themselves; absent: none does.
std::optional<double> exposed_s(const scene::Scene& scene, const FrameRequest& request) {
  std::optional<double> most_s;
  for (std::size_t k = 0; k < request.cameras.size(); ++k) {
    const std::optional<scene::Shutter>& shutter = scene.cameras[request.cameras[k]].terms.shutter;
    if (request.camera_capture(k).color && shutter)
      most_s = std::max(most_s.value_or(0.0), shutter->exposure_s + shutter->readout_s);
  }
  return most_s;
}

// Where motion leads to: the next frame. If only shutters need it, and that is far away, then no
// farther than they see.
double motion_until_s(const FrameRequest& request, std::optional<double> exposed_s) {
  if (!exposed_s || request.wants_motion()) return request.next_time_s;
  return std::min(request.next_time_s, request.time_s + std::max(*exposed_s, kEvenMotion_s));
}

}  // namespace

std::optional<CameraPicture> Session::picture_of(std::size_t index, const Capture& capture) {
  const scene::Camera& camera = scene_.cameras[index];
  if (!camera.terms.changes_picture() && !camera.terms.linear) return std::nullopt;
  CameraPicture out{.terms = camera.terms,
                    .lens = lens_view_of(camera),
                    .width = camera.width,
                    .height = camera.height,
                    .focal_px = camera.height / 2.0 / std::tan(camera.vertical_fov_rad / 2.0),
                    .stream = static_cast<std::uint32_t>(index)};
  if (!out.lens) return out;
  out.focal_px = out.lens->lens.fx;
  if (!capture.to_host || !(capture.geometry() || capture.motion)) return out;
  auto [at, is_new] = lens_maps_.try_emplace(index);
  if (is_new) at->second = lens_map(*camera.terms.lens, *out.lens, camera.width, camera.height);
  out.map = &at->second;
  return out;
}

Result<std::unique_ptr<SensorFrame>> Session::declare(graph::FrameGraph& graph,
                                                      const FrameRequest& request) {
  // A CPU's driver promises memory that the machine does not have, and the system ends programs
  // that use it.
  const std::uint64_t bytes = host_bytes(device_, scene_, request);
  if (bytes > room_found_bytes_) {
    if (const Status room = check_room(bytes); !room.ok())
      return advised(room.error(), scene_, request);
    room_found_bytes_ = bytes;
  }
  auto frame = declare_sensors(graph, request);
  if (!frame.ok()) return advised(frame.error(), scene_, request);
  return frame;
}

Result<std::unique_ptr<SensorFrame>> Session::declare_sensors(graph::FrameGraph& graph,
                                                              const FrameRequest& request) {
  auto frame = std::make_unique<SensorFrame>();
  FrameWork& work = *frame->work_;
  work.begun_ns = now_ns();
  work.frame = request.frame;
  const scene::MotionSource motion(scene_, request.simulated);
  std::vector<render::ViewSet> cameras;
  for (const std::size_t i : request.cameras)
    cameras.push_back(camera_views(motion, scene_.cameras[i], request.time_s, request.next_time_s));
  std::vector<std::uint32_t> worn;
  const auto wear = [&](const render::ViewSet& views) {
    if (views.worn_object != render::ViewSet::kWornByNobody) worn.push_back(views.worn_object);
  };
  for (const render::ViewSet& views : cameras) wear(views);
  for (const ViewsRequest& set : request.views) wear(set.views);
  const std::optional<double> exposed = exposed_s(scene_, request);
  work.state =
      render::evaluate_frame(motion, *gpu_scene_, request.time_s, motion_until_s(request, exposed),
                             request.wants_motion() || exposed.has_value(), worn);
  if (request.capture.poses && request.capture.to_host)
    work.poses = motions_of(participants_of(scene_), motion, request.time_s);
  NERITIC_TRY(const render::DeformedGeometry deformed,
              renderer_->declare_deform(graph, *gpu_scene_, work.state, &work.deform_need));
  render::FramePictures pictures(graph, *gpu_scene_, request.pictures);
  const FrameParts parts{
      graph,         device_,          *renderer_, scene_,    *gpu_scene_,
      motion,        work.state,       deformed,   readback_, request.seed.value_or(scene_.seed),
      work.light,    *sun_maps_,       *skylight_, moving_,   still_,
      request.frame, work.deform_need, *snow_,     *bubbles_, waves_,
      pictures};
  const auto add = [&](const std::string& label, const ViewsRequest& set, std::size_t index,
                       auto& works, std::vector<SensorFrame::Views>& out) -> Status {
    works.push_back(std::make_unique<FrameWork::Picture>());
    works.back()->name = set.name;
    works.back()->to_host = set.capture.to_host;
    NERITIC_TRY(SensorFrame::Views views, declare_views(parts, label, set, works.back()->work));
    views.index = index;
    out.push_back(views);
    return {};
  };
  for (std::size_t k = 0; k < request.cameras.size(); ++k) {
    const std::size_t i = request.cameras[k];
    const scene::Camera& camera = scene_.cameras[i];
    NERITIC_TRY_STATUS(
        add("camera " + camera.name,
            {camera.name, std::move(cameras[k]), camera.exposure, camera.antialias, camera.detail,
             request.camera_capture(k), picture_of(i, request.camera_capture(k))},
            i, work.cameras, frame->cameras));
  }
  for (std::size_t i = 0; i < request.views.size(); ++i)
    NERITIC_TRY_STATUS(
        add("views " + request.views[i].name, request.views[i], i, work.views, frame->views));
  NERITIC_CHECK(request.pings.empty() || request.pings.size() == request.sonars.size(),
                "{} pings of {} sonars", request.pings.size(), request.sonars.size());
  for (std::size_t i = 0; i < request.sonars.size(); ++i) {
    const std::size_t index = request.sonars[i];
    const std::uint32_t ping = request.pings.empty() ? request.frame : request.pings[i];
    while (sonars_.size() <= index)
      sonars_.push_back(std::make_unique<SonarSensor>(*echo_tables_, sonars_.size()));
    auto sonar = sonars_[index]->declare(parts, request.sonar_capture(i), ping);
    if (!sonar.ok()) return of_sonar(scene_, scene_.sonars[index], sonar.error());
    for (const auto& head : (*sonar)->heads)
      frame->sonars.push_back({index, head->state->head().beams, head->ping.image,
                               head->state->gather->has_receiver(),
                               head->state->gather->gather().image_scale()});
    work.sonars.push_back(std::move(*sonar));
  }
  return frame;
}

Result<bool> Session::is_done(const SensorFrame& frame) const {
  NERITIC_TRY(const std::uint64_t completed, frames_->completed());
  return frame.done_at_ > 0 && frame.done_at_ <= completed;
}

Result<FrameResult> Session::read(const SensorFrame& frame) {
  NERITIC_TRY(const bool done, is_done(frame));
  NERITIC_CHECK(done, "frame {} is read before it is done", frame.done_at_);
  NERITIC_TRY_STATUS(frames_->wait(frame.done_at_));  // returns at once, and collects the times
  const FrameWork& work = *frame.work_;
  FrameResult result;
  result.frame = work.frame;
  result.time_s = work.state.time_s;
  for (const auto& camera : work.cameras)
    if (camera->to_host) result.cameras.push_back({camera->name, decode_views(camera->work)});
  for (const auto& set : work.views)
    if (set->to_host) result.views.push_back({set->name, decode_views(set->work)});
  for (const auto& sonar : work.sonars)
    for (SonarFrame& head : sonars_[sonar->index]->decode(*sonar))
      result.sonars.push_back(std::move(head));
  result.poses = work.poses;
  result.passes = frames_->pass_times_of(frame.done_at_);
  result.frame_ms = to_ms(now_ns() - work.begun_ns);
  return result;
}

Result<FrameResult> Session::render(const FrameRequest& request) {
  graph::FrameGraph graph;
  NERITIC_TRY(const auto frame, declare(graph, request));
  if (const Status run = run_to_end(graph, *frame); !run.ok())
    return advised(run.error(), scene_, request);
  return read(*frame);
}

Status Session::run_to_end(graph::FrameGraph& graph, SensorFrame& frame) {
  NERITIC_TRY(gpu::Commands * commands, frames_->begin());
  NERITIC_TRY(const graph::Plan* plan, executor_->run(graph, *commands));
  if (keep_dump_) {
    plan_text_ = graph::dump_text(*plan);
    plan_graphviz_ = graph::dump_graphviz(*plan);
  }
  NERITIC_TRY(const std::uint64_t done, frames_->submit());
  frame.submitted(done);
  return frames_->wait(done);
}

}  // namespace neritic::testbed
