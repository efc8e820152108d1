// `neritic render SCENE --out DIR`: offscreen pictures and sensor data of a scene or a model.
#include <algorithm>
#include <cmath>
#include <set>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "engine/core/log.hpp"
#include "engine/render/water_optics.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/output/output.hpp"
#include "testbed/output/survey.hpp"
#include "testbed/sensors/ping_schedule.hpp"
#include "testbed/sensors/session.hpp"
#include "testbed/sensors/sonar_check.hpp"
#include "testbed/sensors/validation.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/interrupt.hpp"
#include "tools/neritic/load_scene.hpp"
#include "tools/neritic/render_sheet.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

namespace fs = std::filesystem;

constexpr double kLongestFlight_s = 24.0 * 3600.0;  // of physics, from time 0 on

// Thirty years: frames are still told apart to a tenth of a microsecond.
constexpr double kLatestTime_s = 1e9;

Result<scene::Scene> load(const RenderFlags& flags) {
  scene::SceneOptions options;
  if (!flags.offset_m.empty()) {
    options.offset_m = {flags.offset_m[0], flags.offset_m[1], flags.offset_m[2]};
    // As positions in files. A comparison that a NaN fails.
    const Vec3 far = glm::abs(options.offset_m);
    if (!(std::max({far.x, far.y, far.z}) <= scene::kFarthest_m) || !is_finite(options.offset_m))
      return bad_input(
          "--offset: {:g} {:g} {:g}; three numbers of -{:g} to {:g} metres are accepted",
          options.offset_m.x, options.offset_m.y, options.offset_m.z, scene::kFarthest_m,
          scene::kFarthest_m);
  }
  NERITIC_TRY(scene::Scene scene, load_scene_or_model(flags.scene, flags.size, options));
  if (!flags.quality.empty())
    for (scene::Sonar& sonar : scene.sonars) {
      sonar.quality = flags.quality;
      sonar.max_error = 0.0;
    }
  if (flags.water.empty()) return scene;
  if (!scene.water) return bad_input("--water {}: {} names no water", flags.water, flags.scene);
  // The types are written in capitals; a flag may be typed in any.
  std::string type = flags.water;
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (const auto known = render::jerlov_optics(type); !known.ok())
    return bad_input("--water: {}", known.error().message);
  scene.water->type = type;
  return scene;
}

bool wanted(const RenderFlags& flags, const std::string& name) {
  return flags.sensors.empty() ||
         std::find(flags.sensors.begin(), flags.sensors.end(), name) != flags.sensors.end();
}

Result<FrameRequest> request_of(const RenderFlags& flags, const scene::Scene& scene) {
  FrameRequest request;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    known.push_back(scene.cameras[i].name);
    if (wanted(flags, known.back())) request.cameras.push_back(i);
  }
  for (std::size_t i = 0; i < scene.sonars.size(); ++i) {
    known.push_back(scene.sonars[i].name);
    if (!wanted(flags, known.back())) continue;
    NERITIC_TRY_STATUS(check_sonar(scene, scene.sonars[i]));
    request.sonars.push_back(i);
  }
  for (const std::string& name : flags.sensors)
    if (std::find(known.begin(), known.end(), name) == known.end())
      return bad_input("--sensor {}: not in {}, which has {}", name, flags.scene,
                       known.empty() ? "no sensors" : fmt::format("{}", fmt::join(known, ", ")));
  if (request.cameras.empty() && request.sonars.empty())
    return bad_input("{}: no camera and no sonar, so there is nothing to render", flags.scene);
  return request;
}

// Of the cameras, then the sonars of a request.
std::vector<double> rates_of(const scene::Scene& scene, const FrameRequest& request) {
  std::vector<double> rates_hz;
  for (const std::size_t i : request.cameras) rates_hz.push_back(scene.cameras[i].rate_hz);
  for (const std::size_t i : request.sonars) rates_hz.push_back(scene.sonars[i].rate_hz);
  return rates_hz;
}

// What of all sensors is due; schedule is of rates_of(all).
void take_due(PingSchedule& schedule, const FrameRequest& all, FrameRequest& request) {
  request.cameras.clear();
  request.sonars.clear();
  request.pings.clear();
  for (const PingSchedule::Due& due : schedule.due(request.time_s)) {
    if (due.sensor < all.cameras.size()) {
      request.cameras.push_back(all.cameras[due.sensor]);
    } else {
      request.sonars.push_back(all.sonars[due.sensor - all.cameras.size()]);
      request.pings.push_back(due.number);
    }
  }
}

// A sonar cannot ping again before its farthest echo is back.
void warn_of_rates(const scene::Scene& scene, const FrameRequest& request, double ping_hz) {
  constexpr double kSoundSpeed_m_s = 1500.0;  // near enough for a warning
  for (const std::size_t i : request.sonars) {
    const scene::Sonar& sonar = scene.sonars[i];
    const double most_hz = kSoundSpeed_m_s / (2.0 * sonar.range_max_m);
    const double rate_hz = ping_hz > 0.0 ? ping_hz : sonar.rate_hz;
    if (rate_hz > 1.01 * most_hz)
      log_warn("sonar {}: {:.3g} pings a second, but echoes from {:g} m allow {:.3g}", sonar.name,
               rate_hz, sonar.range_max_m, most_hz);
  }
}

// Appends the folders that were written to.
Status write_frame(const fs::path& folder, const FrameResult& result, const FrameFacts& facts,
                   std::set<fs::path>& written) {
  for (const CameraFrame& camera : result.cameras)
    for (std::size_t e = 0; e < camera.eyes.size(); ++e) {
      const std::string name =
          camera.eyes.size() == 1 ? camera.name : camera.name + (e == 0 ? "_left" : "_right");
      NERITIC_TRY_STATUS(write_view(folder / name, camera.eyes[e], facts));
      written.insert(folder / name);
    }
  for (const SonarFrame& sonar : result.sonars) {
    NERITIC_TRY_STATUS(write_sonar_frame(folder / sonar_folder(sonar), sonar, facts));
    written.insert(folder / sonar.name);
  }
  return {};
}

// The scene's physics, stepped to the first frame; nullptr where nothing moves by physics.
Result<std::unique_ptr<LivePhysics>> start_physics(const scene::Scene& scene, double first_s,
                                                   double last_s) {
  if (!PhysicsWorld::needed(scene)) return std::unique_ptr<LivePhysics>();
  if (!(last_s <= kLongestFlight_s))
    return bad_input("{}: physics to {:g} s of scene time; at most {:g} s are accepted", scene.path,
                     last_s, kLongestFlight_s);
  const TimeNs begun_ns = now_ns();
  NERITIC_TRY(auto physics, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  const auto counts = physics->world().solid().counts();
  log_info(
      "physics: {} solid things of {} triangles built in {:.0f} ms; {} vehicles and {} divers move",
      counts.things, counts.triangles, to_ms(now_ns() - begun_ns),
      physics->world().vehicles().size(), physics->world().humans().size());
  Progress progress("second of the dive", static_cast<std::uint64_t>(std::max(first_s, 0.0)));
  physics->reach(first_s, [&] { progress.step(); });
  return physics;
}

Status dump_graph(const RenderFlags& flags, const Session& session) {
  if (flags.dump_graph == "-") {
    fmt::print("{}", session.plan_text());
    return {};
  }
  const bool dot = fs::path(flags.dump_graph).extension() == ".dot";
  return write_text(flags.dump_graph, dot ? session.plan_graphviz() : session.plan_text());
}

// What an earlier run left in the folder stays; say so where it could be taken for this one's.
void warn_of_leftovers(const RenderFlags& flags, bool wrote_track,
                       const std::set<fs::path>& written) {
  const fs::path out = flags.out;
  std::error_code ignored;
  std::set<std::string> earlier;  // sensors' folders
  for (std::uint32_t i = 0; i < flags.frames && !flags.track_only; ++i)
    for (const auto& entry : fs::directory_iterator(out / frame_folder(i), ignored))
      if (entry.is_directory(ignored) && !written.contains(entry.path()))
        earlier.insert(entry.path().filename().string());
  // With rates of their own sensors skip frames: what they wrote to others is this run's.
  for (const fs::path& folder : written) earlier.erase(folder.filename().string());
  if (!earlier.empty())
    log_warn("{}: {} in the frames' folders {} an earlier run's", flags.out,
             fmt::join(earlier, ", "), earlier.size() == 1 ? "is" : "are");
  const bool more = fs::is_directory(out / frame_folder(flags.frames), ignored);
  if (!flags.track_only && more)
    log_warn("{}: {} and what follows are an earlier run's", flags.out, frame_folder(flags.frames));
  if (!flags.sheet && fs::is_regular_file(out / "sheet.png", ignored))
    log_warn("{}: sheet.png is an earlier run's", flags.out);
  if (!wrote_track && fs::is_directory(out / "track", ignored))
    log_warn("{}: track is an earlier run's", flags.out);
}

// "out: frame_0000 to 0029 of rov_camera, rov_sonar; track; sheet.png shows all at one glance".
std::string summary(const RenderFlags& flags, const scene::Scene& scene,
                    const FrameRequest& request, bool wrote_track) {
  std::vector<std::string> names, parts;
  for (const std::size_t i : request.cameras) names.push_back(scene.cameras[i].name);
  for (const std::size_t i : request.sonars) names.push_back(scene.sonars[i].name);
  const std::string last = flags.frames > 1 ? fmt::format(" to {:04}", flags.frames - 1) : "";
  if (!flags.track_only)
    parts.push_back(fmt::format("frame_0000{} of {}", last, fmt::join(names, ", ")));
  if (wrote_track) parts.push_back("track");
  if (flags.sheet) parts.push_back("sheet.png shows all at one glance");
  return fmt::format("{}: {}", flags.out, fmt::join(parts, "; "));
}

// Of a run that the user stopped after so many frames.
Error stopped_render(const RenderFlags& flags, std::uint32_t frames, double step_s,
                     bool wrote_track) {
  std::string there;
  if (!flags.track_only)
    there += fmt::format(" as {} to {}", frame_folder(0), frame_folder(frames - 1));
  if (wrote_track)
    there += fmt::format("{}track, of these frames", there.empty() ? " as " : " and ");
  return {ErrorCode::kInterrupted,
          fmt::format("interrupted: {} of {} frames are in {}{}; --time {:.10g} --frames {} with "
                      "another --out makes the others",
                      frames, flags.frames, flags.out, there, flags.time_s + frames * step_s,
                      flags.frames - frames)};
}

}  // namespace

Result<std::string> run_render(const RenderFlags& flags) {
  if (!(std::abs(flags.time_s) <= kLatestTime_s))
    return bad_input("--time: {} s; a number from {:g} to {:g} is accepted", flags.time_s,
                     -kLatestTime_s, kLatestTime_s);
  const TimeNs start = now_ns();
  NERITIC_TRY(scene::Scene scene, load(flags));
  NERITIC_TRY(FrameRequest request, request_of(flags, scene));
  for (const std::string& note : scene.notes) log_warn("{}", note);
  if (!request.cameras.empty() && !scene.sun && scene.lamps.empty() && scene.model_lights.empty())
    log_warn("{}: no sun and no lamps, so only what glows by itself is seen", flags.scene);
  if (const fs::path folder = fs::path(flags.dump_graph).parent_path();
      !folder.empty() && !fs::is_directory(folder))
    return bad_input("--dump-graph: {}: no folder {}", flags.dump_graph, folder.string());
  log_info("scene read in {:.0f} ms: {} models, {} objects", to_ms(now_ns() - start),
           scene.models.size(), scene.objects.size());
  gpu::DeviceOptions options;
  options.device = flags.device;
  options.validation = flags.validation;
  options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const auto device, gpu::Device::create(options));
  // Frames follow the first camera's rate, or the first sonar's; or the fastest, where each has its
  // own.
  const std::vector<double> rates_hz = rates_of(scene, request);
  const double step_s =
      1.0 / (flags.own_rates ? *std::ranges::max_element(rates_hz) : rates_hz.front());
  PingSchedule schedule(rates_hz);
  const FrameRequest all = request;
  NERITIC_TRY(const auto physics,
              start_physics(scene, flags.time_s, flags.time_s + flags.frames * step_s));
  if (physics) request.simulated = &physics->motion();
  if (flags.frames > 1) warn_of_rates(scene, request, flags.own_rates ? 0.0 : rates_hz.front());
  NERITIC_TRY(const auto session, Session::create(*device, std::move(scene)));
  log_info("ready to render after {:.0f} ms: {} triangles", to_ms(now_ns() - start),
           session->gpu_scene().triangles());
  session->keep_plan_dump(!flags.dump_graph.empty());
  if (flags.track_only) {
    // A side-scan made from pictures needs their depth.
    const auto& sonars = session->scene().sonars;
    request.capture.motion = false;
    request.capture.geometry =
        std::any_of(request.sonars.begin(), request.sonars.end(),
                    [&](std::size_t i) { return !sonars[i].picture_camera.empty(); });
  }
  // Of one frame no track is made, but its boxes are.
  const bool tracks = flags.frames > 1 || flags.track_only;
  Survey survey(session->scene(), flags.out, {flags.chart_cell_m, tracks});
  FrameFacts facts;
  std::set<fs::path> written;  // sensors' folders
  Progress progress("frame", flags.frames);
  const Interrupt interrupt;
  std::uint32_t made = 0;
  for (std::uint32_t i = 0; i < flags.frames && !interrupt.requested(); ++i) {
    request.time_s = flags.time_s + i * step_s;
    request.next_time_s = request.time_s + step_s;
    request.frame = i;
    if (flags.own_rates) take_due(schedule, all, request);
    if (physics) {
      physics->reach(request.time_s);
      physics->reach(request.next_time_s);
    }
    NERITIC_TRY(const FrameResult result, session->render(request));
    facts = {request.time_s,      session->scene().seed, flags.scene,
             device->info().name, result.passes,         result.frame_ms};
    if (!flags.track_only)
      NERITIC_TRY_STATUS(
          write_frame(fs::path(flags.out) / frame_folder(i), result, facts, written));
    NERITIC_TRY_STATUS(survey.add(result, i, request.time_s));
    if (i == 0 && flags.sheet)
      NERITIC_TRY_STATUS(write_sheet(flags.out, result, session->scene().class_names));
    if (i == 0 && !flags.dump_graph.empty()) NERITIC_TRY_STATUS(dump_graph(flags, *session));
    progress.step();
    ++made;
  }
  if (made == 0) return Error{ErrorCode::kInterrupted, "interrupted before the first frame"};
  NERITIC_TRY(const bool wrote_track, survey.write(facts));
  if (const auto hint = survey.hint()) log_warn("{}", *hint);
  if (made < flags.frames) return stopped_render(flags, made, step_s, wrote_track);
  warn_of_leftovers(flags, wrote_track, written);
  NERITIC_TRY_STATUS(check_validation(*device));
  return summary(flags, session->scene(), all, wrote_track);
}

}  // namespace neritic::tools
