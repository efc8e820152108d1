#include "testbed/loop/dive_loop.hpp"

#include <algorithm>
#include <utility>

#include "engine/scene/image_file.hpp"
#include "testbed/loop/dive_panels.hpp"

namespace neritic::testbed {
namespace {

namespace fs = std::filesystem;

constexpr TimeNs kNote_ns = 3'000'000'000;  // how long a note stays on the screen
constexpr int kMaxShots = 10000;
constexpr double kSlack_s = 1e-6;  // sums of frames' periods are rounded

double to_s(TimeNs duration_ns) {
  return static_cast<double>(duration_ns) * 1e-9;
}

// The first free name in the current folder.
fs::path free_shot_name() {
  for (int i = 1; i < kMaxShots; ++i) {
    fs::path path = fmt::format("neritic_{:04}.png", i);
    std::error_code error;
    if (!fs::exists(path, error)) return path;
  }
  return "neritic_last.png";
}

ImageU8 rgb_of(std::span<const std::uint8_t> texels, std::uint32_t width, std::uint32_t height,
               bool bgra) {
  ImageU8 image(width, height, 3);
  const std::size_t pixels = std::size_t{width} * height;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) image.data[3 * i + c] = texels[4 * i + (bgra ? 2 - c : c)];
  return image;
}

std::vector<double> rates_of(const scene::Scene& scene, const std::vector<std::size_t>& sonars) {
  std::vector<double> rates_hz;
  for (const std::size_t i : sonars) rates_hz.push_back(scene.sonars[i].rate_hz);
  return rates_hz;
}

// A panel that covers the group's first view, texel on pixel.
xr::PanelLayer screen_panel(const xr::ViewGroup& group, graph::ImageHandle image) {
  const FrustumTangents& t = group.views.front().tangents;
  return {.name = "panels",
          .image = image,
          .lock = xr::PanelLayer::Lock::kHead,
          .pose = group.views.front().head_from_view *
                  Pose{{0.5 * (t.left + t.right), 0.5 * (t.bottom + t.top), -1.0}},
          .size_m = {t.right - t.left, t.top - t.bottom}};
}

}  // namespace

Dive::Dive(gpu::Device& device, Session& session, xr::Display& display, xr::Overlay* overlay,
           const DiveOptions& options)
    : device_(device),
      session_(session),
      display_(display),
      overlay_(overlay),
      options_(options),
      camera_(session.scene().world_from(session.scene().cameras[options.camera].mount)),
      pilot_(options.physics, session.scene().cameras[options.camera].mount),
      first_pose_(camera_.world_from_view()),
      schedule_(rates_of(session.scene(), options.sonars)),
      times_(options.summary) {}

Status Dive::run() {
  if (overlay_) {
    NERITIC_TRY(fans_, SonarFans::create(device_));
  }
  const TimeNs begun_ns = now_ns();
  for (;;) {
    seconds_ = to_s(now_ns() - begun_ns);
    NERITIC_TRY(const xr::DisplayFrame display_frame,
                display_.begin_frame(camera_.world_from_view()));
    if (display_frame.verdict == xr::FrameVerdict::kQuit) break;
    if (display_frame.verdict == xr::FrameVerdict::kHidden) {
      NERITIC_TRY_STATUS(display_.end_frame());
      last_frame_ns_ = 0;  // a pause is no slow frame
      if (options_.seconds > 0.0 && seconds_ >= options_.seconds) break;
      continue;
    }
    // Simulated time, as this frame will have it: a slow device draws as much of the scene.
    const double next_s = frames_drawn_ == 0 ? 0.0 : time_s_ + to_s(display_frame.period_ns);
    const bool last = (options_.frames > 0 && frames_drawn_ + 1 >= options_.frames) ||
                      (options_.seconds > 0.0 && next_s >= options_.seconds - kSlack_s);
    NERITIC_TRY_STATUS(frame(display_frame, last));
    if (last || quit_) break;
  }
  // The frames still in flight count in the summary too.
  for (std::uint64_t behind = std::min<std::uint64_t>(frames_drawn_, 2); behind > 0; --behind) {
    NERITIC_TRY_STATUS(session_.frames().wait(last_submitted_ - (behind - 1)));
    times_.add_passes(session_.frames().pass_times(), now_ns());
  }
  seconds_ = to_s(now_ns() - begun_ns);
  return write_shot(true);
}

Status Dive::frame(const xr::DisplayFrame& display_frame, bool last) {
  const TimeNs now = now_ns();
  elapsed_s_ = last_frame_ns_ == 0 ? 0.0 : to_s(now - last_frame_ns_);
  if (last_frame_ns_ != 0) times_.add_frame(elapsed_s_ * 1e3, now);
  last_frame_ns_ = now;
  if (frames_drawn_ == 0) start_ns_ = display_frame.display_at_ns;
  if (frames_drawn_ == 0 && options_.physics) options_.physics->start();
  time_s_ = to_s(display_frame.display_at_ns - start_ns_);
  if (options_.physics) time_s_ = options_.physics->follow(display_frame.display_at_ns, time_s_);
  take_input(elapsed_s_);
  if (options_.physics) NERITIC_TRY_STATUS(pilot_.poll(options_.physics->inbox(), time_s_));
  aim_camera(display_frame);

  graph::FrameGraph graph;
  std::unique_ptr<SensorFrame> live;
  NERITIC_TRY_STATUS(declare(graph, display_frame, last, live));
  gpu::Frames& frames = session_.frames();
  NERITIC_TRY(gpu::Commands * commands, frames.begin());
  // Those of the frame that ended; the first frames in flight have none before them.
  if (frames_drawn_ >= 2) times_.add_passes(frames.pass_times(), now);
  NERITIC_TRY(const graph::Plan* plan, session_.executor().run(graph, *commands));
  (void)plan;
  NERITIC_TRY(last_submitted_, frames.submit(display_.sync()));
  if (shot_ && shot_->done == 0) shot_->done = last_submitted_;
  NERITIC_TRY_STATUS(display_.end_frame());
  ++frames_drawn_;
  return write_shot(false);
}

void Dive::take_input(double elapsed_s) {
  const DiveInput input =
      read_input(display_.take_actions(overlay_ ? overlay_->claims() : xr::InputClaims{}));
  if (input.quit) quit_ = true;
  if (input.toggle_help) show_help_ = !show_help_;
  if (input.toggle_panels) show_panels_ = !show_panels_;
  if (input.screenshot) shot_wanted_ = true;
  if (input.reset) camera_.start_at(first_pose_);
  if (pilot_.take(input))
    camera_.start_at(pilot_.world_from_view());
  else
    camera_.update(input, elapsed_s);
}

// The scene's camera goes to the display's view, in its size.
void Dive::aim_camera(const xr::DisplayFrame& display_frame) {
  world_from_head_ = display_frame.world_from_head.value_or(camera_.world_from_view());
  const xr::ViewGroup& group = display_frame.groups.front();
  scene::Camera& camera = session_.scene().cameras[options_.camera];
  camera.mount = {-1, world_from_head_ * group.views.front().head_from_view};
  camera.width = group.width;
  camera.height = group.height;
}

void Dive::add_due_sonars(FrameRequest& request) {
  for (const PingSchedule::Due& due : schedule_.due(request.time_s)) {
    request.sonars.push_back(options_.sonars[due.sensor]);
    request.pings.push_back(due.number);
  }
}

Status Dive::declare(graph::FrameGraph& graph, const xr::DisplayFrame& display_frame, bool last,
                     std::unique_ptr<SensorFrame>& live) {
  FrameRequest request;
  request.time_s = request.next_time_s = time_s_;
  if (options_.physics) request.simulated = &options_.physics->motion();
  request.cameras = {options_.camera};
  request.capture = kColorOnGpu;
  const bool panels = options_.panels && show_panels_;
  if (panels || !overlay_) add_due_sonars(request);
  NERITIC_TRY(live, session_.declare(graph, request));
  std::vector<xr::Layer> layers{xr::ProjectionLayer{.color = live->cameras.front().color}};
  if (overlay_) {
    const xr::ViewGroup& group = display_frame.groups.front();
    overlay_->begin(group.width, group.height, elapsed_s_);
    fans_->begin_frame();
    for (const SensorFrame::Sonar& ping : live->sonars) {
      const scene::Sonar& sonar = session_.scene().sonars[ping.index];
      if (sonar.kind == scene::SonarKind::kImaging || sonar.kind == scene::SonarKind::kProfiling) {
        NERITIC_TRY_STATUS(fans_->declare(graph, sonar.name, ping));
      } else {
        graph.output(ping.image, graph::Access::kStorageReadCompute);
      }
    }
    if (panels || show_help_ || now_ns() < note_until_ns_) {
      NERITIC_TRY(const graph::ImageHandle image, declare_overlay(graph, *live));
      layers.push_back(screen_panel(group, image));
    }
  } else {
    for (const SensorFrame::Sonar& ping : live->sonars)
      graph.output(ping.image, graph::Access::kStorageReadCompute);
  }
  NERITIC_TRY(const xr::ShownPicture shown, display_.declare(graph, world_from_head_, layers));
  // If any frame may be the last, each is brought to the host for --screenshot.
  const bool final_shot = !options_.screenshot.empty() && (last || options_.may_close);
  if (last && final_shot && shot_ && shot_->by_key) NERITIC_TRY_STATUS(write_shot(true));
  if ((final_shot || shot_wanted_) && !(shot_ && shot_->by_key))
    NERITIC_TRY_STATUS(declare_shot(graph, shown));
  return {};
}

Result<graph::ImageHandle> Dive::declare_overlay(graph::FrameGraph& graph,
                                                 const SensorFrame& live) {
  const TimeNs now = now_ns();
  const float scale = overlay_->scale();
  const scene::Scene& scene = session_.scene();
  if (options_.panels && show_panels_) {
    PanelFacts facts{scene.title.empty() ? scene.path : scene.title,
                     device_.info().name,
                     scene.water ? scene.water->type : "",
                     live.cameras.front().width,
                     live.cameras.front().height,
                     time_s_,
                     {},
                     pilot_.lines()};
    for (const std::size_t index : options_.sonars) {
      const graph::ImageHandle picture = fans_->picture(graph, index);
      if (!picture) continue;
      facts.sonars.push_back({scene.sonars[index].name, overlay_->texture(picture),
                              *fans_->shape(index), *fans_->grid(index),
                              scene.sonars[index].rate_hz});
    }
    draw_readout(camera_, scale);
    if (!show_help_ || help_leaves_room(dive_actions(), scale))
      draw_sonars(facts, draw_status(facts, camera_, times_, now, scale), scale);
    draw_hint(now < note_until_ns_ ? note_ : "F1  keys", scale);
  } else if (now < note_until_ns_) {
    draw_hint(note_, scale);
  }
  if (show_help_) draw_help(dive_actions(), scale);
  return overlay_->declare(graph);
}

Status Dive::declare_shot(graph::FrameGraph& graph, const xr::ShownPicture& shown) {
  const bool by_key = std::exchange(shot_wanted_, false);
  if (!shown.readable) {
    if (!by_key)
      return failure(ErrorCode::kUnsupported,
                     "--screenshot: the images of this window cannot be read; use --headless");
    note_ = "no screenshot: this window's images cannot be read";
    note_until_ns_ = now_ns() + kNote_ns;
    return {};
  }
  Shot shot;
  shot.path = by_key ? free_shot_name() : options_.screenshot;
  shot.width = shown.width;
  shot.height = shown.height;
  shot.by_key = by_key;
  shot.bgra = shown.format == VK_FORMAT_B8G8R8A8_UNORM;
  NERITIC_TRY(shot.texels, readback_.declare(graph, device_, "screenshot", shown.image,
                                             shown.format, shown.width, shown.height, 1));
  shot_ = std::move(shot);
  return {};
}

// Writes a screenshot once its frame is done (two frames later it surely is: no more are in
// flight). The one for --screenshot is replaced by the next frame's until the end.
Status Dive::write_shot(bool at_end) {
  if (!shot_ || shot_->done == 0) return {};
  if (!at_end && (!shot_->by_key || last_submitted_ < shot_->done + 2)) return {};
  NERITIC_TRY_STATUS(session_.frames().wait(shot_->done));
  NERITIC_TRY_STATUS(scene::write_png8(
      shot_->path,
      rgb_of(shot_->texels->mapped<std::uint8_t>(), shot_->width, shot_->height, shot_->bgra)));
  note_ = "wrote " + shot_->path.string();
  note_until_ns_ = now_ns() + kNote_ns;
  shot_.reset();
  return {};
}

}  // namespace neritic::testbed
