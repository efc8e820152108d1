// `neritic dive SCENE`: the live program. A headset; else a desktop window with a free camera, the
// scene's sonars and timings; or, with --headless, the same frames without a window and a summary
// of their times.
#include <algorithm>

#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/sim/run_clock.hpp"
#include "engine/xr/desktop/desktop.hpp"
#include "engine/xr/desktop/mirrored_display.hpp"
#include "engine/xr/offscreen.hpp"
#include "engine/xr/openxr/headset.hpp"
#include "testbed/devices/devices.hpp"
#include "testbed/instruments/wrist_displays.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/output/recorded_images.hpp"
#include "testbed/sensors/sight_check.hpp"
#include "testbed/sensors/validation.hpp"
#include "testbed/view/bindings.hpp"
#include "testbed/view/dive_view.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/device_notes.hpp"
#include "tools/neritic/dive_flags.hpp"
#include "tools/neritic/dive_physics.hpp"
#include "tools/neritic/dive_served.hpp"
#include "tools/neritic/dive_told.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/hud_flags.hpp"
#include "tools/neritic/load_scene.hpp"
#include "tools/neritic/markers.hpp"
#include "tools/neritic/named_sensors.hpp"
#include "tools/neritic/recorded_scene.hpp"
#include "tools/neritic/recording_export.hpp"
#include "tools/neritic/step_files.hpp"
#include "tools/neritic/timeline_picture.hpp"
#include "tools/neritic/worn_scene.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kFramesInFlight = 2;  // as Session's
constexpr std::uint32_t kServedClients = 64;
constexpr double kHeadlessSeconds = 5.0;  // where neither --frames nor --seconds is given

// Not the strip of a scanning camera.
bool shows_a_person_around(const scene::Camera& camera) {
  const double aspect = static_cast<double>(camera.width) / camera.height;
  return aspect > 0.25 && aspect < 4.0;
}

// A camera to look from, and light to see by, where the scene has none.
Status add_view(const DiveFlags& flags, scene::Scene& scene) {
  if (!std::ranges::none_of(scene.cameras, shows_a_person_around)) return {};
  scene.cameras.insert(scene.cameras.begin(), camera_for(scene));
  if (!flags.size.empty()) {
    NERITIC_TRY(const auto size, parse_size("--size", flags.size));
    scene.cameras[0].width = size.first, scene.cameras[0].height = size.second;
  }
  // A scene made for sonars alone is dark.
  if (!scene.sun && scene.lamps.empty() && scene.model_lights.empty()) {
    scene.sun = scene::Sun{};
    scene.notes.push_back(flags.scene +
                          ": no light and no camera in the scene; the view adds a sun");
  }
  return {};
}

// Where the view begins, and the sonars that are wanted.
struct Chosen {
  std::size_t viewpoint = 0, camera = 0;  // the camera's lens and size
  std::vector<std::size_t> sonars;
};

// Every sonar, or those named: a panel shows each, and without panels the summary of times has its
// passes.
Result<Chosen> choose_sensors(const DiveFlags& flags, const scene::Scene& scene) {
  NERITIC_TRY(const NamedSensors named, named_sensors(flags.sensors, scene));
  Chosen chosen{flags.swim ? own_viewpoint(scene) : first_viewpoint(scene), 0, named.sonars};
  const bool camera_named = !flags.sensors.empty() && !named.cameras.empty();
  if (camera_named) chosen.viewpoint = named.cameras.front();  // cameras are the first viewpoints
  if (!flags.view.empty()) {
    NERITIC_TRY(chosen.viewpoint, viewpoint_named(flags.view, scene));
  }
  chosen.camera = viewpoints_of(scene)[chosen.viewpoint].camera;
  return chosen;
}

// Where the pictures go. In the order of creation: each uses those before it.
struct Screen {
  std::vector<xr::ActionDesc> actions;
  std::unique_ptr<xr::Window> window;  // of a dive on a desktop, or beside a headset
  std::unique_ptr<gpu::Device> device;
  std::unique_ptr<xr::Headset> headset;  // of a dive in one
  std::string no_headset;                // why there is none, where one was looked for
  ViewMemory memory;                     // of the last window
  std::unique_ptr<xr::Display> display;
  std::unique_ptr<xr::Overlay> overlay;

  xr::Display& shown_on() const { return display ? *display : *headset; }
  bool beside_headset() const { return headset && window; }
};

gpu::DeviceOptions device_options(const DiveFlags& flags) {
  gpu::DeviceOptions options;
  options.device = flags.device;
  options.validation = flags.validation;
  options.cache_folder = gpu::default_cache_folder();
  return options;
}

Status make_window(const DiveFlags& flags, const scene::Scene& scene, Screen& screen) {
  const Result<ViewMemory> memory = read_view_memory(view_memory_file());
  if (memory.ok())
    screen.memory = *memory;
  else
    log_warn("{}", memory.error().message);
  std::pair<std::uint32_t, std::uint32_t> size{screen.memory.width, screen.memory.height};
  if (!flags.size.empty()) {
    NERITIC_TRY(size, parse_size("--size", flags.size));
  }
  auto window = xr::Window::create({.title = "Neritic: " + scene.title,
                                    .width = size.first,
                                    .height = size.second,
                                    .actions = screen.actions,
                                    .hint = "use --headless, or neritic render for pictures"});
  if (!window.ok() && !screen.no_headset.empty())
    return failure(window.error().code, "no headset: {}; no window: {}", screen.no_headset,
                   window.error().message);
  NERITIC_TRY(screen.window, std::move(window));
  if (!screen.no_headset.empty()) log_warn("{}: the dive is in a window", screen.no_headset);
  return {};
}

// The device that a headset's runtime makes, and its session; the operator's window before the
// device, which has to show pictures in it.
Status start_headset(const DiveFlags& flags, const scene::Scene& scene, Screen& screen) {
  NERITIC_TRY(screen.headset, xr::Headset::connect({.room = scene.world_from_lab.has_value(),
                                                    .refresh_hz = flags.refresh_hz,
                                                    .actions = screen.actions,
                                                    .validation = flags.validation}));
  gpu::DeviceOptions options = device_options(flags);
  screen.headset->require(options);
  if (flags.operator_window) {
    if (const Status made = make_window(flags, scene, screen); !made.ok())
      return refusal("--operator", made.error().message,
                     "a desktop for a window, or no --operator");
    screen.window->require(options);
  }
  NERITIC_TRY(screen.device, gpu::Device::create(options));
  return screen.headset->attach(*screen.device);
}

// The headset where one is asked for, or is there. Without --display openxr one that shows nothing
// (no runtime, or none of its formats can be drawn) leaves the dive to a window.
Status find_headset(const DiveFlags& flags, const scene::Scene& scene, Screen& screen) {
  screen.actions = dive_actions();
  if (!flags.bindings.empty()) {
    NERITIC_TRY(screen.actions, bound_actions(screen.actions, flags.bindings));
  }
  if (flags.headless || flags.display == "window") return {};
  const Status started = start_headset(flags, scene, screen);
  if (started.ok()) return {};
  if (flags.display == "openxr" || started.error().code == ErrorCode::kBadInput) return started;
  screen.headset.reset();
  screen.device.reset();
  screen.window.reset();
  screen.no_headset = started.error().message;
  return {};
}

// A headset brings its own.
Status make_device(const DiveFlags& flags, const scene::Scene& scene, Screen& screen) {
  if (screen.headset) return {};
  gpu::DeviceOptions options = device_options(flags);
  if (!flags.headless) {
    NERITIC_TRY_STATUS(make_window(flags, scene, screen));
    screen.window->require(options);
  }
  NERITIC_TRY(screen.device, gpu::Device::create(options));
  return {};
}

Status make_display(const DiveFlags& flags, const scene::Camera& camera, Screen& screen) {
  gpu::Device& device = *screen.device;
  if (screen.window) {
    xr::Window& window = *screen.window;
    NERITIC_TRY(auto desktop,
                xr::make_desktop(device, window, {kFramesInFlight, camera.vertical_fov_rad}));
    if (screen.headset)
      screen.display = std::make_unique<xr::MirroredDisplay>(*screen.headset, std::move(desktop));
    else
      screen.display = std::move(desktop);
    NERITIC_TRY(screen.overlay, xr::Overlay::create(device, &window, window.content_scale()));
    return {};
  }
  if (screen.headset) return {};
  const xr::OffscreenOptions options{
      {xr::one_view(camera.width, camera.height, camera.vertical_fov_rad)}};
  NERITIC_TRY(screen.display, xr::OffscreenDisplay::create(device, options));
  if (flags.panels) {
    NERITIC_TRY(screen.overlay, xr::Overlay::create(device, nullptr, 1));
  }
  return {};
}

// Where a diver looks for them; without panels nowhere.
std::string unasked_hud(const Screen& screen) {
  if (screen.headset) return "wrist";
  return screen.overlay ? "corner" : "";
}

// Whether quality comes down for a display's rate.
bool governed(const DiveFlags& flags) {
  return flags.quality.empty() ? !flags.headless : flags.quality != "full";
}

// 20 pictures a second in software, with room for what a governor lets pass
// (testbed/view/quality_governor.cpp).
double least_budget_ms(const Screen& screen) {
  constexpr double kSoftware_ms = 46.0;
  return screen.device->info().kind == "CPU" ? kSoftware_ms : 0.0;
}

// The run's state and recording by key.
std::optional<RunKeeperOptions> kept_by_key(const DiveFlags& flags,
                                            const RecordingOptions& recording,
                                            const std::vector<xr::ActionDesc>& actions) {
  if (flags.headless || !flags.replay.empty()) return {};
  const StepFileFlags& files = flags.files;
  const char* const written = !files.record.empty() ? "--record"
                              : !files.log.empty()  ? "--log"
                              : !files.plot.empty() ? "--plot"
                                                    : "";
  return RunKeeperOptions{
      .name = fs::path(flags.scene).stem().string(),
      .scene = recording,
      .recording = files.record,
      .no_way_back =
          *written ? fmt::format("{} writes this run, which cannot go back", written) : "",
      .actions = actions};
}

// On standard output: a dive's end, the same as without pictures; without a window the times too.
void tell(const DiveFlags& flags, const gpu::Device& device, const scene::Camera& camera,
          const DiveView& view, const Loop& loop, const LivePhysics* physics,
          const DiveRecorder* recorder, const Devices* devices) {
  const std::vector<DeviceHealth> health =
      devices ? devices->health() : std::vector<DeviceHealth>();
  if (flags.json)
    return print_summary(flags, physics->world(), physics->simulation(), *recorder,
                         {loop.wall_s(), physics->counts().dropped, health});
  if (flags.quiet) return;
  if (flags.headless)
    fmt::print("{}, {} x {}\n{}", device.info().name, camera.width, camera.height,
               view.times().summary(loop.frames(), loop.wall_s()));
  else
    fmt::print("{} frames in {:.1f} s on {}\n", loop.frames(), loop.wall_s(), device.info().name);
  if (physics)
    print_summary(flags, physics->world(), physics->simulation(), *recorder,
                  {loop.wall_s(), physics->counts().dropped, health});
}

// The window's size where it has one, and its panels, for the next time. A folder that cannot be
// written is no reason to fail a dive.
void keep_memory(const DiveFlags& flags, const Screen& screen, const DiveView& view) {
  auto memory = view.memory();
  if (!screen.window || !memory || !flags.task.empty()) return;
  if (flags.size.empty() && screen.window->width() > 0 && screen.window->height() > 0) {
    memory->width = screen.window->width();
    memory->height = screen.window->height();
  }
  if (*memory == screen.memory) return;
  if (const Status kept = write_view_memory(view_memory_file(), *memory); !kept.ok())
    log_warn("{}", kept.error().message);
}

// worn: the scene's text if a wearer was added. physics_scene: the one whose physics runs, if it is
// not the one that is shown.
Status dive_pictures(const DiveFlags& flags, scene::Scene scene, const std::string& worn,
                     const std::optional<scene::Scene>& physics_scene,
                     std::optional<SampleLog> recorded, Screen screen, const Interrupt& interrupt) {
  // A run that a person at a screen may stop and speed up.
  sim::HostClock host;
  sim::RunClock run(host);
  sim::RunClock* const clock = flags.headless ? nullptr : &run;
  std::unique_ptr<LivePhysics> physics;
  std::unique_ptr<Replay> replay;
  const scene::Scene& run_scene = physics_scene ? *physics_scene : scene;
  if (PhysicsWorld::needed(run_scene)) {
    // A recording is exact where its samples enter before the same step: in lock-step.
    using Pace = LivePhysics::Pace;
    const bool lock_step = flags.headless || !flags.replay.empty();
    NERITIC_TRY(physics, make_dive_physics(flags, run_scene, recorded ? &*recorded : nullptr,
                                           lock_step ? Pace::kPicture : Pace::kClock, clock));
  }
  if (physics && recorded) {
    NERITIC_TRY(replay, Replay::of(std::move(*recorded), flags.replay, physics->world()));
  }
  RecordingOptions recording;
  if (physics && !replay && (!flags.headless || !flags.files.record.empty())) {
    NERITIC_TRY(recording, recording_options(scene.path, !flags.fast));
    if (!worn.empty()) recording.scene_text = worn;
  }
  NERITIC_TRY(const Chosen chosen, choose_sensors(flags, scene));
  const scene::Camera camera = scene.cameras[chosen.camera];
  NERITIC_TRY_STATUS(make_device(flags, scene, screen));
  const hud::Units units = flags.units == "imperial" ? hud::Units::kImperial : hud::Units::kMetric;
  const auto displays = wrist_displays(physics.get(), units);
  NERITIC_TRY(const auto session,
              Session::create(*screen.device, std::move(scene), picture_places(displays.get())));
  NERITIC_TRY_STATUS(make_display(flags, camera, screen));
  if (physics) physics->hasten_steps(true);
  std::unique_ptr<Devices> devices;
  if (physics && !replay) {
    NERITIC_TRY(devices, Devices::open(session->scene(), physics->world(), physics->inbox(),
                                       DeviceSource::Pace::kThread));
    recording.signals = devices->signals();
  }
  NERITIC_TRY(const auto hud, hud_options(flags, physics.get(), unasked_hud(screen)));
  if (hud && !screen.headset && !fit_one_window(hud->layouts))
    return refusal("--hud", fmt::format("'{}' in a window", flags.hud),
                   "console alone, which shows all of the others, or any of corner, mask, wrist");
  NERITIC_TRY(
      const auto view,
      DiveView::create(
          *session, screen.shown_on(), screen.overlay.get(), physics.get(),
          {.actions = screen.actions,
           .viewpoint = chosen.viewpoint,
           .sonars = chosen.sonars,
           .summary = flags.headless,
           .screenshot = flags.screenshot,
           .may_fly = !replay,
           .hud = hud,
           .governed = governed(flags),
           .least_budget_ms = least_budget_ms(screen),
           .clock = clock,
           .frame_s = 1.0 / camera.rate_hz,
           .timeline = !flags.timeline.empty(),
           .overlap = flags.fast,
           .keep = kept_by_key(flags, recording, screen.actions),
           .no_keys_for_files = replay ? "a replay is neither saved nor recorded"
                                       : "nothing moves by physics: there is no state to save",
           .nobody_to_steer =
               replay ? "a replay is not steered"
                      : "nobody here is steered: begin with --swim to be a diver in this scene",
           .no_instruments =
               replay ? "nobody in this recording dives by physics: there are no instruments"
                      : "nobody here dives by physics: begin with --swim to have instruments",
           .memory = screen.memory,
           .devices = devices.get(),
           .beside_headset = screen.beside_headset(),
           .swim = flags.swim && screen.window && !screen.headset,
           .units = units,
           .task = flags.task}));
  std::unique_ptr<ServedDive> served;
  if (!flags.serve.empty()) {
    NERITIC_TRY(const ServerOptions options,
                server_options("--serve", flags.serve, flags.keys, kServedClients));
    NERITIC_TRY(served, ServedDive::start(options, *physics, session->scene(), devices.get()));
  }
  std::vector<ImageConsumer::Wish> wishes;
  for (const std::string& stream : flags.record_images) wishes.push_back({stream});
  NERITIC_TRY_STATUS(ImageConsumer::check(session->scene(), wishes));
  // After all that may refuse: an older file of their names is moved away.
  std::optional<StepFiles> files;
  std::vector<StepSink*> step_sinks;
  std::vector<SampleSource*> sources{&view->pilot()};
  if (view->wearer()) sources.push_back(view->wearer());
  if (physics) {
    files.emplace(flags.files, session->scene().title, recording, *physics);
    step_sinks = files->sinks();
  }
  if (view->recorder()) step_sinks.push_back(view->recorder());
  std::optional<DeviceNotes> device_notes;
  if (devices) step_sinks.push_back(&device_notes.emplace(*devices));
  std::unique_ptr<Markers> markers;
  if (!flags.markers.empty()) {
    NERITIC_TRY(markers, Markers::open(flags.markers, files ? files->recording() : nullptr));
    step_sinks.push_back(markers.get());
    if (!flags.quiet && !flags.json) fmt::print("{}\n", markers->words());
  }
  if (replay) {
    step_sinks.push_back(&replay->check);
    sources.push_back(&replay->source);
  }
  if (served) {
    step_sinks.push_back(&served->link());
    sources.push_back(&served->link());
    if (!flags.quiet && !flags.json) {
      fmt::print("{} at {}, {}\n", session->scene().title, to_text(served->address()),
                 flags.keys.empty() ? "for this machine alone" : "for clients with a key");
      std::fflush(stdout);  // programs wait for this line
    }
  }
  std::optional<RecordedImages> images;
  std::optional<ImageConsumer> image_consumer;
  std::vector<ImageConsumer*> consumers;
  if (!flags.record_images.empty()) {
    RecordingFile* file = files ? files->recording() : nullptr;
    if (!file)
      return refusal("--record-images", "no --record beside it", "with --record FILE.mcap");
    images.emplace(file->out(), [file] { return file->ready(); });
    NERITIC_TRY(image_consumer, ImageConsumer::create(session->scene(), wishes, *images));
    consumers.push_back(&*image_consumer);
  }
  if (served) consumers.push_back(served->images());
  const double start_s = physics ? physics->newest().time_s : 0.0, period_s = 1.0 / camera.rate_hz;
  SightCheck sight(*session, physics ? &physics->motion() : nullptr,
                   [](const std::string& line) { log_warn("{}", line); });
  NERITIC_TRY_STATUS(sight.look(start_s, {chosen.camera}, chosen.sonars));
  const bool limited = flags.frames > 0 || flags.seconds || replay;
  const double unlimited_s = limited || !flags.headless ? 0.0 : kHeadlessSeconds;
  const double recorded_s = replay ? replay->seconds() : 0.0;
  Loop loop({.clock = flags.fast ? Clock::simulated(start_s, period_s)
                                 : Clock::real(start_s, period_s, Clock::Frames::kPictures, clock),
             .physics = physics.get(),
             .sensors = LoopSensors{.session = session.get(),
                                    .sonars = chosen.sonars,
                                    .capture = kColorOnGpu,
                                    .own_rates = true,
                                    .consumers = consumers},
             .view = view.get(),
             .pictures = displays.get(),
             .sources = sources,
             .step_sinks = step_sinks,
             .stop = {.frames = flags.frames,
                      .seconds = replay ? recorded_s : flags.seconds.value_or(unlimited_s),
                      .interrupted = [&] { return interrupt.requested(); }}});
  const Status status = loop.run();
  keep_memory(flags, screen, *view);
  // A run that failed prints its summary too, but a replay that did not begin has none.
  if (replay && !status.ok() && replay->check.equal_steps() == 0) return status;
  if (replay && !flags.quiet && !flags.json) replay->tell();
  tell(flags, *screen.device, camera, *view, loop, physics.get(),
       files ? &files->recorder() : nullptr, devices.get());
  if (served)
    if (const std::string missed = served->missed_words(); !missed.empty()) log_warn("{}", missed);
  NERITIC_TRY_STATUS(status);
  if (!flags.timeline.empty())
    NERITIC_TRY_STATUS(write_timeline(
        flags.timeline,
        fmt::format("Frames of {}, {}", session->scene().title, screen.device->info().name),
        view->budget_ms(), view->timeline()));
  if (loop.interrupted())
    return failure(ErrorCode::kInterrupted,
                   "interrupted after {:.4g} s; everything up to then is written", loop.wall_s());
  if (screen.headset && !screen.headset->validation_messages().empty())
    return failure(ErrorCode::kInternal, "OpenXR validation: {}",
                   screen.headset->validation_messages().front());
  NERITIC_TRY_STATUS(check_validation(*screen.device));
  const bool whole = physics && !replay && flags.seconds &&
                     physics->newest().time_s >= start_s + *flags.seconds - 1e-6;
  return whole ? check_finished(flags, *physics, files->recorder()) : Status();
}

// With every flag but the form of the recording as it is.
Status run_whole_dive(const DiveFlags& asked) {
  DiveFlags flags = asked;
  NERITIC_TRY_STATUS(check_dive_flags(flags));
  NERITIC_TRY_STATUS(check_step_files(
      flags.files, {{"--screenshot", flags.screenshot}, {"--timeline", flags.timeline}}));
  const Interrupt interrupt;
  std::optional<SampleLog> recorded;
  if (!flags.replay.empty()) {
    NERITIC_TRY(recorded, read_recording(flags.replay));
  } else if (flags.scene.empty()) {
    return refusal("SCENE", "none", "a scene or model file, or --replay with a recording");
  }
  NERITIC_TRY(scene::Scene scene,
              recorded ? recorded_scene(*recorded, flags.replay, flags.scene, flags.size)
                       : load_scene_or_model(flags.scene, flags.size));
  if (flags.scene.empty()) flags.scene = scene.path;
  Screen screen;
  NERITIC_TRY_STATUS(find_headset(flags, scene, screen));
  // A person in the sea is a diver, also where the scene has none.
  const bool worn_headset = screen.headset && !is_model(scene);
  std::string worn;
  if (!recorded && !has_diver(scene) && (flags.swim || worn_headset)) {
    NERITIC_TRY(WornScene with, with_wearer(scene, flags.size));
    scene = std::move(with.scene), worn = std::move(with.text);
  }
  if (flags.seed) scene.seed = *flags.seed;
  NERITIC_TRY_STATUS(check_physics_flags(flags, scene));
  const bool pictures = !asks_for_physics_alone(flags, scene);
  NERITIC_TRY_STATUS(check_serve_flags(flags, scene, pictures));
  std::optional<scene::Scene> physics_scene;
  const ShownChanges changes{flags.shown, flags.added, flags.water};
  if (changes.any()) {
    NERITIC_TRY(scene::Scene shown,
                shown_scene(*recorded, flags.replay, asked.scene, flags.size, changes, scene));
    physics_scene = std::exchange(scene, std::move(shown));
  }
  if (pictures) NERITIC_TRY_STATUS(add_view(flags, scene));
  for (const std::string& note : scene.notes) log_warn("{}", note);
  return pictures ? dive_pictures(flags, std::move(scene), worn, physics_scene, std::move(recorded),
                                  std::move(screen), interrupt)
                  : dive_physics(flags, scene, std::move(recorded), interrupt);
}

}  // namespace

// An .xdf is made at the end of the recording beside it, which alone survives a crash.
Status run_dive(const DiveFlags& asked) {
  const fs::path xdf = asked.files.record;
  if (xdf.extension() != ".xdf") return run_whole_dive(asked);
  NERITIC_TRY_STATUS(check_output_file("--record", xdf.string()));
  DiveFlags flags = asked;
  const fs::path recording = fs::path(xdf).replace_extension(".mcap");
  flags.files.record = recording.string();
  std::error_code none;
  const auto before = fs::last_write_time(recording, none);
  const Status status = run_whole_dive(flags);
  if (fs::last_write_time(recording, none) == before) return status;  // nothing was recorded
  const Status written = write_xdf(recording, xdf);
  return status.ok() ? written : status;
}

}  // namespace neritic::tools
