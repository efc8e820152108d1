// `neritic dive SCENE`: the live program. A desktop window with a free camera, the scene's sonars
// and timings; or, with --headless, the same frames without a window and a summary of their times.
#include <cmath>

#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/xr/desktop/desktop.hpp"
#include "engine/xr/offscreen.hpp"
#include "testbed/loop/dive_view.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/sensors/validation.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/dive_physics.hpp"
#include "tools/neritic/dive_told.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/load_scene.hpp"
#include "tools/neritic/named_sensors.hpp"
#include "tools/neritic/step_files.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kFramesInFlight = 2;  // as Session's
constexpr double kHeadlessSeconds = 5.0;      // where neither --frames nor --seconds is given

Result<scene::Scene> load(const DiveFlags& flags) {
  NERITIC_TRY(scene::Scene scene, load_scene_or_model(flags.scene, flags.size));
  if (flags.seed) scene.seed = *flags.seed;
  if (scene.cameras.empty()) {
    scene.cameras.push_back(camera_for(scene));
    if (!flags.size.empty()) {
      NERITIC_TRY(const auto size, parse_size("--size", flags.size));
      scene.cameras[0].width = size.first, scene.cameras[0].height = size.second;
    }
  }
  return scene;
}

// The camera where the view begins, and the sonars that are wanted.
struct Chosen {
  std::size_t camera = 0;
  std::vector<std::size_t> sonars;
};

// The first camera and every sonar, or those named: a panel shows each sonar, and without panels
// the summary of times has its passes.
Result<Chosen> choose_sensors(const DiveFlags& flags, const scene::Scene& scene) {
  NERITIC_TRY(const NamedSensors named, named_sensors(flags.sensors, scene));
  return Chosen{named.cameras.empty() ? 0 : named.cameras.front(), named.sonars};
}

// Where the pictures go. In the order of creation: each uses those before it.
struct Screen {
  std::unique_ptr<xr::Window> window;  // not with --headless
  std::unique_ptr<gpu::Device> device;
  std::unique_ptr<xr::Display> display;
  std::unique_ptr<xr::Overlay> overlay;
};

Status make_device(const DiveFlags& flags, const scene::Scene& scene, const scene::Camera& camera,
                   Screen& screen) {
  gpu::DeviceOptions options;
  options.device = flags.device;
  options.validation = flags.validation;
  options.cache_folder = gpu::default_cache_folder();
  if (!flags.headless) {
    NERITIC_TRY(screen.window,
                xr::Window::create({.title = "Neritic: " + scene.title,
                                    .width = camera.width,
                                    .height = camera.height,
                                    .actions = dive_actions(),
                                    .hint = "use --headless, or neritic render for pictures"}));
    screen.window->require(options);
  }
  NERITIC_TRY(screen.device, gpu::Device::create(options));
  return {};
}

Status make_display(const DiveFlags& flags, const scene::Camera& camera, Screen& screen) {
  gpu::Device& device = *screen.device;
  if (screen.window) {
    xr::Window& window = *screen.window;
    NERITIC_TRY(screen.display, xr::DesktopDisplay::create(
                                    device, window, {kFramesInFlight, camera.vertical_fov_rad}));
    NERITIC_TRY(screen.overlay, xr::Overlay::create(device, &window, window.content_scale()));
    return {};
  }
  const xr::OffscreenOptions options{
      {xr::one_view(camera.width, camera.height, camera.vertical_fov_rad)}};
  NERITIC_TRY(screen.display, xr::OffscreenDisplay::create(device, options));
  if (flags.panels) {
    NERITIC_TRY(screen.overlay, xr::Overlay::create(device, nullptr, 1));
  }
  return {};
}

// On standard output. A window says nothing but what --json asks for.
void tell(const DiveFlags& flags, const gpu::Device& device, const scene::Camera& camera,
          const DiveView& view, const Loop& loop, const LivePhysics* physics,
          const DiveRecorder* recorder, double start_s) {
  if (flags.json)
    return print_summary(flags, physics->world(), physics->simulation(), *recorder,
                         {loop.wall_s(), physics->counts().dropped, start_s});
  if (!flags.headless || flags.quiet) return;
  fmt::print("{}, {} x {}\n{}", device.info().name, camera.width, camera.height,
             view.times().summary(loop.frames(), loop.wall_s()));
  if (physics)  // in the words of a dive without pictures, to be compared with it
    fmt::print("physics: {} steps, hash {:016x}\n", physics->newest().step, physics->newest().hash);
}

Status dive_pictures(const DiveFlags& flags, scene::Scene scene, const Interrupt& interrupt) {
  std::unique_ptr<LivePhysics> physics;
  std::unique_ptr<Replay> replay;
  if (PhysicsWorld::needed(scene)) {
    // A recording is exact where its samples enter before the same step: in lock-step.
    using Pace = LivePhysics::Pace;
    const bool lock_step = flags.headless || !flags.replay.empty();
    NERITIC_TRY(physics,
                make_dive_physics(flags, scene, lock_step ? Pace::kPicture : Pace::kClock));
  }
  if (physics && !flags.replay.empty()) {
    NERITIC_TRY(replay, Replay::read(flags.replay, physics->world()));
  }
  NERITIC_TRY(const Chosen chosen, choose_sensors(flags, scene));
  const scene::Camera camera = scene.cameras[chosen.camera];
  Screen screen;
  NERITIC_TRY_STATUS(make_device(flags, scene, camera, screen));
  NERITIC_TRY(const auto session, Session::create(*screen.device, std::move(scene)));
  NERITIC_TRY_STATUS(make_display(flags, camera, screen));
  NERITIC_TRY(const auto view,
              DiveView::create(*session, *screen.display, screen.overlay.get(), physics.get(),
                               {.camera = chosen.camera,
                                .sonars = chosen.sonars,
                                .summary = flags.headless,
                                .screenshot = flags.screenshot,
                                .may_close = !flags.headless,
                                .may_fly = !replay}));
  std::optional<StepFiles> files;
  std::vector<StepSink*> step_sinks;
  std::vector<SampleSource*> sources{&view->pilot()};
  if (physics) {
    files.emplace(flags.files, session->scene().title, *physics);
    step_sinks = files->sinks();
  }
  if (replay) {
    step_sinks.push_back(&replay->check);
    sources.push_back(&replay->source);
  }
  const double start_s = physics ? physics->newest().time_s : 0.0, period_s = 1.0 / camera.rate_hz;
  const bool limited = flags.frames > 0 || flags.seconds || replay;
  const double unlimited_s = limited || !flags.headless ? 0.0 : kHeadlessSeconds;
  const double recorded_s = replay ? replay->seconds() : 0.0;
  Loop loop({.clock = flags.fast ? Clock::simulated(start_s, period_s)
                                 : Clock::real(start_s, period_s, 1),
             .physics = physics.get(),
             .sensors = LoopSensors{.session = session.get(),
                                    .sonars = chosen.sonars,
                                    .capture = kColorOnGpu,
                                    .own_rates = true},
             .view = view.get(),
             .sources = sources,
             .step_sinks = step_sinks,
             .stop = {.frames = flags.frames,
                      .seconds = replay ? recorded_s : flags.seconds.value_or(unlimited_s),
                      .interrupted = [&] { return interrupt.requested(); }}});
  const Status status = loop.run();
  // A run that failed prints its summary too.
  if (replay && !flags.quiet) replay->tell();
  tell(flags, *screen.device, camera, *view, loop, physics.get(),
       files ? &files->recorder() : nullptr, start_s);
  NERITIC_TRY_STATUS(status);
  if (loop.interrupted())
    return failure(ErrorCode::kInterrupted, "interrupted after {:.4g} s; all until then is written",
                   loop.wall_s());
  return check_validation(*screen.device);
}

}  // namespace

Status run_dive(const DiveFlags& flags) {
  if (flags.seconds && !(std::isfinite(*flags.seconds) && *flags.seconds > 0.0))
    return refusal("--seconds", fmt::format("{}", *flags.seconds), "a number above 0");
  if (flags.fast && !flags.headless)
    return refusal("--fast", "a run in a window", "with --headless (a window follows its screen)");
  if (flags.panels && !flags.headless)
    return refusal("--panels", "a run in a window", "with --headless (a window has them; F2)");
  NERITIC_TRY_STATUS(check_step_files(flags.files, {"--screenshot", flags.screenshot}));
  const Interrupt interrupt;
  NERITIC_TRY(scene::Scene scene, load(flags));
  for (const std::string& note : scene.notes) log_warn("{}", note);
  NERITIC_TRY_STATUS(check_physics_flags(flags, scene));
  return asks_for_physics_alone(flags, scene) ? dive_physics(flags, scene, interrupt)
                                              : dive_pictures(flags, std::move(scene), interrupt);
}

}  // namespace neritic::tools
