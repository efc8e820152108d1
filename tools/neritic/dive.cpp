// `neritic dive SCENE`: the live program. A desktop window with a free camera, the scene's sonars
// and timings; or, with --headless, the same frames without a window and a summary of their times.
#include <algorithm>
#include <cmath>

#include "engine/core/log.hpp"
#include "engine/xr/desktop/desktop.hpp"
#include "engine/xr/offscreen.hpp"
#include "testbed/loop/dive_loop.hpp"
#include "testbed/sensors/validation.hpp"
#include "tools/common/outputs.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/dive_physics.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/load_scene.hpp"
#include "tools/neritic/step_files.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kFramesInFlight = 2;  // as Session's
constexpr double kHeadlessSeconds = 5.0;      // where neither --frames nor --seconds is given

Result<scene::Scene> load(const DiveFlags& flags) {
  NERITIC_TRY(scene::Scene scene, load_scene_or_model(flags.scene, flags.size));
  if (scene.cameras.empty()) {
    scene.cameras.push_back(camera_for(scene));
    if (!flags.size.empty()) {
      NERITIC_TRY(const auto size, parse_size("--size", flags.size));
      scene.cameras[0].width = size.first, scene.cameras[0].height = size.second;
    }
  }
  for (scene::Camera& camera : scene.cameras)
    camera.stereo_baseline_m = 0.0;  // one window, one eye
  return scene;
}

// The first camera and every sonar, or those named.
Status choose_sensors(const DiveFlags& flags, const scene::Scene& scene, DiveOptions& options) {
  std::string known;
  for (const scene::Camera& camera : scene.cameras) known += " " + camera.name;
  for (const scene::Sonar& sonar : scene.sonars) known += " " + sonar.name;
  const auto wanted = [&](const std::string& name) {
    return std::find(flags.sensors.begin(), flags.sensors.end(), name) != flags.sensors.end();
  };
  std::size_t found = 0;
  for (std::size_t i = scene.cameras.size(); i-- > 0;)
    if (wanted(scene.cameras[i].name)) options.camera = i, ++found;
  for (std::size_t i = 0; i < scene.sonars.size(); ++i) {
    const bool named = wanted(scene.sonars[i].name);
    if (flags.sensors.empty() || named) options.sonars.push_back(i);
    if (named) ++found;
  }
  if (found < flags.sensors.size())
    return bad_input("--sensor: {} found, {} has{}", fmt::join(flags.sensors, " "), flags.scene,
                     known);
  return {};
}

Result<std::unique_ptr<gpu::Device>> make_device(const DiveFlags& flags, const xr::Window* window) {
  gpu::DeviceOptions options;
  options.device = flags.device;
  options.validation = flags.validation;
  options.cache_folder = gpu::default_cache_folder();
  if (window) window->require(options);
  return gpu::Device::create(options);
}

Status dive_offscreen(const DiveFlags& flags, gpu::Device& device, Session& session,
                      DiveOptions options) {
  const scene::Camera& camera = session.scene().cameras[options.camera];
  const xr::OffscreenOptions offscreen{
      {xr::one_view(camera.width, camera.height, camera.vertical_fov_rad)},
      camera.rate_hz,
      flags.fast};
  if (options.frames == 0 && options.seconds == 0.0) options.seconds = kHeadlessSeconds;
  options.summary = true;
  NERITIC_TRY(const auto display, xr::OffscreenDisplay::create(device, offscreen));
  std::unique_ptr<xr::Overlay> overlay;
  if (flags.panels) {
    NERITIC_TRY(overlay, xr::Overlay::create(device, nullptr, 1));
  }
  Dive dive(device, session, *display, overlay.get(), options);
  NERITIC_TRY_STATUS(dive.run());
  fmt::print("{}, {} x {}\n{}", device.info().name, camera.width, camera.height,
             dive.times().summary(dive.frames_drawn(), dive.seconds()));
  if (options.physics)  // as a dive of the physics alone says it, to be held against it
    fmt::print("physics: {} steps, hash {:016x}\n", options.physics->newest().step,
               options.physics->newest().hash);
  return {};
}

Status dive_window(xr::Window& window, gpu::Device& device, Session& session, DiveOptions options) {
  const scene::Camera& camera = session.scene().cameras[options.camera];
  NERITIC_TRY(const auto display, xr::DesktopDisplay::create(
                                      device, window, {kFramesInFlight, camera.vertical_fov_rad}));
  NERITIC_TRY(const auto overlay, xr::Overlay::create(device, &window, window.content_scale()));
  options.may_close = true;
  Dive dive(device, session, *display, overlay.get(), options);
  return dive.run();
}

}  // namespace

Status run_dive(const DiveFlags& flags) {
  if (flags.seconds && !(std::isfinite(*flags.seconds) && *flags.seconds > 0.0))
    return bad_input("--seconds: {}; a number above 0 is accepted", *flags.seconds);
  if (flags.fast && !flags.headless)
    return bad_input("--fast: accepted with --headless (a window follows its screen)");
  if (flags.panels && !flags.headless)
    return bad_input("--panels: accepted with --headless (a window has them; F2)");
  NERITIC_TRY_STATUS(check_step_files(flags.files));
  NERITIC_TRY_STATUS(check_output_file("--screenshot", flags.screenshot));
  NERITIC_TRY(scene::Scene scene, load(flags));
  for (const std::string& note : scene.notes) log_warn("{}", note);
  NERITIC_TRY_STATUS(check_physics_flags(flags, scene));
  if (asks_for_physics_alone(flags, scene)) {
    const Interrupt interrupt;
    return dive_physics(flags, scene, interrupt);
  }
  DiveOptions options;
  std::unique_ptr<LivePhysics> physics;
  if (PhysicsWorld::needed(scene)) {
    using Pace = LivePhysics::Pace;
    NERITIC_TRY(physics,
                LivePhysics::create(scene, flags.headless ? Pace::kPicture : Pace::kClock));
    options.physics = physics.get();
  }
  options.frames = flags.frames;
  options.seconds = flags.seconds.value_or(0.0);
  options.screenshot = flags.screenshot;
  NERITIC_TRY_STATUS(choose_sensors(flags, scene, options));

  std::unique_ptr<xr::Window> window;
  const scene::Camera& camera = scene.cameras[options.camera];
  if (!flags.headless) {
    NERITIC_TRY(window,
                xr::Window::create({.title = "Neritic: " + scene.title,
                                    .width = camera.width,
                                    .height = camera.height,
                                    .actions = dive_actions(),
                                    .hint = "use --headless, or neritic render for pictures"}));
  }
  NERITIC_TRY(const auto device, make_device(flags, window.get()));
  NERITIC_TRY(const auto session, Session::create(*device, std::move(scene)));
  const Status status = window ? dive_window(*window, *device, *session, options)
                               : dive_offscreen(flags, *device, *session, options);
  if (!status.ok()) return status;
  return check_validation(*device);
}

}  // namespace neritic::tools
