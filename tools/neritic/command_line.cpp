// The command line of `neritic`: every flag of every subcommand. The one file that includes the
// parser, since it takes long to compile.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <memory>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/core/version.hpp"
#include "engine/scene/scene.hpp"
#include "testbed/output/datasets.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {
namespace {

using Run = std::function<Result<std::string>()>;

// For commands that print their own results.
Result<std::string> nothing_to_say(const Status& status) {
  if (!status.ok()) return status.error();
  return std::string();
}

// An empty name would be the working folder, by chance.
std::string named(const std::string& folder) {
  return folder.empty() ? found_accepted("''", "a folder's name") : "";
}

// Pictures are written in this form whatever the name says.
std::string png_file(const std::string& file) {
  const std::string kind = lower_case(std::filesystem::path(file).extension().string());
  return kind == ".png" ? "" : found_accepted(fmt::format("'{}'", file), "a .png");
}

// The parser takes the largest number for any that is larger.
std::string seed_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? "" : found_accepted(text, "a whole number from 0 to 18446744073709551615");
}

// Numbers from least to most, in the words of every other refusal.
template <class T>
CLI::Validator between(T least, T most) {
  const auto check = [=](const std::string& text) -> std::string {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good =
        error == std::errc() && end == text.data() + text.size() && value >= least && value <= most;
    return good ? ""
                : found_accepted(fmt::format("'{}'", text), fmt::format("{} to {}", least, most));
  };
  return CLI::Validator(check, fmt::format("in [{} - {}]", least, most));
}

void add_quality(CLI::App& command, std::string& quality) {
  command
      .add_option("--quality", quality,
                  "how finely sonars are sampled: under 5, 2 or 1 % of error (sonar/TRADE.md)")
      ->check(CLI::IsMember({"draft", "standard", "reference"}));
}

// What is shown of a recorded dive.
void add_replay(CLI::App& command, std::string& replay, std::string& shown,
                std::vector<std::string>& added) {
  command.add_option(
      "--replay", replay,
      "a recorded dive (.mcap): its motion again, each state's hash compared; without SCENE in the "
      "scene that was recorded");
  command.add_option(
      "--scene", shown,
      "with --replay: shows the motion in this scene, whose objects of the same names "
      "move so");
  command
      .add_option(
          "--add", added,
          "merges a .toml over the scene that is shown, as if it included it: other cameras, "
          "sonars, lights; may be given again")
      ->expected(1)
      ->take_all();
}

void add_render(CLI::App& app, Run& run) {
  auto flags = std::make_shared<RenderFlags>();
  CLI::App* command = app.add_subcommand(
      "render", "offscreen pictures and sensor data of a scene (.toml) or a model (.gltf, .glb)");
  command->add_option("scene", flags->scene,
                      "scene or model file; with --replay the recording's own if none is given");
  command
      ->add_option(
          "--out", flags->out,
          "folder for the results: in OUT/frame_0000 a folder a sensor with pictures (.png), "
          "arrays (.npy) and facts (.json); in OUT/track what sonars accumulate over frames")
      ->required()
      ->check(named);
  command
      ->add_option("--frames", flags->frames,
                   "number of frames (1; with --replay as many as it lasts), apart by the rate_hz "
                   "of the first camera, else of the first "
                   "sonar; of the quickest sensor with --own-rates")
      ->check(between(1, 1000000));
  command->add_option("--size", flags->size, "WxH of every camera, pixels");
  command->add_option(
      "--time", flags->time_s,
      "scene time of the first frame, seconds (a day at most where vehicles fly there)");
  command->add_option(
      "--clip", flags->clip,
      "of a model: this animation, by name or number from 0 (else the first); --time "
      "is its time, which begins anew at its end");
  command->add_option("--sensor", flags->sensors, "only this sensor, by name; may be given again")
      ->expected(1)
      ->take_all();
  command
      ->add_option("--only", flags->only,
                   fmt::format("writes, and computes, these data alone, of each sensor that gives "
                               "them: {}; coco: boxes and masks of all cameras (OUT/coco.json); "
                               "trajectory: where every participant is (OUT/trajectory.csv and "
                               "OUT/trajectory)",
                               join(testbed::kDatasetNames)))
      ->expected(1)
      ->take_all();
  command
      ->add_option(
          "--compress", flags->compress,
          "of arrays: npz (lossless, numpy.load reads it), or png (16 bits a channel: labels, "
          "instances, depth in mm up to 65.534 m, normals as colours; others .npz)")
      ->check(CLI::IsMember({"npz", "png"}));
  command->add_option(
      "--water", flags->water,
      fmt::format("another Jerlov type than the scene's: {}", join(scene::kWaterTypes)));
  add_replay(*command, flags->replay, flags->shown, flags->added);
  command->add_option("--offset", flags->offset_m, "moves the whole world by x y z metres")
      ->expected(3);
  command->add_option("--device", flags->device, "Vulkan device: index or part of its name");
  command->add_option(
      "--dump-graph", flags->dump_graph,
      "the frame graph's plan: to a file (.dot: Graphviz), or - for standard output");
  command
      ->add_option("--chart-cell", flags->chart_cell_m,
                   "metres a cell of charts that profiling sonars sound")
      ->check(between(0.001, 1000.0));
  add_quality(*command, flags->quality);
  command->add_flag("--track-only", flags->track_only,
                    "no frame folders: only what sonars accumulate over the frames (OUT/track)");
  command->add_flag(
      "--own-rates", flags->own_rates,
      "each sensor only in the frames in which its rate_hz makes it due (else all in each)");
  command->add_option("--log", flags->files.log,
                      "where vehicles or divers move by physics: their dive as a .csv");
  command->add_option("--log-rate", flags->files.log_rate_hz,
                      "its rows a second, else one a control period");
  command->add_option("--seed", flags->seed,
                      "of the sensors' noise, instead of the scene's; what is scattered stays");
  command->add_flag(
      "--sheet", flags->sheet,
      "also pictures of what each sensor sees and of the first camera's depth, normals, "
      "labels and motion (OUT/sheet), and all on one (OUT/sheet.png)");
  command->add_flag("--validate", flags->validation,
                    "run with Vulkan validation; any message is a failure");
  command->callback([flags, &run] { run = [flags] { return run_render(*flags); }; });
}

void add_sonar_images(CLI::App& command, SonarFlags& flags) {
  command.add_option(
      "--depth", flags.depth,
      "depth image: .npy, .npz, .png and .pgm (8, 16 bit), .pfm or .exr; or a folder or a "
      "quoted pattern, one frame per file");
  command.add_option("--normals", flags.normals,
                     "normal image, or a folder; without it normals are estimated from depth");
  command.add_option("--labels", flags.labels, "image of class numbers, 0 to 65535, or a folder");
  command
      .add_option("--intrinsics", flags.intrinsics,
                  "fx,fy,cx,cy in pixels, or a .json or .yaml file (ROS camera_info, OpenCV)")
      ->required();
  command
      .add_option("--pixel-centers", flags.pixel_centers,
                  "whether the centre of the first pixel is 0.5,0.5 (half) or 0,0 (integer)")
      ->check(CLI::IsMember({"half", "integer"}))
      ->capture_default_str();
  command
      .add_option("--depth-kind", flags.depth_kind,
                  "depth along the view axis (planar) or along each ray (range), or disparity in "
                  "pixels, with --baseline")
      ->check(CLI::IsMember({"planar", "range", "disparity"}))
      ->capture_default_str();
  command
      .add_option("--depth-scale", flags.depth_scale,
                  "metres per unit of the depth image; of disparity pixels per unit")
      ->capture_default_str();
  command.add_option("--baseline", flags.baseline, "metres between the two cameras of a disparity");
  command.add_option("--axes", flags.axes, "axes of the normals")
      ->check(CLI::IsMember({"opengl", "opencv", "ros"}))
      ->capture_default_str();
  command.add_option("--camera-pose", flags.camera_pose,
                     "says that the normals are in world axes: the rotation from the camera's "
                     "(--axes) to those, qx,qy,qz,qw or a .json or .yaml file");
  command
      .add_option("--normals-sign", flags.normals_sign,
                  "facing: normals point at the sensor; unknown: only the absolute value of the "
                  "incidence counts")
      ->check(CLI::IsMember({"facing", "unknown"}))
      ->capture_default_str();
  command
      .add_option("--gamma", flags.gamma,
                  "gamma of normals stored as 8 or 16 bit colours v: n = 2 v^gamma - 1")
      ->capture_default_str();
}

void add_sonar_device(CLI::App& command, SonarFlags& flags) {
  command.add_option(
      "--sensor", flags.sensor,
      "file of a sensor with its terms (assets/sensors); the next five flags override its values");
  add_quality(command, flags.quality);
  command.add_option("--range", flags.range, "nearest,farthest in metres (imaging: 1,5)");
  command.add_option(
      "--azimuth", flags.azimuth,
      "full aperture in degrees, or from,to; for an echo sounder its whole cone (imaging: 90)");
  command.add_option("--elevation", flags.elevation,
                     "full aperture in degrees, or from,to (imaging: 28)");
  command.add_option("--bins", flags.bins, "range,azimuth,elevation (imaging: 500,500,500)");
  command
      .add_option("--method", flags.method,
                  "reference: the published algorithm in double precision on the CPU; image: a "
                  "side-scan line from a camera's picture")
      ->check(CLI::IsMember({"gpu", "reference", "image"}))
      ->capture_default_str();
  command
      .add_option("--gather", flags.gather,
                  "how the GPU samples. published (default for imaging without terms): each pixel "
                  "adds to one cell, as in the published algorithm; plane (default for all others "
                  "and for scenes): each beam is intersected with the plane of a pixel, better at "
                  "low resolution; nearest: each beam takes the nearest pixel")
      ->check(CLI::IsMember({"published", "nearest", "plane"}));
  command.add_option("--side", flags.side, "sidescan: the side that the images look at")
      ->check(CLI::IsMember({"port", "starboard"}))
      ->capture_default_str();
  command
      .add_option("--backscatter-db", flags.backscatter_db,
                  "Lambert backscatter strength of all surfaces, dB, for sensors with a level")
      ->capture_default_str();
  command.add_option("--seed", flags.seed, "seed of speckle and noise")
      ->check(seed_number)
      ->capture_default_str();
  command.add_option("--picture", flags.picture,
                     "with --method image: the picture from straight above, or a folder");
  command.add_option("--altitude", flags.altitude,
                     "with --method image: metres above a flat bottom, instead of --depth");
  command.add_flag("--incidence", flags.incidence,
                   "with --method image: multiplies by the cosine of incidence");
}

void add_sonar(CLI::App& app, Run& run) {
  auto flags = std::make_shared<SonarFlags>();
  CLI::App* command = app.add_subcommand(
      "sonar", "makes sonar images from depth and normal images: from one frame or from a folder");
  command->add_option("kind", flags->kind, "imaging, profiling, echosounder, sidescan")->required();
  add_sonar_images(*command, *flags);
  add_sonar_device(*command, *flags);
  command->add_option("--device", flags->device, "Vulkan device: part of its name, or its index");
  command->add_flag("--validate", flags->validation,
                    "runs with Vulkan validation; any message is a failure");
  command->add_flag("--no-pictures", flags->no_pictures,
                    "writes no sonar.png, which takes longest");
  command->add_flag("--overwrite", flags->overwrite,
                    "folders: makes frames again that OUT already has");
  command->add_option("--workers", flags->workers, "folders: threads that read and write")
      ->check(between(1, 256));
  command
      ->add_option("--out", flags->out,
                   "folder for sonar.npy, .png, .json; for folders of images one folder per frame")
      ->required()
      ->check(named);
  command->callback([command, flags, &run] {
    for (const CLI::Option* option : command->get_options())
      if (option->count() > 0) flags->given.insert(option->get_name());
    run = [flags] { return run_sonar(*flags); };
  });
}

void add_dive(CLI::App& app, CommandLine& line) {
  auto flags = std::make_shared<DiveFlags>();
  CLI::App* command = app.add_subcommand(
      "dive",
      "the live program: a scene (.toml) or a model (.gltf, .glb) in a headset or a window; F1 "
      "lists keys");
  command->add_option("scene", flags->scene,
                      "scene or model file; with --replay the recording's own if none is given");
  command->add_flag(
      "--headless", flags->headless,
      "no window. Where vehicles move by physics and no flag asks for pictures: their "
      "dive alone, as fast as it can; else frames at the camera's rate, then a "
      "summary of their times");
  command
      ->add_option(
          "--display", flags->display,
          "openxr: a headset; window; auto: the headset if an OpenXR runtime has one, else "
          "a window")
      ->check(CLI::IsMember({"auto", "openxr", "window"}));
  command->add_option("--bindings", flags->bindings,
                      "your own controls of some actions, a .toml (docs/headsets.md)");
  command->add_option("--refresh", flags->refresh_hz, "pictures a second of the headset")
      ->check(CLI::Range(1.0, 1000.0));
  command->add_option("--log", flags->files.log,
                      "the vehicles' dive as a .csv, a row a control period");
  command->add_option("--log-rate", flags->files.log_rate_hz, "rows a second instead");
  command
      ->add_option("--plot", flags->files.plot,
                   "the dive as a .png, its data beside as .plot.json; tools/setup plots installs "
                   "what draws")
      ->check(png_file);
  command->add_option(
      "--record", flags->files.record,
      "every sample in and out, state hashes and the scene, as an .mcap that --replay "
      "and ROS 2 tools read (neritic recording --help); F.xdf: beside F.mcap all numbers for "
      "physiology labs");
  command
      ->add_option("--record-images", flags->record_images,
                   "with --record: also these images, such as rov_camera/color or rov_sonar/echoes "
                   "(depth, normals, labels, instances, motion); may be given again. Without it "
                   "`render --replay` makes them later")
      ->expected(1)
      ->take_all();
  command->add_option("--play", flags->play,
                      "sends the samples of a recorded dive as live ones: they drive the groups of "
                      "inputs that name their devices");
  add_replay(*command, flags->replay, flags->shown, flags->added);
  command->add_option(
      "--water", flags->water,
      fmt::format("with --replay: another Jerlov type: {}", join(scene::kWaterTypes)));
  command->add_option("--save", flags->files.save, "the state at the end, for --restore");
  command->add_option("--restore", flags->restore,
                      "goes on from a saved state of the same scene, --seconds more");
  command->add_option("--seed", flags->seed,
                      "of the sensors' noise, instead of the scene's; what is scattered stays");
  command
      ->add_option("--runs", flags->runs,
                   "with --headless: so many dives, with the seeds from --seed on, until their "
                   "missions are done; a table of outcomes")
      ->check(between(1, 100000));
  command->add_option("--serve", flags->serve,
                      "lets other programs read and command this dive (neritic serve, hud "
                      "--connect): tcp://ADDRESS:PORT; beyond 127.x.x.x with --keys");
  command->add_option("--keys", flags->keys, "with --serve: folder of keys (neritic keys)");
  command->add_flag("--realtime", flags->realtime, "physics without pictures at the clock's pace");
  command->add_flag("--json", flags->json, "the dive's summary as JSON");
  command->add_flag("--fast", flags->fast, "with --headless: frames as fast as they come");
  command->add_flag("--panels", flags->panels, "with --headless: draw the window's panels too");
  command
      ->add_option(
          "--timeline", flags->timeline,
          "the frames' phases, passes and resolution as a .png, its data beside as .plot.json")
      ->check(png_file);
  command->add_option(
      "--hud", flags->hud,
      "a diver's instruments over the view: none, or any of corner, mask, wrist, "
      "console (default of a scene with divers: corner in a window, wrist in a headset; key H)");
  command->add_option("--diver", flags->diver, "whose instruments (default: the first diver)");
  command->add_option("--units", flags->units, "of the instruments: metric (default), imperial")
      ->check(CLI::IsMember({"metric", "imperial"}));
  command
      ->add_option("--quality", flags->quality,
                   "auto: resolution and sonars' rates come down where the machine is too slow for "
                   "its screen, on a CPU for 20 pictures a second (default in a window); full")
      ->check(CLI::IsMember({"auto", "full"}));
  command->add_option(
      "--seconds", flags->seconds,
      "stop after so many simulated seconds (default with --headless: 60 of physics "
      "alone, 5 of frames); exit status 1 if a mission is not finished though they were enough for "
      "its way at its speed, and nothing is saved to go on from");
  command->add_option("--frames", flags->frames, "stop after so many frames")
      ->check(between(1, 1000000));
  command->add_option("--screenshot", flags->screenshot, "write the last frame to this .png")
      ->check(png_file);
  command->add_option("--size", flags->size, "WxH of the window or the picture, pixels");
  command
      ->add_option("--sensor", flags->sensors,
                   "begin at this camera, show only this sonar, by name; may be given again")
      ->expected(1)
      ->take_all();
  command->add_option("--view", flags->view,
                      "begin here: a camera's name, chase:PARTICIPANT or free (V goes on)");
  command->add_option("--device", flags->device, "Vulkan device: index or part of its name");
  command->add_flag("--validate", flags->validation,
                    "run with Vulkan validation; any message is a failure");
  // The flags of all commands are read by then.
  command->callback([flags, &line] {
    flags->quiet = line.quiet;
    line.run = [flags] { return nothing_to_say(run_dive(*flags)); };
  });
}

void add_tradeoff(CLI::App& app, Run& run) {
  auto flags = std::make_shared<TradeoffFlags>();
  CLI::App* command = app.add_subcommand(
      "tradeoff", "measures the error of a model against its cost, over all of its settings");
  command
      ->add_option(
          "what", flags->what,
          "sonar, physics, navigation, swim, deco, physiology, modem, network, xr, camera, "
          "optics or experiment (time to block and success of the task `shark`)")
      ->required();
  command
      ->add_option("--out", flags->out,
                   "folder for the tables (.csv, .md), their pictures and the quality levels")
      ->required()
      ->check(named);
  command
      ->add_option("scene,--scene", flags->scene,
                   "sonar: the scene whose first sonar gives the place; none: only scenes with a "
                   "closed-form answer; xr: whose first camera is the head (dive.toml); camera: "
                   "whose first camera it is (wreck.toml); network: "
                   "one with [sources] (lab.toml)")
      ->capture_default_str();
  command->add_option(
      "--kind", flags->kind,
      "sonar: only this kind: imaging, profiling, echosounder, sidescan or mechanical");
  command->add_option("--recordings", flags->recordings,
                      "physiology: also measures the paced breath sounds in this folder (.wav, "
                      "rate in the name: ..._12bpm_...)");
  command->add_option("--device", flags->device, "Vulkan device: part of its name, or its index");
  command->add_flag("--quick", flags->quick,
                    "a fast trial with fewer rays, bins and points; gives no quality levels");
  command->callback([flags, &run] { run = [flags] { return run_tradeoff(*flags); }; });
}

void add_check(CLI::App& app, Run& run) {
  auto flags = std::make_shared<CheckFlags>();
  CLI::App* command = app.add_subcommand("check",
                                         "compares the vehicle, its control or the dive planner "
                                         "with a file of reference cases; one line per case");
  command
      ->add_option("what", flags->what,
                   "rov (trajectories of the vehicle), control or deco (dive plans)")
      ->required();
  command->add_option("file", flags->file, "file of cases (.json)")->required();
  command->footer(
      "Example: neritic check rov tests/rov/data/trajectories.json\n"
      "Example: neritic check control tests/rov/data/control.json\n"
      "Example: neritic check deco tests/diver/data/deco_vectors.json");
  command->add_option("--integrator", flags->integrator, "rov, control: guarded, rk4 or semi_euler")
      ->capture_default_str();
  command->add_option("--hz", flags->hz, "rov, control: steps per second")->capture_default_str();
  command->add_flag("--json", flags->json, "JSON on standard output, for programs");
  command->callback([flags, &run] { run = [flags] { return nothing_to_say(run_check(*flags)); }; });
}

void add_plan(CLI::App& app, Run& run) {
  auto flags = std::make_shared<PlanFlags>();
  CLI::App* command = app.add_subcommand(
      "plan", "plans a dive: stops, run times, oxygen, warnings; or replays a log of depths");
  command->footer(
      "Example: neritic plan --depth 30 --time 25 --gas ean32 --gf 30/85 --table c\n"
      "Example: neritic plan --log DIVE.csv --table c --out out/log");
  command
      ->add_option("--gas", flags->gases,
                   "gases: air, ean32, 18/45 (oxygen/helium) or o2. The first is breathed at the "
                   "bottom, the others on the ascent from GAS@DEPTH in metres (default: the depth "
                   "of 1.6 bar of oxygen)")
      ->expected(1, 32);
  command
      ->add_option("--travel", flags->travel,
                   "GAS[@DEPTH]: breathed on the descent from this depth until the next gas's "
                   "depth; the bottom gas then needs a depth too: --gas 15/55@30")
      ->expected(1, 32);
  command->add_option("--depth", flags->depth_m, "depth of the bottom, metres");
  command->add_option("--time", flags->time_min,
                      "minutes from leaving the surface to leaving the bottom, descent included");
  command
      ->add_option("--level", flags->levels,
                   "DEPTH,MIN: a further level: its depth, and the run time at which the diver "
                   "leaves it; repeat for more")
      ->expected(1)
      ->take_all();
  command
      ->add_option("--after", flags->after,
                   "DEPTH,MIN,INTERVAL[,GAS]: an earlier dive and the surface interval after it, "
                   "minutes; repeat for more, oldest first")
      ->expected(1)
      ->take_all();
  command->add_option("--gf", flags->gf, "gradient factors low/high, percent")
      ->capture_default_str();
  command
      ->add_option(
          "--convention", flags->convention,
          "stop-minutes, run-minutes or msw: rules in which planners differ (diver/README.md)")
      ->capture_default_str();
  command->add_option("--table", flags->table,
                      "ZH-L16 coefficients b or c (default: the convention's, b of stop-minutes)");
  command->add_option("--altitude", flags->altitude_m,
                      "altitude of the dive site, metres; the diver is acclimatised");
  command->add_option("--surface", flags->surface_bar,
                      "pressure at the surface, bar, instead of --altitude");
  command->add_option("--water", flags->water, "fresh, salt, en13319, or a density in kg/m3");
  command->add_option("--last-stop", flags->last_stop_m, "depth of the last stop, metres");
  command->add_option("--ascent-rate", flags->ascent_m_min, "m/min");
  command->add_option("--descent-rate", flags->descent_m_min, "m/min");
  command->add_option("--saturation", flags->saturation,
                      "speed of gas uptake and release, percent of the model's: 110/90");
  command
      ->add_option("--rmv,--sac", flags->rmv,
                   "breathing, litres per minute at ambient pressure: at the bottom, and from the "
                   "ascent on; or one number for both")
      ->capture_default_str();
  command
      ->add_option("--minimum-gas", flags->minimum_gas,
                   "DIVERS,TIMES,MIN: minimum gas brings up this number of divers, each breathing "
                   "TIMES --rmv, after MIN minutes at depth")
      ->capture_default_str();
  command
      ->add_option("--tank", flags->tanks,
                   "GAS=LITRES,BAR: a tank and its pressure, such as 18/45=24,232; for twins the "
                   "sum of both volumes")
      ->expected(1)
      ->take_all();
  command->add_option("--log", flags->log,
                      "instead of a plan: replays the depths of a dive (.csv: time_s, depth_m, "
                      "optionally gas) on the dive computer");
  command->add_option("--vehicle", flags->vehicle,
                      "with --log: the participant whose rows are used, by the column vehicle");
  command->add_flag("--depths-up", flags->depths_up,
                    "with --log: its depths are negative below the surface");
  command->add_option("--plot", flags->plot, "file of the picture (.png)")->check(png_file);
  command
      ->add_option(
          "--out", flags->out,
          "folder for plan.json and plan.png, or log.csv and log.png, and the picture's data")
      ->check(named);
  command->add_flag("--json", flags->json, "JSON on standard output, for programs");
  command->callback([flags, &run] { run = [flags] { return run_plan(*flags); }; });
}

void add_physio(CLI::App& app, Run& run) {
  auto flags = std::make_shared<PhysioFlags>();
  CLI::App* command = app.add_subcommand("physio",
                                         "finds heart beats, breaths or eye movements in a "
                                         "recording; gives a table, JSON or a picture");
  command->add_option("what", flags->what, "ecg, breath or gaze")->required();
  command->add_option("file", flags->file, ".csv, .wav or a WFDB record (.hea, .dat)")->required();
  command->add_option(
      "--channel", flags->channel,
      "the channel, if there are several: its number from 0, or its name (.csv, WFDB)");
  command
      ->add_option("--rate", flags->rate_hz, "samples per second of a .csv without a time column")
      ->check(between(0.1, 1e6));
  command->add_option(
      "--annotations", flags->annotations,
      "ecg: file of marked beats (.atr) to compare with (default: the record's own, if present)");
  command
      ->add_option("--estimator", flags->estimator,
                   "breath: multiband, autocorrelation or spectrum (the published method)")
      ->capture_default_str();
  command->add_option("--window", flags->window_s,
                      "breath: seconds of sound that an estimate uses");
  command->add_option("--reference", flags->reference_bpm,
                      "breath: the true rate, breaths a minute, to compare with (default: from a "
                      "file name such as ..._12bpm_...)");
  command->add_flag(
      "--realtime", flags->realtime,
      "breath: plays the recording at its own pace, with recording and analysis on two threads");
  command->add_option("--method", flags->method,
                      "gaze: ivt (30 deg/s; the default) or idt (1 deg, 100 ms)");
  command->add_flag("--headset", flags->headset,
                    "gaze: idt with 250 ms, for the slow sampling of headsets");
  command->add_option("--intrinsics", flags->intrinsics,
                      "gaze: fx,fy,cx,cy of a camera at the eye; adds each fixation in its pixels");
  command->add_option("--out", flags->out, "folder for the table and the JSON");
  command->add_option("--plot", flags->plot, "file of the picture (.png)")->check(png_file);
  command->add_flag("--table", flags->table,
                    "each beat, estimate or eye movement on standard output too (.csv)");
  command->add_flag("--json", flags->json, "JSON on standard output instead of the summary");
  command->callback([flags, &run] { run = [flags] { return run_physio(*flags); }; });
}

void add_register(CLI::App& app, Run& run) {
  auto flags = std::make_shared<RegisterFlags>();
  CLI::App* command = app.add_subcommand(
      "register",
      "finds where a lab's tracking frame lies in a scene, from places that are marked in both");
  command
      ->add_option("file", flags->file,
                   "table (.csv) with columns lab_x_m, lab_y_m, lab_z_m, scene_x_m, scene_y_m, "
                   "scene_z_m; a row a place, at least 2, with --tilted 3; with --headset the last "
                   "three alone")
      ->required();
  command->add_flag("--headset", flags->headset,
                    "measures the lab's side: hold the headset still at each place in turn, the "
                    "same way round, for 2 s (docs/headsets.md)");
  command
      ->add_option("--lab-up", flags->lab_up, "the lab's vertical axis: y (headsets) or z (suits)")
      ->check(CLI::IsMember({"y", "z"}))
      ->capture_default_str();
  command->add_flag("--tilted", flags->tilted, "the lab's vertical is not the scene's: any turn");
  command->add_flag("--json", flags->json, "JSON on standard output, for programs");
  command->footer("Example: neritic register marks.csv >> scene.toml");
  command->callback(
      [flags, &run] { run = [flags] { return nothing_to_say(run_register(*flags)); }; });
}

void add_experiment(CLI::App& app, CommandLine& line) {
  auto flags = std::make_shared<ExperimentFlags>();
  CLI::App* command = app.add_subcommand(
      "experiment", "runs a scenario many times and reports its numbers with confidence intervals");
  command
      ->add_option(
          "name", flags->name,
          "imaging, profiling, echo_sounder, shark or another of assets/experiments, all, or "
          "a scenario (.toml) of your own: tools/experiment/README.md")
      ->required();
  command
      ->add_option("--out", flags->out,
                   "folder for runs.jsonl, runs.csv, results.json, report.html")
      ->required();
  command->add_option("--runs", flags->runs, "runs of each condition, in place of the scenario's");
  command->add_option("--seed", flags->seed, "seed of the first run, in place of the scenario's");
  command->add_option(
      "--set", flags->set,
      "KEY=VALUE: a setting in place of the scenario's; a list [A, B] makes conditions");
  command->add_option("--workers", flags->workers, "runs at once; 0: as many as cores");
  command->add_flag("--resume", flags->resume, "keeps the finished runs that --out has");
  command->add_flag("--json", flags->json, "JSON on standard output, for programs");
  command->footer("Example: neritic experiment echo_sounder --out out/echo --set slope_deg=[0,8]");
  command->callback([flags, &line] {
    flags->quiet = line.quiet;
    line.run = [flags] { return nothing_to_say(run_experiment(*flags)); };
  });
}

void add_study(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand(
      "study", "runs a study with people: consent, blocks in balanced order, questionnaires");
  command->prefix_command();  // the module reads all that follows
  command->allow_extras();
  command->footer(
      "neritic study begin FOLDER --plan FILE.toml   a new study\n"
      "neritic study enrol FOLDER                    consent; gives a pseudonym and an order\n"
      "neritic study run FOLDER P01                  the blocks that P01 has yet to do\n"
      "neritic study ask FOLDER P01 nasa_tlx         one questionnaire (nasa_tlx, ssq, presence, "
      "trust)\n"
      "neritic study mark FOLDER P01 TEXT            a marker at this moment\n"
      "neritic study withdraw FOLDER P01             erases what P01 left, and nothing else\n"
      "neritic study table FOLDER                    all answers and scores, by pseudonym\n"
      "tools/experiment/STUDIES.md says the rest");
  command->callback([command, &line] {
    line.run = [words = command->remaining()] { return nothing_to_say(run_study(words)); };
  });
}

void add_recording(CLI::App& app, Run& run) {
  auto flags = std::make_shared<RecordingFlags>();
  CLI::App* command = app.add_subcommand(
      "recording", "looks into a recording of a dive (.mcap), mends it, exports what it holds");
  command
      ->add_option("what", flags->what,
                   "info: what it holds; check: whether it is whole; repair: what reads of a "
                   "damaged one as a whole one; export: its messages in other forms")
      ->required();
  command->add_option("file", flags->file, "the recording")->required();
  command->add_option("--out", flags->out, "repair: the new file; export: a folder")->check(named);
  command
      ->add_option("--format", flags->format,
                   "export: csv (default) and npy, a file a topic; xdf, one of all numbers, for "
                   "physiology; wav of sound; png of cameras and sonars")
      ->check(CLI::IsMember({"csv", "npy", "xdf", "wav", "png"}));
  command->add_option("--topic", flags->topics, "export: only this topic; may be given again")
      ->expected(1)
      ->take_all();
  command->add_flag("--json", flags->json, "info: JSON on standard output, for programs");
  command->footer("Example: neritic recording export dive.mcap --out tables --topic /rov/imu");
  command->callback([flags, &run] { run = [flags] { return run_recording(*flags); }; });
}

void add_hud(CLI::App& app, Run& run) {
  auto flags = std::make_shared<HudFlags>();
  CLI::App* command = app.add_subcommand(
      "hud",
      "shows a diver's instruments over any other OpenXR program (XR_EXTX_overlay), from a dive "
      "that was recorded or runs elsewhere");
  command->add_option("scene", flags->scene,
                      "scene (.toml) of the dive, where it is not the recording's own");
  auto* from = command->add_option_group("where the numbers come from");
  from->add_option("--replay", flags->replay,
                   "a recording (dive --record), at the pace of the dive");
  from->add_option("--connect", flags->connect,
                   "a dive that runs (serve, dive --serve): tcp://ADDRESS:PORT");
  from->require_option(1);
  command->add_option("--key", flags->key,
                      "with --connect: NAME.secret of `neritic keys`, for a server with keys");
  command->add_option("--server-key", flags->server_key,
                      "server.public, where it is not beside NAME.secret");
  command->add_option("--hud", flags->layouts,
                      "any of mask (default), corner, wrist, console, with commas between");
  command->add_option("--diver", flags->diver, "whose instruments (default: the first diver)");
  command->add_option("--units", flags->units, "metric (default), imperial")
      ->check(CLI::IsMember({"metric", "imperial"}));
  command->add_option("--frames", flags->frames, "stop after so many frames that are seen")
      ->check(between(1, 1000000));
  command->add_flag("--validate", flags->validation,
                    "fail if Vulkan's validation layer says anything");
  command->footer(
      "Examples: neritic hud --replay dive.mcap --hud mask,wrist\n"
      "          neritic hud --connect tcp://192.168.1.20:47910 --key ada.secret");
  command->callback([flags, &run] { run = [flags] { return nothing_to_say(run_hud(*flags)); }; });
}

void add_serve(CLI::App& app, CommandLine& line) {
  auto flags = std::make_shared<ServeFlags>();
  CLI::App* command = app.add_subcommand(
      "serve", "a scene for clients: Python's neritic.connect, other machines (neritic keys)");
  command->add_option("scene", flags->scene, "scene file")->required();
  command
      ->add_option("--bind", flags->bind,
                   "where it listens: tcp://ADDRESS:PORT; beyond 127.x.x.x with --keys")
      ->capture_default_str();
  command->add_option("--keys", flags->keys, "folder of keys: others are not heard (neritic keys)");
  CLI::Option* real_time = command->add_flag("--realtime", flags->real_time,
                                             "goes on by itself, at the host's pace; nobody ticks");
  command
      ->add_flag("--lockstep", flags->lock_step,
                 "goes on when a client ticks, as far as it says (the default)")
      ->excludes(real_time);
  command->add_option("--clients", flags->clients, "most clients at a time")
      ->capture_default_str()
      ->check(between(1u, 4096u));
  command->add_option("--seconds", flags->seconds, "ends after so much simulated time")
      ->check(between(1e-3, 1e9));
  command->add_option("--seed", flags->seed, "instead of the scene's")->check(seed_number);
  command->add_option("--record", flags->record, "records the whole run, for dive --replay");
  command->add_option("--recordings", flags->recordings,
                      "folder in which clients may record; without it they may not");
  command->add_flag("--no-shared-memory", flags->no_shared_memory,
                    "arrays as frames, also for clients on this machine");
  command->add_option("--device", flags->device, "Vulkan device: index or part of its name");
  command->add_flag("--validation", flags->validation, "checks every Vulkan call; slow");
  command->callback([flags, &line] {
    flags->quiet = line.quiet;
    line.run = [flags] { return nothing_to_say(run_serve(*flags)); };
  });
}

void add_keys(CLI::App& app, Run& run) {
  auto flags = std::make_shared<KeysFlags>();
  CLI::App* command =
      app.add_subcommand("keys", "makes the keys of a server and of its clients (CURVE)");
  command->add_option("folder", flags->folder, "folder of keys; what is there stays")
      ->required()
      ->check(named);
  command->add_option("--client", flags->client,
                      "a client that may connect; goes with its secret to its machine");
  command->callback([flags, &run] { run = [flags] { return run_keys(*flags); }; });
}

void add_simulate(CLI::App& app, CommandLine& line) {
  auto flags = std::make_shared<SimulateFlags>();
  CLI::App* command = app.add_subcommand("simulate",
                                         "sends the bytes of a lab's devices: those of a scene's "
                                         "[sources], worn by a person who swims "
                                         "by himself, or recordings (docs/devices.md)");
  command
      ->add_option(
          "what", flags->what,
          "suit, strap, jacket, microphone or a source's name, one or more: sends to a "
          "dive that runs elsewhere. lab: a dive and all of its devices in simulated "
          "time. flood: a dive under --rate packets a second. latency: from a suit's packet to "
          "the picture that shows it")
      ->required();
  command->add_option("--scene", flags->scene, "scene with [sources]")->capture_default_str();
  command->add_option("--to", flags->to,
                      "IPv4 address of the machine that listens, else as the "
                      "scene says");
  command->add_option("--seconds", flags->seconds,
                      "how long: devices until Ctrl-C, lab and flood 60");
  command->add_option("--delay-ms", flags->delay_ms, "of every packet");
  command->add_option("--jitter-ms", flags->jitter_ms,
                      "evenly up to this much more, so that packets overtake one another");
  command->add_option("--loss", flags->loss, "percent of packets");
  command->add_option("--repeat", flags->repeat, "percent that come twice");
  command->add_option("--cut", flags->cut, "percent that are cut short");
  command->add_option("--corrupt", flags->corrupt, "percent with a wrong bit");
  command->add_option("--garbage", flags->garbage, "percent that are random bytes");
  command->add_option("--seed", flags->seed, "of faults, clocks and noise")->check(seed_number);
  command->add_option("--limbs", flags->limbs, "suit: joint angles (.csv, as swim.motion)");
  command->add_option("--buttons", flags->buttons, "jacket: presses (.csv, as jacket_buttons)");
  command->add_option("--ecg", flags->ecg, "strap: a recording in uV (.csv, .wav, .hea)");
  command->add_option("--sound", flags->sound, "microphone: a recording (.wav)");
  command->add_option("--suit-hz", flags->suit_hz, "frames a second")->capture_default_str();
  command->add_flag("--no-gloves", flags->no_gloves, "the suit without fingers");
  command->add_option("--rate", flags->rate_hz, "flood: packets a second")->capture_default_str();
  command->add_option("--picture-hz", flags->picture_hz,
                      "latency: pictures a second, else the first camera's rate");
  command->add_option("--size", flags->size, "latency: WxH of the pictures [320x180]");
  command->add_option("--device", flags->device,
                      "latency: Vulkan device: index or part of its name");
  command->add_option("--record", flags->files.record,
                      "lab: every sample and state (neritic dive --replay)");
  command->add_option("--log", flags->files.log, "lab: the dive as a .csv");
  command->add_flag("--json", flags->json,
                    "lab, flood, latency: JSON on standard output, for programs");
  command->callback([flags, &line] {
    flags->quiet = line.quiet;
    line.run = [flags] { return nothing_to_say(run_simulate(*flags)); };
  });
}

void add_doctor(CLI::App& app, Run& run) {
  auto flags = std::make_shared<DoctorFlags>();
  CLI::App* command =
      app.add_subcommand("doctor", "reports what this machine has and which commands work on it");
  command->add_option("--device", flags->device, "Vulkan device: index or part of its name");
  command->add_flag("--json", flags->json, "JSON on standard output, for programs");
  command->callback(
      [flags, &run] { run = [flags] { return nothing_to_say(run_doctor(*flags)); }; });
}

// The parser's words, but where it says less than is known: what a flag wants that was given
// something else, and the flag that is nearest to one that there is not.
std::string what_was_wrong(const CLI::App& app, const CLI::App& command,
                           const std::vector<std::string>& arguments,
                           const CLI::ParseError& error) {
  const std::string said = error.what(), unconverted = "Could not convert: ";
  if (const std::size_t value = said.find(" = ");
      said.starts_with(unconverted) && value != said.npos) {
    const std::string name = said.substr(unconverted.size(), value - unconverted.size());
    if (const CLI::Option* option = command.get_option_no_throw(name))
      return refusal(name, fmt::format("'{}'", printable(said.substr(value + 3))),
                     fmt::format("a number: {}", option->get_description()))
          .message;
  }
  // "--offset: At least 3 required but received 2"
  const std::size_t least = said.find(": At least "), got = said.find(" required but received ");
  if (least != said.npos && got != said.npos) {
    const std::string name = said.substr(0, least);
    if (const CLI::Option* option = command.get_option_no_throw(name))
      return refusal(name,
                     fmt::format("{} of {} values", said.substr(got + 23),
                                 said.substr(least + 11, got - least - 11)),
                     option->get_description())
          .message;
  }
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError)) return said;
  std::vector<std::string> names;
  for (const CLI::App* of : {&command, &app})
    for (const CLI::Option* option : of->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (!name.starts_with("--") || name == "--" || std::ranges::find(names, name) != names.end())
      continue;
    return fmt::format("{}: no such flag; the nearest is {}", printable(name),
                       nearest(name, std::vector<std::string_view>(names.begin(), names.end())));
  }
  return said;
}

}  // namespace

Result<CommandLine> parse_command_line(const std::vector<std::string>& arguments) {
  CLI::App app{"Neritic: divers and underwater robots together in one simulated sea", "neritic"};
  app.require_subcommand(1);
  app.fallthrough();
  CommandLine line;
  app.set_version_flag("--version", std::string(program_version()));
  app.add_flag("-v,--verbose", line.verbose,
               "also prints on stderr what is loaded, chosen and compiled");
  app.add_flag("-q,--quiet", line.quiet, "no notes, and no summary of a dive but --json");
  add_render(app, line.run);
  add_sonar(app, line.run);
  add_dive(app, line);
  add_serve(app, line);
  add_keys(app, line.run);
  add_tradeoff(app, line.run);
  add_check(app, line.run);
  add_plan(app, line.run);
  add_physio(app, line.run);
  add_register(app, line.run);
  add_experiment(app, line);
  add_study(app, line);
  add_recording(app, line.run);
  add_hud(app, line.run);
  add_simulate(app, line);
  add_doctor(app, line.run);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(),
                                       arguments.rend()));  // back to front, as it wants them
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    line.help = chosen.empty() ? app.help() : chosen.front()->help(app.get_name());
  } catch (const CLI::CallForVersion& version) {
    line.help = std::string(version.what()) + "\n";
  } catch (const CLI::ParseError& error) {
    if (app.get_subcommands().empty() && !arguments.empty() && !arguments[0].starts_with('-')) {
      std::string names;
      for (const CLI::App* command : app.get_subcommands(nullptr))
        names += (names.empty() ? "" : ", ") + command->get_name();
      return refusal("", fmt::format("command '{}'", arguments[0]), fmt::format("{}", names));
    }
    const auto chosen = app.get_subcommands();
    const CLI::App& command = chosen.empty() ? app : *chosen.front();
    return bad_input("{} (see neritic {}--help)", what_was_wrong(app, command, arguments, error),
                     chosen.empty() ? "" : command.get_name() + " ");
  }
  return line;
}

}  // namespace neritic::tools
