#include "testbed/loop/dive_view.hpp"

#include "testbed/loop/dive_panels.hpp"

namespace neritic::testbed {
namespace {

constexpr TimeNs kNote_ns = 3'000'000'000;  // how long a note stays on the screen

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

DiveView::DiveView(Session& session, xr::Display& display, xr::Overlay* overlay, DivePilot pilot,
                   const DiveViewOptions& options)
    : session_(session),
      display_(display),
      overlay_(overlay),
      options_(options),
      camera_(session.scene().world_from(session.scene().cameras[options.camera].mount)),
      pilot_(std::move(pilot)),
      first_pose_(camera_.world_from_view()),
      screenshots_(session.device(), session.frames(), options.screenshot, options.may_close),
      times_(options.summary) {}

Result<std::unique_ptr<DiveView>> DiveView::create(Session& session, xr::Display& display,
                                                   xr::Overlay* overlay, LivePhysics* physics,
                                                   const DiveViewOptions& options) {
  NERITIC_TRY(
      DivePilot pilot,
      DivePilot::create(physics, session.scene().cameras[options.camera].mount, options.may_fly));
  std::unique_ptr<DiveView> view(
      new DiveView(session, display, overlay, std::move(pilot), options));
  if (overlay) {
    NERITIC_TRY(view->fans_, SonarFans::create(session.device()));
  }
  return view;
}

DiveView::~DiveView() {
  session_.device().wait_idle();
}

Result<xr::FrameVerdict> DiveView::begin_frame() {
  NERITIC_TRY(frame_, display_.begin_frame(camera_.world_from_view()));
  in_frame_ = frame_.verdict != xr::FrameVerdict::kQuit;
  const TimeNs now = now_ns();
  elapsed_s_ = last_frame_ns_ == 0 ? 0.0 : 1e-9 * static_cast<double>(now - last_frame_ns_);
  if (last_frame_ns_ != 0 && shown()) times_.add_frame(elapsed_s_ * 1e3, now);
  last_frame_ns_ = shown() ? now : 0;  // a pause is no slow frame
  return frame_.verdict;
}

bool DiveView::take_input() {
  const DiveInput input =
      read_input(display_.take_actions(overlay_ ? overlay_->claims() : xr::InputClaims{}));
  if (input.toggle_help) show_help_ = !show_help_;
  if (input.toggle_panels) show_panels_ = !show_panels_;
  if (input.screenshot) screenshots_.ask();
  if (input.reset) camera_.start_at(first_pose_);
  if (!pilot_.take(input)) camera_.update(input, elapsed_s_);
  return input.quit;
}

void DiveView::add_views(FrameRequest& request) {
  if (pilot_.flying()) camera_.start_at(pilot_.world_from_view());
  world_from_head_ = frame_.world_from_head.value_or(camera_.world_from_view());
  const scene::Camera& camera = session_.scene().cameras[options_.camera];
  for (std::size_t i = 0; i < frame_.groups.size(); ++i) {
    const xr::ViewGroup& group = frame_.groups[i];
    ViewsRequest views{.name = i == 0 ? camera.name : fmt::format("{} {}", camera.name, i),
                       .exposure = camera.exposure,
                       .antialias = camera.antialias};
    views.views.width = group.width;
    views.views.height = group.height;
    for (const xr::View& view : group.views) {
      const Pose pose = world_from_head_ * view.head_from_view;
      views.views.views.push_back({.world_from_view = pose,
                                   .tangents = view.tangents,
                                   .near_m = camera.near_m,
                                   .next_world_from_view = pose});
    }
    request.views.push_back(std::move(views));
  }
}

// Each ping becomes its sonar's fan, also while the panels are hidden: they show the newest when
// they are back. Where nothing else reads a ping it still runs, as its sonar is wanted.
Status DiveView::declare_sonars(graph::FrameGraph& graph, const SensorFrame& frame) {
  if (fans_) fans_->begin_frame();
  for (const SensorFrame::Sonar& ping : frame.sonars) {
    const scene::Sonar& sonar = session_.scene().sonars[ping.index];
    const bool fan =
        sonar.kind == scene::SonarKind::kImaging || sonar.kind == scene::SonarKind::kProfiling;
    if (fans_ && fan) {
      NERITIC_TRY_STATUS(fans_->declare(graph, sonar.name, ping));
    } else {
      graph.output(ping.image, graph::Access::kStorageReadCompute);
    }
  }
  return {};
}

Status DiveView::declare(graph::FrameGraph& graph, const SensorFrame& frame, double time_s,
                         bool last) {
  NERITIC_TRY_STATUS(declare_sonars(graph, frame));
  if (!shown()) return {};
  std::vector<xr::Layer> layers;
  for (const SensorFrame::Views& views : frame.views)
    layers.push_back(xr::ProjectionLayer{
        .group = views.index, .color = views.color, .depth = views.depth, .near_m = views.near_m});
  if (overlay_) {
    const xr::ViewGroup& group = frame_.groups.front();
    overlay_->begin(group.width, group.height, elapsed_s_);
    if (show_panels_ || show_help_ || now_ns() < note_until_ns_) {
      NERITIC_TRY(const graph::ImageHandle image, declare_overlay(graph, time_s));
      layers.push_back(screen_panel(group, image));
    }
  }
  NERITIC_TRY(const xr::ShownPicture shown, display_.declare(graph, world_from_head_, layers));
  return screenshots_.declare(graph, shown, last);
}

Result<graph::ImageHandle> DiveView::declare_overlay(graph::FrameGraph& graph, double time_s) {
  const TimeNs now = now_ns();
  const float scale = overlay_->scale();
  const scene::Scene& scene = session_.scene();
  if (show_panels_) {
    PanelFacts facts{scene.title.empty() ? scene.path : scene.title,
                     session_.device().info().name,
                     scene.water ? scene.water->type : "",
                     frame_.groups.front().width,
                     frame_.groups.front().height,
                     time_s,
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

gpu::Frames::SubmitSync DiveView::sync() const {
  return shown() ? display_.sync() : gpu::Frames::SubmitSync{};
}

Status DiveView::end_frame(std::optional<std::uint64_t> value) {
  in_frame_ = false;
  NERITIC_TRY_STATUS(display_.end_frame(value.has_value() && shown()));
  NERITIC_TRY(const std::uint64_t completed, session_.frames().completed());
  NERITIC_TRY_STATUS(collect_times(completed));
  if (value) {
    in_flight_.push_back(*value);
    screenshots_.submitted(*value);
  }
  NERITIC_TRY_STATUS(screenshots_.write_done(completed));
  if (auto note = screenshots_.take_note()) {
    note_ = std::move(*note);
    note_until_ns_ = now_ns() + kNote_ns;
  }
  return {};
}

Status DiveView::collect_times(std::uint64_t completed) {
  for (; !in_flight_.empty() && in_flight_.front() <= completed; in_flight_.pop_front()) {
    NERITIC_TRY_STATUS(session_.frames().wait(in_flight_.front()));  // it is done: no wait
    times_.add_passes(session_.frames().pass_times_of(in_flight_.front()), now_ns());
  }
  return {};
}

Status DiveView::finish() {
  if (!in_flight_.empty()) {
    NERITIC_TRY_STATUS(session_.frames().wait(in_flight_.back()));
    NERITIC_TRY_STATUS(collect_times(in_flight_.back()));
  }
  return screenshots_.finish();
}

}  // namespace neritic::testbed
