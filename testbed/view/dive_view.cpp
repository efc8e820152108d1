#include "testbed/view/dive_view.hpp"

#include <algorithm>

#include "engine/core/log.hpp"
#include "testbed/instruments/instrument_data.hpp"
#include "testbed/view/key_words.hpp"

namespace neritic::testbed {

static_assert(xr::kMostHiddenCorners <= render::kMostHidden);
namespace {

constexpr TimeNs kUnpaced_ns = 16'666'667;  // the period where no screen paces the frames
constexpr double kSpeeds[] = {0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0};

}  // namespace

std::uint32_t scaled(std::uint32_t pixels, double scale) {
  return static_cast<std::uint32_t>(std::max(1.0, std::round(scale * pixels)));
}

DiveView::DiveView(Session& session, xr::Display& display, DivePilot pilot,
                   const DiveViewOptions& options)
    : session_(session),
      display_(display),
      options_(options),
      choice_(session.scene(), options.viewpoint),
      pilot_(std::move(pilot)),
      world_from_stage_(session.scene().world_from_lab.value_or(level(choice_.world_from_view()))),
      screenshots_(session.device(), session.frames(), options.screenshot),
      picker_(session.device()),
      times_(options.summary) {}

Result<std::unique_ptr<DiveView>> DiveView::create(Session& session, xr::Display& display,
                                                   xr::Overlay* overlay, LivePhysics* physics,
                                                   const DiveViewOptions& options) {
  NERITIC_TRY(DivePilot pilot, DivePilot::create(physics, options.may_fly));
  std::unique_ptr<DiveView> view(new DiveView(session, display, std::move(pilot), options));
  view->physics_ = physics;
  if (options.may_fly && physics && !physics->world().humans().empty())
    view->wearer_.emplace(*physics);
  if (options.swim && view->wearer_) view->wearer_->swim_by_keys(true);
  // The panels of a window beside a headset are not the person's.
  const bool his_panels = overlay && !options.beside_headset;
  if (!his_panels && !options.task.empty()) log_info("{}", options.task);
  if (physics && options.keep) view->keeper_.emplace(*physics, *options.keep);
  if (overlay) {
    NERITIC_TRY(view->console_,
                Console::create(session, *overlay,
                                {.actions = options.actions,
                                 .sonars = options.sonars,
                                 .clock = options.clock,
                                 .keeper = view->keeper_ ? &*view->keeper_ : nullptr,
                                 .physics = physics,
                                 .memory = options.memory,
                                 .devices = options.devices,
                                 .steers = view->steers(),
                                 .units = options.units,
                                 .task = his_panels ? options.task : ""}));
  }
  if (options.hud) {
    view->hud_ = std::make_unique<DiveHud>(session.device(), session.frames(), *physics,
                                           view->choose_console_sensors(), options.devices);
  }
  NERITIC_TRY_STATUS(view->prepare());
  return view;
}

DiveView::~DiveView() {
  session_.device().wait_idle();
}

Result<xr::FrameVerdict> DiveView::begin_frame() {
  if (options_.timeline) timeline_.begin(now_ns());
  NERITIC_TRY_STATUS(await_device());
  NERITIC_TRY(frame_, display_.begin_frame(world_from_stage_));
  in_frame_ = frame_.verdict != xr::FrameVerdict::kQuit;
  const TimeNs now = now_ns();
  if (options_.timeline) {
    timeline_.current().begun = now;
    timeline_.current().display_at = frame_.display_at_ns;
  }
  elapsed_s_ = last_frame_ns_ == 0 ? 0.0 : 1e-9 * static_cast<double>(now - last_frame_ns_);
  if (last_frame_ns_ != 0 && shown()) times_.add_frame(elapsed_s_ * 1e3, now);
  last_frame_ns_ = shown() ? now : 0;  // a pause is no slow frame
  if (shown() && options_.governed) govern();
  return frame_.verdict;
}

// From the first frame that is shown: only then the size of the views is known. A display may get
// faster later. One that gets slower keeps its budget: a runtime halves its rate where frames are
// late, and a budget that grew with it would keep them late.
void DiveView::govern() {
  const double period_ms = 1e-6 * static_cast<double>(frame_.period_ns.value_or(kUnpaced_ns));
  const double budget_ms = std::max(period_ms, options_.least_budget_ms);
  if (governor_) return governor_->shorten_budget(budget_ms);
  double pixels = 0.0;
  for (const xr::ViewGroup& group : frame_.groups)
    pixels +=
        static_cast<double>(group.width) * group.height * static_cast<double>(group.views.size());
  const bool cpu = session_.device().info().kind == "CPU";
  governor_.emplace(budget_ms, cpu ? first_rung_on_cpu(pixels) : 0);
}

// The lab's frame where the scene says where that lies; else the eyes of the diver who is worn;
// else level at the viewpoint, so that the horizon of a headset stays level.
Pose DiveView::world_from_stage(const scene::MotionSource& motion, double time_s) {
  if (session_.scene().world_from_lab) return *session_.scene().world_from_lab;
  if (wearer_ && wears_) return wearer_->world_from_stage(motion, time_s);
  return level(choice_.world_from_view());
}

// The key that flies a vehicle swims the worn diver where the view is his, or no vehicle is there.
bool DiveView::swum_by_keys(DiveInput& input) {
  if (!wearer_ || frame_.world_from_head) return false;
  const bool his = choice_.carrier() == static_cast<int>(wearer_->object());
  if (input.toggle_pilot && (wearer_->swum_by_keys() || his || pilot_.object() < 0)) {
    input.toggle_pilot = false;
    const bool on = !wearer_->swum_by_keys();
    wearer_->swim_by_keys(on);
    if (on && !his) choice_.choose_on(static_cast<int>(wearer_->object()));
    tell(on ? swim_words(options_.actions) : "the diver goes on as before");
  }
  return wearer_->swum_by_keys();
}

bool DiveView::take_input() {
  const xr::InputClaims claims = console_ ? console_->claims() : xr::InputClaims{};
  DiveInput input = read_input(display_.take_actions(claims));
  // The operator at the window beside a worn headset: he works the run and its panels and flies
  // vehicles, but moves neither the wearer nor what he looks from.
  const DiveInput beside = read_input(display_.take_mirror_actions(claims));
  input = with_commands(input, beside);
  if (console_) console_->take(input);
  if (input.cycle_hud && hud_) hud_->cycle();
  if (input.cycle_hud && !hud_) tell(options_.no_instruments);
  if (options_.clock) take_time(input);
  keep_run(input);
  if (input.screenshot) screenshots_.ask();
  if (input.panel_screenshot) {
    if (const auto part = console_ ? console_->panel_under_cursor() : std::nullopt)
      screenshots_.ask(*part);
    else
      tell("no panel under the cursor");
  }
  take_click();
  if (input.next_lamps) switch_lamps();
  if (input.view_step != 0) wears_ = false;
  if (input.reset) {
    wears_ = true;
    if (wearer_) wearer_->face_ahead();
  }
  const bool swum = swum_by_keys(input);
  // Until the stage lies at the diver's eyes, poses in it mean nothing to him.
  const double speed = options_.clock ? options_.clock->speed() : 1.0;
  if (wearer_)
    wearer_->take(wears_ && placed_ ? frame_ : xr::DisplayFrame{}, input, choice_.world_from_eyes(),
                  speed, elapsed_s_);
  if (input.toggle_pilot && !steers()) tell(options_.nobody_to_steer);
  if (input.jacket != 0 && !works_jacket_) tell(no_jacket());
  works_jacket_ = input.jacket != 0;
  const bool flew = pilot_.flying();
  DiveInput flown = watched() ? beside : input;
  flown.toggle_pilot = input.toggle_pilot;
  if (swum) flown.move = Vec3(0.0), flown.turn = 0.0;
  const bool flying = pilot_.take(flown, choice_.carrier(), speed);
  if (flying && !flew && !watched() && choice_.carrier() != pilot_.object())
    choice_.choose_on(pilot_.object());
  choice_.take(input, elapsed_s_, (flying && !watched()) || swum,
               swum ? static_cast<int>(wearer_->object()) : -1);
  return input.quit;
}

void DiveView::take_click() {
  const auto click = console_ ? console_->take_click() : std::nullopt;
  if (!click || !shown()) return;
  const xr::ViewGroup& group = frame_.groups.front();
  if (frame_.mirror)
    return picker_.ask(*click, group.views.front().tangents, frame_.mirror->views.front().tangents);
  const scene::Camera& camera = session_.scene().cameras[choice_.viewpoint().camera];
  picker_.ask(*click, tangents_from_fov(camera.vertical_fov_rad,
                                        static_cast<double>(group.width) / group.height));
}

// Those of the vehicle that is flown, of the diver who is swum, or of what is looked from; where
// that has none all of the scene. The note says whose. A recording does not have it.
void DiveView::switch_lamps() {
  const scene::Scene& scene = session_.scene();
  const bool swum = wearer_ && wearer_->swum_by_keys();
  const int carrier = pilot_.flying() ? pilot_.object()
                      : swum          ? static_cast<int>(wearer_->object())
                                      : choice_.carrier();
  std::vector<std::string> whose;
  const auto is_on = [&](const scene::Lamp& lamp, int object) {
    return carrier_of(scene, lamp.mount) == object;
  };
  const bool own = std::ranges::any_of(
      scene.lamps, [&](const scene::Lamp& lamp) { return carrier >= 0 && is_on(lamp, carrier); });
  lamp_share_ = lamp_share_ == 1.0 ? 0.0 : lamp_share_ + 0.5;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
    if (own && !is_on(scene.lamps[i], carrier)) continue;
    session_.dim_lamp(i, lamp_share_);
    ++count;
    const int on = carrier_of(scene, scene.lamps[i].mount);
    const std::string& name =
        on >= 0 ? scene.objects[static_cast<std::size_t>(on)].name : scene.title;
    if (std::ranges::find(whose, name) == whose.end()) whose.push_back(name);
  }
  tell(count == 0 ? "no lamp to switch"
                  : fmt::format("{} {} of {}: {:.0f} %", count, count == 1 ? "lamp" : "lamps",
                                fmt::join(whose, ", "), 100.0 * lamp_share_));
}

std::optional<ViewMemory> DiveView::memory() const {
  return console_ ? std::optional(console_->memory()) : std::nullopt;
}

bool DiveView::steers() const {
  return options_.may_fly && physics_ &&
         (!physics_->world().vehicles().empty() || !physics_->world().humans().empty());
}

// Why the jacket's keys do nothing; empty: a diver has one.
std::string DiveView::no_jacket() const {
  if (wearer_ && physics_->world().humans()[0].body.jacket.capacity_m3 > 0.0) return {};
  if (!steers()) return options_.nobody_to_steer;
  return wearer_ ? "the diver wears no jacket" : "no diver here wears a jacket";
}

// In a window a note, else a line.
void DiveView::tell(const std::string& note) {
  if (note.empty()) return;
  if (console_)
    console_->note(note);
  else
    log_info("{}", note);
}

// The state and the recording by key.
void DiveView::keep_run(const DiveInput& input) {
  if (!keeper_) {
    if (input.save || input.go_back || input.record) tell(options_.no_keys_for_files);
    return;
  }
  if (input.save) tell(keeper_->save());
  if (input.record) tell(keeper_->toggle_recording());
  tell(keeper_->trouble());
  if (!input.go_back) return;
  bool went = false;
  tell(keeper_->go_back(went));
  if (!went) return;
  pilot_.went_back();
  if (wearer_) wearer_.emplace(*physics_);  // claims what is worn anew
}

std::uint32_t DiveView::ping_every() const {
  return quality().ping_every;
}

// Pause, one frame on, a speed of kSpeeds.
void DiveView::take_time(const DiveInput& input) {
  sim::RunClock& clock = *options_.clock;
  if (input.toggle_pause) clock.pause(!clock.paused());
  if (input.step_frame) clock.step(static_cast<TimeNs>(options_.frame_s * 1e9));
  for (int i = 0; i < std::abs(input.faster); ++i) {
    const double speed = clock.speed();
    const auto above = std::ranges::upper_bound(kSpeeds, speed);
    const auto below = std::ranges::lower_bound(kSpeeds, speed);
    if (input.faster > 0 && above != std::end(kSpeeds)) clock.set_speed(*above);
    if (input.faster < 0 && below != std::begin(kSpeeds)) clock.set_speed(*(below - 1));
  }
}

// What a group's pictures are like, by the camera of the viewpoint; neither size nor views.
ViewsRequest DiveView::request_of(std::size_t group, std::uint32_t light) const {
  const scene::Camera& camera = session_.scene().cameras[choice_.viewpoint().camera];
  return {.name = group == 0 ? camera.name : fmt::format("{} {}", camera.name, group),
          .exposure = camera.exposure,
          .antialias = camera.antialias,
          .detail = detail_at(camera.detail, light),
          .thrift = thrift_at(light)};
}

void DiveView::add_views(FrameRequest& request) {
  const scene::MotionSource motion(session_.scene(), request.simulated);
  choice_.follow(motion, request.time_s);
  world_from_stage_ = world_from_stage(motion, request.time_s);
  display_.track(frame_, world_from_stage_);
  placed_ = true;
  world_from_head_ = frame_.world_from_head.value_or(choice_.world_from_view());
  if (console_) console_->look(motion, request.time_s, pilot_, world_from_head_.position_m);
  const scene::Camera& camera = session_.scene().cameras[choice_.viewpoint().camera];
  const bool tracked = frame_.world_from_head.has_value();
  const std::uint32_t worn = worn_object(motion, request.time_s);
  for (std::size_t i = 0; i < frame_.groups.size(); ++i) {
    const xr::ViewGroup& group = frame_.groups[i];
    ViewsRequest views = request_of(i, quality().light);
    const double scale = view_scale();
    timeline_.current().view_scale = scale;
    views.views.width = scaled(group.width, scale);
    views.views.height = scaled(group.height, scale);
    views.views.worn_object = worn;
    // A display that tracks nobody shows what the camera sees.
    const FrustumTangents lens =
        tangents_from_fov(camera.vertical_fov_rad, double(group.width) / group.height);
    for (const xr::View& view : group.views) {
      const Pose pose = world_from_head_ * view.head_from_view;
      views.views.views.push_back({.world_from_view = pose,
                                   .tangents = tracked ? view.tangents : lens,
                                   .near_m = camera.near_m,
                                   .next_world_from_view = pose,
                                   .hidden = tracked ? view.hidden : std::vector<Vec2f>()});
    }
    request.views.push_back(std::move(views));
  }
  add_inset(request, motion);
  add_console_camera(request, motion);
}

// The body whose eyes the views are: the wearer's, or in a window that which carries the camera in
// its head.
std::uint32_t DiveView::worn_object(const scene::MotionSource& motion, double time_s) const {
  if (!frame_.world_from_head)
    return worn_by(motion, choice_.viewpoint().mount, world_from_head_.position_m, time_s);
  return wearer_ && wears_ ? static_cast<std::uint32_t>(wearer_->object())
                           : render::ViewSet::kWornByNobody;
}

// When the picture is seen: the display's time; where none paces the frames, the pictures' own.
double DiveView::seen_s(double time_s) const {
  return frame_.display_at_ns ? 1e-9 * static_cast<double>(*frame_.display_at_ns) : time_s;
}

// Where nothing else reads a ping it still runs, as its sonar is wanted.
Status DiveView::declare_sonars(graph::FrameGraph& graph, const SensorFrame& frame) {
  NERITIC_TRY_STATUS(declare_console_sonar(graph, frame));
  if (console_) return console_->declare_sonars(graph, frame);
  for (const SensorFrame::Sonar& ping : frame.sonars)
    graph.output(ping.image, graph::Access::kStorageReadCompute);
  return {};
}

Status DiveView::declare(graph::FrameGraph& graph, const SensorFrame& frame, double time_s,
                         bool last) {
  NERITIC_TRY_STATUS(declare_sonars(graph, frame));
  pinged_ = !frame.sonars.empty();
  if (!shown()) return {};
  std::vector<xr::Layer> layers;
  graph::ImageHandle inset;
  for (const SensorFrame::Views& views : frame.views) {
    if (views.index >= frame_.groups.size()) {
      if (views.index == inset_view_) inset = views.color;
      continue;
    }
    if (views.index == 0) NERITIC_TRY_STATUS(picker_.declare(graph, views));
    layers.push_back(xr::ProjectionLayer{
        .group = views.index, .color = views.color, .depth = views.depth, .near_m = views.near_m});
  }
  if (hud_) NERITIC_TRY_STATUS(declare_hud(graph, frame, time_s, layers));
  // Beside a headset's the panels lie over the window's pictures alone.
  if (console_ && (!watched() || frame_.mirror)) {
    const xr::ViewGroup& group = frame_.mirror ? *frame_.mirror : frame_.groups.front();
    const bool by_diver = watched() && wearer_ && wears_;
    auto taken = hud_ && !watched() ? hud_->taken(group) : std::vector<PanelRect>();
    NERITIC_TRY(auto panels,
                console_->declare(
                    graph, {.group = group,
                            .choice = choice_,
                            .pilot = pilot_,
                            .times = times_,
                            .elapsed_s = elapsed_s_,
                            .time_s = time_s,
                            .quality = quality(),
                            .taken = std::move(taken),
                            .inset = inset,
                            .world_from_head = watched() ? frame_.world_from_head : std::nullopt,
                            .worn = by_diver ? static_cast<int>(wearer_->object()) : -1}));
    if (panels) panels->mirror_only = watched();
    if (panels) layers.push_back(*panels);
  }
  NERITIC_TRY(const xr::ShownPicture shown, display_.declare(graph, world_from_head_, layers));
  NERITIC_TRY_STATUS(screenshots_.declare(graph, shown, last));
  timeline_.current().declared = now_ns();
  return {};
}

Status DiveView::declare_hud(graph::FrameGraph& graph, const SensorFrame& frame, double time_s,
                             std::vector<xr::Layer>& layers) {
  const xr::ViewGroup& group = frame_.groups.front();
  HudView seen{group, frame_.world_from_head.has_value(), world_from_stage_,
               world_from_head_ * group.views.front().head_from_view};
  seen.stage_at_eyes = !session_.scene().world_from_lab;
  seen.seen_s = seen_s(time_s);
  // On the arm as this picture draws it, which follows the tracked one.
  if (frame_.tracked.hands[0] && wearer_ && wears_)
    seen.world_from_wrist =
        world_from_drawn_wrist(physics_->world().humans()[0],
                               scene::MotionSource(session_.scene(), &physics_->motion()), time_s);
  for (const SensorFrame::Views& views : frame.views)
    if (views.index == camera_view_) seen.camera = {views.color, views.width, views.height};
  if (hud_->wants_pictures(seen.seen_s) && console_sonar_ && console_fans_)
    if (const FanShape* const fan = console_fans_->shape(*console_sonar_))
      seen.sonar = {console_fans_->picture(graph, *console_sonar_), fan->width, fan->height};
  return hud_->declare(graph, seen, layers);
}

gpu::Frames::SubmitSync DiveView::sync() const {
  timeline_.current().recorded = now_ns();
  return shown() ? display_.sync() : gpu::Frames::SubmitSync{};
}

Status DiveView::end_frame(std::optional<std::uint64_t> value) {
  in_frame_ = false;
  if (value) timeline_.current().submitted = now_ns();
  NERITIC_TRY_STATUS(display_.end_frame(value.has_value() && shown()));
  if (options_.timeline) timeline_.end(now_ns(), value);
  NERITIC_TRY(const std::uint64_t completed, session_.frames().completed());
  NERITIC_TRY_STATUS(collect_times(completed));
  if (value) {
    in_flight_.push_back({*value, pinged_});
    screenshots_.submitted(*value);
    picker_.submitted(*value);
  }
  if (auto picked = picker_.take(completed, session_.scene(), options_.units); picked && console_)
    console_->mark(std::move(*picked));
  NERITIC_TRY_STATUS(screenshots_.write_done(completed));
  if (const auto note = screenshots_.take_note()) tell(*note);
  return {};
}

// A frame shows what is known when it begins. It would be drawn after those that the device has not
// finished, so they come first, all but one where the display's runtime times the frames: the host
// waits before it asks what is known, not between that and the submission.
Status DiveView::await_device() {
  const std::size_t ahead = display_.paces_device() ? 1 : 0;
  if (options_.overlap || in_flight_.size() <= ahead) return {};
  return session_.frames().wait(in_flight_[in_flight_.size() - 1 - ahead].value);
}

Status DiveView::collect_times(std::uint64_t completed) {
  for (; !in_flight_.empty() && in_flight_.front().value <= completed; in_flight_.pop_front()) {
    const auto [value, pinged] = in_flight_.front();
    NERITIC_TRY_STATUS(session_.frames().wait(value));  // it is done: no wait
    const std::vector<gpu::PassTime> passes = session_.frames().pass_times_of(value);
    times_.add_passes(passes, now_ns());
    if (options_.timeline) timeline_.passes_of(value, passes);
    if (governor_ && shown()) add_work(passes, pinged);
  }
  return {};
}

// A device that is the host's processor does its work in the host's time, any other beside it.
void DiveView::add_work(std::span<const gpu::PassTime> passes, bool pinged) {
  double host_ms = 0.0, device_ms = 0.0;
  for (const gpu::PassTime& pass : passes) (pass.name == "record" ? host_ms : device_ms) += pass.ms;
  const bool one = session_.device().info().kind == "CPU";
  governor_->add(elapsed_s_ * 1e3, one ? host_ms + device_ms : std::max(host_ms, device_ms),
                 pinged);
}

Status DiveView::finish() {
  if (!in_flight_.empty()) {
    NERITIC_TRY_STATUS(session_.frames().wait(in_flight_.back().value));
    NERITIC_TRY_STATUS(collect_times(in_flight_.back().value));
  }
  return screenshots_.finish();
}

}  // namespace neritic::testbed
