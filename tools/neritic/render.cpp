// `neritic render SCENE --out DIR`: offscreen pictures and sensor data of a scene or a model.
#include <algorithm>
#include <cmath>
#include <set>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "testbed/instruments/wrist_displays.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/output/frame_files.hpp"
#include "testbed/sensors/sight_check.hpp"
#include "testbed/sensors/sonar_check.hpp"
#include "testbed/sensors/validation.hpp"
#include "testbed/simulation/error_outlook.hpp"
#include "testbed/simulation/mission_outlook.hpp"
#include "tools/common/outputs.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/interrupt.hpp"
#include "tools/neritic/load_scene.hpp"
#include "tools/neritic/named_sensors.hpp"
#include "tools/neritic/recorded_scene.hpp"
#include "tools/neritic/render_runs.hpp"
#include "tools/neritic/render_sheet.hpp"
#include "tools/neritic/step_files.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

namespace fs = std::filesystem;

constexpr double kLongestFlight_s = 24.0 * 3600.0;  // of physics, from time 0 on

// Thirty years: frames are still told apart to a tenth of a microsecond.
constexpr double kLatestTime_s = 1e9;

// The scene that is rendered; recorded: of --replay, and physics its scene.
Result<scene::Scene> load(const RenderFlags& flags, const SampleLog* recorded,
                          std::optional<scene::Scene>& physics) {
  scene::SceneOptions options;
  if (!flags.offset_m.empty()) {
    options.offset_m = {flags.offset_m[0], flags.offset_m[1], flags.offset_m[2]};
    // As positions in files. A comparison that a NaN fails.
    const Vec3 far = glm::abs(options.offset_m);
    if (!(std::max({far.x, far.y, far.z}) <= scene::kFarthest_m) || !is_finite(options.offset_m))
      return refusal(
          "--offset",
          fmt::format("{:g} {:g} {:g}", options.offset_m.x, options.offset_m.y, options.offset_m.z),
          fmt::format("three numbers of -{0:g} to {0:g} metres", scene::kFarthest_m));
  }
  options.sonar_quality = flags.quality;
  if (recorded) {
    NERITIC_TRY(physics, recorded_scene(*recorded, flags.replay, flags.scene, flags.size));
    return shown_scene(*recorded, flags.replay, flags.scene, flags.size,
                       {flags.shown, flags.added, flags.water}, *physics, options);
  }
  for (const std::string& more : flags.added) options.added.emplace_back(more);
  NERITIC_TRY(scene::Scene scene,
              load_scene_or_model(flags.scene, flags.size, options, flags.clip));
  if (flags.seed) scene.seed = *flags.seed;
  NERITIC_TRY_STATUS(set_water(scene, flags.water, flags.scene));
  return scene;
}

// The sensors that frames have, the data that is written of them, and the rate of frames.
struct ChosenRender {
  LoopSensors sensors;
  FrameFormat format;
  double rate_hz = 0.0;
};

bool is_picture_camera(const scene::Scene& scene, const LoopSensors& sensors, std::size_t camera) {
  return std::ranges::any_of(sensors.sonars, [&](std::size_t i) {
    return scene.sonars[i].picture_camera == scene.cameras[camera].name;
  });
}

Result<Datasets> datasets_of(const RenderFlags& flags, const LoopSensors& sensors) {
  using enum Dataset;
  Datasets accumulated;
  accumulated.add(kSonar).add(kTrajectory);
  if (flags.only.empty()) return flags.track_only ? accumulated : Datasets::all();
  NERITIC_TRY(const Datasets datasets, parse_datasets("--only", flags.only));
  for (std::size_t i = 0; i < std::size(kDatasetNames); ++i) {
    const auto one = static_cast<Dataset>(i);
    if (!datasets.has(one)) continue;
    const std::string_view name = kDatasetNames[i];
    if (flags.track_only && !accumulated.has(one))
      return refusal("--only", fmt::format("{} with --track-only", name), "sonar, trajectory");
    const Datasets alone = Datasets().add(one);
    const bool given = one == kTrajectory || (alone.of_cameras() && !sensors.cameras.empty()) ||
                       (alone.of_sonars() && !sensors.sonars.empty());
    if (!given)
      return refusal(
          "--only",
          fmt::format("{}, and no {} to give it", name, alone.of_sonars() ? "sonar" : "camera"),
          alone.of_sonars() ? "a scene and a --sensor with a sonar, or data of cameras"
                            : "a scene and a --sensor with a camera, or data of sonars");
  }
  return datasets;
}

// Data that some cameras cannot give.
Status check_camera_data(const scene::Scene& scene, const LoopSensors& sensors,
                         const Datasets& datasets) {
  const auto some = [&](auto has) {
    return std::ranges::any_of(sensors.cameras,
                               [&](std::size_t i) { return has(scene.cameras[i].terms); });
  };
  if (datasets.has(Dataset::kLinear) && !some([](const auto& terms) { return terms.linear; }))
    return refusal("--only", "'linear'", "that with a camera of linear = true");
  if (datasets.has(Dataset::kRaw) && !some([](const scene::CameraTerms& terms) {
        return terms.sensor && terms.sensor->bayer != scene::Bayer::kNone;
      }))
    return refusal("--only", "'raw'", "that with a camera of sensor = { bayer = \"rggb\" }");
  if (!datasets.has(Dataset::kKitti)) return {};
  for (const std::size_t i : sensors.cameras)
    if (scene.cameras[i].terms.lens)
      return refusal(
          "--only", fmt::format("kitti of '{}', which has a lens or a port", scene.cameras[i].name),
          "cameras without (--sensor), since KITTI's P2 has no place for one");
  return {};
}

// Refuses a camera that a side-scan's image-based record cannot use, as far as that is known before
// the first frame.
Status check_picture_cameras(const scene::Scene& scene, const LoopSensors& sensors,
                             const scene::SimulatedMotion* simulated, double time_s) {
  const scene::MotionSource motion(scene, simulated);
  for (const std::size_t i : sensors.sonars) {
    const scene::Sonar& sonar = scene.sonars[i];
    if (sonar.picture_camera.empty()) continue;
    const std::string where = fmt::format("sonar {}: picture_camera", sonar.name);
    const auto at = std::ranges::find_if(sensors.cameras, [&](std::size_t k) {
      return scene.cameras[k].name == sonar.picture_camera;
    });
    if (at == sensors.cameras.end())
      return refusal(where, fmt::format("'{}'", sonar.picture_camera),
                     "a camera of the scene that --sensor names too");
    const scene::Camera& camera = scene.cameras[*at];
    if (sensors.own_rates && camera.rate_hz < sonar.rate_hz)
      return refusal(where, fmt::format("{} at {:g} Hz", camera.name, camera.rate_hz),
                     fmt::format("a camera of {:g} Hz or more, as the sonar has (--own-rates)",
                                 sonar.rate_hz));
    NERITIC_TRY_STATUS(check_picture_camera(sonar, motion.world_from(camera.mount, time_s)));
  }
  return {};
}

// Drops the sensors that give nothing of what is written.
void drop_unused(const scene::Scene& scene, const Datasets& datasets, LoopSensors& sensors) {
  if (!datasets.of_sonars()) sensors.sonars.clear();
  const bool heard = datasets.has(Dataset::kSonar);
  std::erase_if(sensors.cameras, [&](std::size_t i) {
    return !datasets.of_cameras() && !(heard && is_picture_camera(scene, sensors, i));
  });
  sensors.capture = capture_of(datasets);
  // A side-scan made from pictures needs their depth.
  if (heard && std::ranges::any_of(sensors.cameras, [&](std::size_t i) {
        return is_picture_camera(scene, sensors, i);
      }))
    sensors.capture.color = sensors.capture.depth = true;
}

// Frames follow the first camera's rate, or the first sonar's; or the fastest, where each sensor
// has its own.
double frame_rate_hz(const scene::Scene& scene, const LoopSensors& sensors) {
  std::vector<double> rates_hz;
  for (const std::size_t i : sensors.cameras) rates_hz.push_back(scene.cameras[i].rate_hz);
  for (const std::size_t i : sensors.sonars) rates_hz.push_back(scene.sonars[i].rate_hz);
  return sensors.own_rates ? *std::ranges::max_element(rates_hz) : rates_hz.front();
}

Packing packing_of(const std::string& compress) {
  return compress == "npz" ? Packing::kNpz : compress == "png" ? Packing::kPng : Packing::kNone;
}

Result<ChosenRender> choose(const RenderFlags& flags, const scene::Scene& scene) {
  if (!flags.quality.empty() && scene.sonars.empty())
    return refusal("--quality", "no sonar", "a scene with one, whose samples it chooses");
  if (flags.chart_cell_m > 0.0 &&
      std::ranges::count(scene.sonars, scene::SonarKind::kProfiling, &scene::Sonar::kind) == 0)
    return refusal("--chart-cell", "no profiling sonar", "a scene with one, which sounds a chart");
  NERITIC_TRY(NamedSensors named, named_sensors(flags.sensors, scene));
  LoopSensors sensors{.cameras = std::move(named.cameras),
                      .sonars = std::move(named.sonars),
                      .own_rates = flags.own_rates};
  for (const std::size_t i : sensors.sonars)
    NERITIC_TRY_STATUS(check_sonar(scene, scene.sonars[i]));
  if (sensors.cameras.empty() && sensors.sonars.empty())
    return refusal(flags.scene, "no camera and no sonar", "one or more");
  NERITIC_TRY(const Datasets datasets, datasets_of(flags, sensors));
  if (!flags.only.empty()) NERITIC_TRY_STATUS(check_camera_data(scene, sensors, datasets));
  const double rate_hz = frame_rate_hz(scene, sensors);
  drop_unused(scene, datasets, sensors);
  const bool seen = !sensors.cameras.empty() &&
                    (sensors.capture.color || sensors.capture.geometry() || sensors.capture.motion);
  if (flags.sheet && !seen && !(datasets.has(Dataset::kSonar) && !sensors.sonars.empty()))
    return refusal("--sheet", "nothing in --only to show", "data of a camera, or sonar");
  return ChosenRender{std::move(sensors), {datasets, packing_of(flags.compress)}, rate_hz};
}

// A sonar cannot ping again before its farthest echo is back.
void warn_of_rates(const scene::Scene& scene, const LoopSensors& sensors, double frame_hz) {
  constexpr double kSoundSpeed_m_s = 1500.0;  // near enough for a warning
  for (const std::size_t i : sensors.sonars) {
    const scene::Sonar& sonar = scene.sonars[i];
    const double most_hz = kSoundSpeed_m_s / (2.0 * sonar.range_max_m);
    const double rate_hz = sensors.own_rates ? sonar.rate_hz : frame_hz;
    if (rate_hz > 1.01 * most_hz)
      log_warn("sonar {}: {:.3g} pings a second, but echoes from {:g} m allow {:.3g}", sonar.name,
               rate_hz, sonar.range_max_m, most_hz);
  }
}

// The scene's physics; nullptr where nothing moves by physics.
Result<std::unique_ptr<LivePhysics>> make_physics(const RenderFlags& flags,
                                                  const scene::Scene& scene, double last_s,
                                                  const SampleLog* recorded) {
  if (!PhysicsWorld::needed(scene)) {
    if (const std::string flag = first_step_flag(flags.files); !flag.empty())
      return flag_without_physics(flag, flags.scene);
    return std::unique_ptr<LivePhysics>();
  }
  if (!(last_s <= kLongestFlight_s))
    return refusal(scene.path, fmt::format("physics to {:g} s of scene time", last_s),
                   fmt::format("at most {:g} s", kLongestFlight_s));
  const TimeNs begun_ns = now_ns();
  NERITIC_TRY(auto world, PhysicsWorld::create(scene));
  LivePhysics::Options options;
  if (recorded) {
    NERITIC_TRY(options.start, start_of(*recorded, flags.replay, *world));
  } else if (last_s > 0.0) {
    for (const std::string& line : cannot_hold(*world)) log_warn("{}", line);
    if (const std::string line = not_promised(scene, *world); !line.empty()) log_warn("{}", line);
  }
  auto physics = LivePhysics::create(std::move(world), options);
  const auto counts = physics->world().solid().counts();
  log_info(
      "physics: {} solid things of {} triangles built in {:.0f} ms; {} vehicles and {} divers move",
      counts.things, counts.triangles, to_ms(now_ns() - begun_ns),
      physics->world().vehicles().size(), physics->world().humans().size());
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

// Beside the files of the frames: the first frame's sheet and graph, and the count on a terminal.
class FirstFrame final : public FrameSink {
 public:
  FirstFrame(const RenderFlags& flags, const Session& session)
      : flags_(flags), session_(session), progress_("frame", flags.frames) {}
  Status accept(const FrameResult& frame) override {
    if (frame.frame == 0 && flags_.sheet)
      NERITIC_TRY_STATUS(write_sheet(flags_.out, frame, session_.scene().class_names));
    if (frame.frame == 0 && !flags_.dump_graph.empty())
      NERITIC_TRY_STATUS(dump_graph(flags_, session_));
    progress_.step();
    return {};
  }
  Status finish() override { return {}; }

 private:
  const RenderFlags& flags_;
  const Session& session_;
  Progress progress_;
};

// Warns of files of an earlier run that could be taken for this one's.
void warn_of_leftovers(const RenderFlags& flags, const ChosenRender& chosen, bool wrote_track,
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
  const auto leftover = [&](const char* name, bool written_now) {
    if (!written_now && fs::is_regular_file(out / name, ignored))
      log_warn("{}: {} is an earlier run's", flags.out, name);
  };
  leftover("coco.json", !flags.track_only && chosen.format.datasets.has(Dataset::kCoco) &&
                            !chosen.sensors.cameras.empty());
  leftover("trajectory.csv", chosen.format.datasets.has(Dataset::kTrajectory));
}

// "out: frame_0000 to 0029 of rov_camera, rov_sonar; track; sheet.png shows all at one glance".
std::string summary(const RenderFlags& flags, const scene::Scene& scene, const ChosenRender& chosen,
                    bool wrote_track) {
  const LoopSensors& sensors = chosen.sensors;
  const Datasets& datasets = chosen.format.datasets;
  std::vector<std::string> names, parts;
  for (const std::size_t i : sensors.cameras) names.push_back(scene.cameras[i].name);
  for (const std::size_t i : sensors.sonars) names.push_back(scene.sonars[i].name);
  const std::string last = flags.frames > 1 ? fmt::format(" to {:04}", flags.frames - 1) : "";
  if (!flags.track_only && !names.empty())
    parts.push_back(fmt::format("frame_0000{} of {}", last, fmt::join(names, ", ")));
  if (wrote_track) parts.push_back("track");
  const bool labelled = !flags.track_only && !sensors.cameras.empty();
  const char* const pictures =
      datasets.has(Dataset::kColor) ? "" : ", for pictures that --only leaves out (add color)";
  if (labelled && datasets.has(Dataset::kCoco))
    parts.push_back(std::string("coco.json") + pictures);
  if (labelled && datasets.has(Dataset::kKitti)) parts.push_back(std::string("kitti") + pictures);
  if (datasets.has(Dataset::kTrajectory)) parts.push_back("trajectory.csv");
  if (flags.sheet) parts.push_back("sheet.png shows all at one glance");
  return fmt::format("{}: {}", flags.out, fmt::join(parts, "; "));
}

// The message for a run that the user stopped.
Error stopped_render(const RenderFlags& flags, std::uint64_t frames, double step_s,
                     bool wrote_track) {
  std::string there;
  if (!flags.track_only)
    there += fmt::format(" as {} to {}", frame_folder(0),
                         frame_folder(static_cast<std::uint32_t>(frames - 1)));
  if (wrote_track)
    there += fmt::format("{}track, of these frames", there.empty() ? " as " : " and ");
  return {ErrorCode::kInterrupted,
          fmt::format("interrupted: {} of {} frames are in {}{}; --time {:.10g} --frames {} with "
                      "another --out makes the others",
                      frames, flags.frames, flags.out, there,
                      flags.time_s + static_cast<double>(frames) * step_s, flags.frames - frames)};
}

Status check_replay(const RenderFlags& flags) {
  if (flags.replay.empty() && flags.scene.empty())
    return refusal("SCENE", "none", "a scene or model file, or --replay with a recording");
  if (flags.replay.empty() && !flags.shown.empty())
    return refusal("--scene", "no --replay beside it", "with a recording whose motion is shown");
  if (!flags.replay.empty() && (flags.seed || !flags.offset_m.empty() || !flags.clip.empty()))
    return refusal("--replay", "--seed, --offset or --clip beside it", "none of them");
  return {};
}

// The frames that a recording lasts for, or those that are asked for.
Status choose_frames(RenderFlags& flags, const SampleLog* recorded, double rate_hz) {
  if (!recorded) {
    flags.frames = std::max(flags.frames, 1u);
    return {};
  }
  const double start_s = static_cast<double>(recorded->first_step) * recorded->step_s;
  const double end_s = start_s + static_cast<double>(recorded->steps()) * recorded->step_s;
  if (flags.time_s == 0.0) flags.time_s = start_s;
  if (!(flags.time_s >= start_s && flags.time_s <= end_s))
    return refusal("--time", fmt::format("{:g} s", flags.time_s),
                   fmt::format("{:g} to {:g} s, as was recorded", start_s, end_s));
  const double most = std::floor((end_s - flags.time_s) * rate_hz + 1e-6) + 1.0;
  if (static_cast<double>(flags.frames) > most)
    return refusal("--frames", fmt::format("{}", flags.frames),
                   fmt::format("up to {}, as was recorded", most));
  if (flags.frames == 0) flags.frames = static_cast<std::uint32_t>(std::min(most, 1e6));
  return {};
}

// One run; told: how it went.
Result<std::string> render_once(const RenderFlags& asked, RenderedRun& told) {
  RenderFlags flags = asked;
  NERITIC_TRY_STATUS(check_replay(flags));
  if (!(std::abs(flags.time_s) <= kLatestTime_s))
    return refusal("--time", fmt::format("{} s", flags.time_s),
                   fmt::format("{:g} to {:g} s", -kLatestTime_s, kLatestTime_s));
  NERITIC_TRY_STATUS(check_output_folder("--out", flags.out));
  const std::string graph_file = flags.dump_graph != "-" ? flags.dump_graph : "";
  NERITIC_TRY_STATUS(check_step_files(flags.files, {{"--dump-graph", graph_file}}));
  const TimeNs start = now_ns();
  const Interrupt interrupt;
  std::optional<SampleLog> recorded;
  std::optional<scene::Scene> physics_scene;
  if (!flags.replay.empty()) {
    NERITIC_TRY(recorded, read_recording(flags.replay));
  }
  const SampleLog* log = recorded ? &*recorded : nullptr;
  NERITIC_TRY(scene::Scene scene, load(flags, log, physics_scene));
  if (flags.scene.empty()) flags.scene = scene.path;
  if (!flags.picture_quality.empty())
    for (scene::Camera& camera : scene.cameras)
      camera.detail = scene::picture_level(flags.picture_quality).detail;
  told.seed = scene.seed;
  NERITIC_TRY(ChosenRender chosen, choose(flags, scene));
  LoopSensors& sensors = chosen.sensors;
  for (const std::string& note : scene.notes) log_warn("{}", note);
  if (!sensors.cameras.empty() && sensors.capture.color && !scene.sun && scene.lamps.empty() &&
      scene.model_lights.empty())
    log_warn("{}: no sun and no lamps, so only what glows by itself is seen", flags.scene);
  log_info("scene read in {:.0f} ms: {} models, {} objects", to_ms(now_ns() - start),
           scene.models.size(), scene.objects.size());
  gpu::DeviceOptions options;
  options.device = flags.device;
  options.validation = flags.validation;
  options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const auto device, gpu::Device::create(options));
  const double rate_hz = chosen.rate_hz, step_s = 1.0 / rate_hz;
  NERITIC_TRY_STATUS(choose_frames(flags, log, rate_hz));
  NERITIC_TRY(const auto physics, make_physics(flags, physics_scene ? *physics_scene : scene,
                                               flags.time_s + flags.frames * step_s, log));
  std::unique_ptr<Replay> replay;
  if (physics && recorded) {
    NERITIC_TRY(replay, Replay::of(std::move(*recorded), flags.replay, physics->world()));
  }
  if (flags.frames > 1) warn_of_rates(scene, sensors, rate_hz);
  const auto displays = wrist_displays(physics.get(), hud::Units::kMetric);
  NERITIC_TRY(const auto session,
              Session::create(*device, std::move(scene), picture_places(displays.get())));
  log_info("ready to render after {:.0f} ms: {} triangles", to_ms(now_ns() - start),
           session->gpu_scene().triangles());
  session->keep_plan_dump(!flags.dump_graph.empty());
  sensors.session = session.get();

  std::optional<StepFiles> step_files;
  StepProgress approach("second of the dive", flags.time_s);
  std::optional<DiveLog> outcome_log;
  std::vector<StepSink*> step_sinks;
  if (physics) {
    step_files.emplace(flags.files, session->scene().title, RecordingOptions{}, *physics);
    step_sinks = step_files->sinks();
    step_sinks.push_back(&approach);
    if (asked.runs > 0)
      step_sinks.push_back(
          &outcome_log.emplace(physics->world(), 0.0, std::vector<std::unique_ptr<RowSink>>()));
  }
  std::vector<SampleSource*> sources;
  if (replay) {
    sources = {&replay->source};
    step_sinks.push_back(&replay->check);
  }
  // One frame makes no track, but boxes.
  const bool tracks = flags.frames > 1 || flags.track_only;
  if (tracks && chosen.format.datasets.has(Dataset::kSonar))
    NERITIC_TRY_STATUS(check_picture_cameras(session->scene(), sensors,
                                             physics ? &physics->motion() : nullptr, flags.time_s));
  FrameFiles files(*session, {flags.out, flags.scene, !flags.track_only, chosen.format,
                              SurveyOptions{flags.chart_cell_m, tracks}});
  FirstFrame first(flags, *session);
  SightCheck sight(*session, physics ? &physics->motion() : nullptr,
                   [](const std::string& line) { log_warn("{}", line); });
  Loop loop(
      {.clock = Clock::simulated(flags.time_s, step_s),
       .physics = physics.get(),
       .sensors = sensors,
       .pictures = displays.get(),
       .sources = sources,
       .step_sinks = step_sinks,
       .frame_sinks = {&files, &first, &sight},
       .stop = {.frames = flags.frames, .interrupted = [&] { return interrupt.requested(); }}});
  NERITIC_TRY_STATUS(loop.run());
  if (loop.frames() == 0)
    return Error{ErrorCode::kInterrupted, "interrupted before the first frame"};
  for (const std::string& hint : files.hints()) log_warn("{}", hint);
  if (loop.frames() < flags.frames)
    return stopped_render(flags, loop.frames(), step_s, files.wrote_track());
  warn_of_leftovers(flags, chosen, files.wrote_track(), files.folders());
  NERITIC_TRY_STATUS(check_validation(*device));
  if (outcome_log)
    told.outcomes = outcomes_of(physics->world(), physics->newest().state, *outcome_log, told.seed);
  return summary(flags, session->scene(), chosen, files.wrote_track());
}

}  // namespace

Result<std::string> run_render(const RenderFlags& flags) {
  RenderedRun told;
  if (flags.runs == 0) return render_once(flags, told);
  return render_runs(flags, render_once);
}

}  // namespace neritic::tools
