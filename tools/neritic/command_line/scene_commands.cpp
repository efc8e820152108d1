// The flags of the commands that show a scene: render and dive.
#include <memory>

#include "engine/core/text.hpp"
#include "engine/scene/scene.hpp"
#include "testbed/output/datasets.hpp"
#include "tools/neritic/command_line/shared_flags.hpp"
#include "tools/neritic/command_line/subcommands.hpp"

namespace neritic::tools {

void add_render(CLI::App& app, Run& run) {
  auto flags = std::make_shared<RenderFlags>();
  CLI::App* command = app.add_subcommand(
      "render",
      "renders pictures and sensor data of a scene (.toml) or a model (.gltf, .glb), offscreen");
  command->add_option("scene", flags->scene,
                      "scene or model file; with --replay the recorded scene if none is given");
  command
      ->add_option("--out", flags->out,
                   "folder for the results: OUT/frame_0000/SENSOR has pictures (.png), arrays "
                   "(.npy) and facts (.json), OUT/track what sonars accumulate over frames")
      ->required()
      ->check(named);
  command
      ->add_option(
          "--frames", flags->frames,
          "number of frames (default: 1; with --replay as many as it lasts), at the rate_hz of the "
          "first camera, else of the first sonar; with --own-rates of the fastest sensor")
      ->check(between(1, 1000000));
  command->add_option("--size", flags->size, "WxH of every camera, pixels");
  command->add_option(
      "--time", flags->time_s,
      "scene time of the first frame, seconds (at most a day in scenes with physics)");
  command->add_option("--clip", flags->clip,
                      "of a model: its animation, by name or number from 0 (default: the first); "
                      "it repeats, and --time is its time");
  command->add_option("--sensor", flags->sensors, "only this sensor, by name; may be repeated")
      ->expected(1)
      ->take_all();
  command
      ->add_option("--only", flags->only,
                   fmt::format("writes, and computes, these data alone, of each sensor that gives "
                               "them: {}; coco: boxes and masks of all cameras (OUT/coco.json); "
                               "linear, raw: of cameras that name them; boxes, kitti, panoptic: "
                               "only if named here (OUT/kitti, OUT/panoptic.json); "
                               "trajectory: where every participant is (OUT/trajectory.csv and "
                               "OUT/trajectory)",
                               join(testbed::kDatasetNames)))
      ->expected(1)
      ->take_all();
  command
      ->add_option(
          "--compress", flags->compress,
          "form of arrays: npz (lossless; numpy.load reads it), or png (16 bits a channel: labels, "
          "instances, depth in mm up to 65.534 m, normals as colours; others .npz)")
      ->check(CLI::IsMember({"npz", "png"}));
  command->add_option(
      "--water", flags->water,
      fmt::format("another Jerlov type than the scene's: {}", join(scene::kWaterTypes)));
  add_replay(*command, flags->replay, flags->shown, flags->added);
  command
      ->add_option("--offset", flags->offset_m,
                   "moves the whole world by x y z metres; what repeats over the sea (waves, "
                   "caustics, snow) stays")
      ->expected(3);
  command->add_option("--device", flags->device, "Vulkan device: index or part of its name");
  command->add_option(
      "--dump-graph", flags->dump_graph,
      "writes the frame graph's plan to a file (.dot: Graphviz), or to standard output (-)");
  command
      ->add_option("--chart-cell", flags->chart_cell_m,
                   "metres a cell of the charts of profiling sonars")
      ->check(between(0.001, 1000.0));
  add_quality(*command, flags->quality);
  command
      ->add_option("--picture-quality", flags->picture_quality,
                   "how finely pictures are made, for what the cameras' quality, max_error and "
                   "detail say (engine/render/TRADE.md)")
      ->check(CLI::IsMember(std::vector<std::string>(std::begin(scene::kPictureLevels),
                                                     std::end(scene::kPictureLevels))));
  command->add_flag("--track-only", flags->track_only,
                    "no frame folders: only what sonars accumulate over the frames (OUT/track)");
  command->add_flag(
      "--own-rates", flags->own_rates,
      "each sensor only in the frames in which its rate_hz makes it due (default: in all)");
  command->add_option("--log", flags->files.log,
                      "the log of vehicles and divers that move by physics, as a .csv");
  command->add_option("--log-rate", flags->files.log_rate_hz,
                      "rows a second of the log (default: one a control period)");
  command
      ->add_option(
          "--seed", flags->seed,
          "seed of the sensors' noise, instead of the scene's; scattered objects keep their places")
      ->check(seed_number);
  command
      ->add_option("--runs", flags->runs,
                   "number of runs, with the seeds from --seed on, into OUT/run_0000 and on; a "
                   "table of outcomes if missions end")
      ->check(between(1, 100000));
  command->add_flag(
      "--sheet", flags->sheet,
      "also pictures of what each sensor sees and of the first camera's depth, normals, labels and "
      "motion (OUT/sheet), and all of them on one sheet (OUT/sheet.png)");
  command->add_flag("--validate", flags->validation,
                    "runs with Vulkan validation; any message is a failure");
  command->callback([flags, &run] { run = [flags] { return run_render(*flags); }; });
}

void add_dive(CLI::App& app, CommandLine& line) {
  auto flags = std::make_shared<DiveFlags>();
  CLI::App* command = app.add_subcommand("dive",
                                         "shows a scene (.toml) or a model (.gltf, .glb) live, in "
                                         "a headset or a window; F1 lists the keys");
  command->add_option("scene", flags->scene,
                      "scene or model file; with --replay the recorded scene if none is given");
  command->add_flag(
      "--headless", flags->headless,
      "no window. In scenes with physics, if no flag asks for pictures: the dive alone, as fast as "
      "possible; else frames at the camera's rate, then a summary of their times");
  command
      ->add_option("--display", flags->display,
                   "openxr: a headset; window: a window; auto: a headset if an OpenXR runtime has "
                   "one, else a window")
      ->check(CLI::IsMember({"auto", "openxr", "window"}));
  command->add_option("--bindings", flags->bindings,
                      "your own controls of some actions, a .toml (docs/headsets.md)");
  command->add_flag(
      "--operator", flags->operator_window,
      "beside a headset: a window with the wearer's view and the operator's panels and "
      "keys");
  command->add_option("--refresh", flags->refresh_hz, "pictures a second of the headset")
      ->check(between(1.0, 1000.0));
  command->add_option("--log", flags->files.log, "the log of vehicles and divers as a .csv");
  command->add_option(
      "--log-rate", flags->files.log_rate_hz,
      "rows a second of the log (default: one a control period of vehicles, ten of divers)");
  command
      ->add_option("--plot", flags->files.plot,
                   "a picture of the dive (.png), with its data as .plot.json; it needs matplotlib "
                   "(tools/setup plots)")
      ->check(png_file);
  command->add_option("--record", flags->files.record,
                      "records every sample in and out, state hashes and the scene as an .mcap, "
                      "which --replay and ROS 2 tools read (neritic recording --help); F.xdf: also "
                      "F.mcap; the .xdf has all numbers for physiology labs");
  command
      ->add_option("--record-images", flags->record_images,
                   "with --record: also these images, such as rov_camera/color or rov_sonar/echoes "
                   "(depth, normals, labels, instances, motion); may be repeated. `render "
                   "--replay` can make them later instead")
      ->expected(1)
      ->take_all();
  command->add_option("--play", flags->play,
                      "sends the samples of a recorded dive as live ones, to the groups of inputs "
                      "that name their devices");
  add_replay(*command, flags->replay, flags->shown, flags->added);
  command->add_option(
      "--water", flags->water,
      fmt::format("with --replay: another Jerlov type: {}", join(scene::kWaterTypes)));
  command->add_option("--save", flags->files.save, "file for the state at the end, for --restore");
  command->add_option("--restore", flags->restore,
                      "continues from a saved state of the same scene, for --seconds more");
  command
      ->add_option(
          "--seed", flags->seed,
          "seed of the sensors' noise, instead of the scene's; scattered objects keep their places")
      ->check(seed_number);
  command
      ->add_option("--runs", flags->runs,
                   "with --headless: number of dives, with the seeds from --seed on, until the "
                   "missions of vehicles and plans of divers are done; a table of outcomes")
      ->check(between(1, 100000));
  command->add_option("--serve", flags->serve,
                      "lets other programs read and command this dive (neritic serve, hud "
                      "--connect): tcp://ADDRESS:PORT; beyond 127.x.x.x with --keys");
  command->add_option("--keys", flags->keys, "with --serve: folder of keys (neritic keys)");
  command->add_option("--markers", flags->markers,
                      "UDP port for lines of text (neritic study sends them), which go into the "
                      "recording, as /markers, and to Lab Streaming Layer");
  command->add_flag("--realtime", flags->realtime,
                    "physics without pictures, at the pace of the clock");
  command->add_flag("--json", flags->json, "prints the dive's summary as JSON");
  command->add_flag("--fast", flags->fast, "with --headless: frames as fast as possible");
  command->add_flag("--panels", flags->panels, "with --headless: draws the window's panels too");
  command
      ->add_option("--timeline", flags->timeline,
                   "a picture (.png) of the frames' phases, passes and resolution, with its data "
                   "as .plot.json")
      ->check(png_file);
  command->add_option("--hud", flags->hud,
                      "a diver's instruments over the view: none, or any of corner, mask, wrist, "
                      "console (in a window alone; default of a scene with divers: corner in a "
                      "window, wrist in a headset; key H)");
  command->add_option("--diver", flags->diver, "whose instruments (default: the first diver)");
  command
      ->add_option("--units", flags->units, "units of the instruments: metric (default), imperial")
      ->check(CLI::IsMember({"metric", "imperial"}));
  command
      ->add_option("--quality", flags->quality,
                   "auto: if the machine is too slow for its screen (a CPU: for 20 pictures a "
                   "second), lowers resolution, then shadows, occlusion, waves, scatter and "
                   "particles, then sonars' rates, and says so in the panel; a CPU begins low "
                   "(default in a window); full: never")
      ->check(CLI::IsMember({"auto", "full"}));
  command->add_option("--seconds", flags->seconds,
                      "stops after this simulated time (default with --headless: 60 of physics "
                      "alone, 5 of frames). Exit status 1 if a mission is not finished in a time "
                      "that suffices for its way at its speed, a vehicle or diver comes no nearer "
                      "to a waypoint for 20 s, or a vehicle ends more than 2 m off its station, "
                      "orbit or whom it follows, and --save is not given");
  command->add_option("--frames", flags->frames, "stops after this number of frames")
      ->check(between(1, 1000000));
  command->add_option("--screenshot", flags->screenshot, "writes the last frame to this .png")
      ->check(png_file);
  command->add_option("--size", flags->size, "WxH of the window or the picture, pixels");
  command
      ->add_option("--sensor", flags->sensors,
                   "begins at this camera, shows only this sonar, by name; may be repeated")
      ->expected(1)
      ->take_all();
  command->add_option(
      "--view", flags->view,
      "begins at this view: a camera's name, chase:PARTICIPANT or free (key V changes it)");
  command->add_flag(
      "--swim", flags->swim,
      "in a window: begins in the view of a camera on the first diver, else behind the "
      "diver, whom the keys swim at once, as after key P; a scene without divers gets one at its "
      "first view");
  command->add_option("--task", flags->task,
                      "in a window: what the person is to do, shown in place of the operator's "
                      "panels (F2 shows those); the window's looks are not kept");
  command->add_option("--device", flags->device, "Vulkan device: index or part of its name");
  command->add_flag("--validate", flags->validation,
                    "runs with Vulkan validation; any message is a failure");
  // The flags of all commands are read by then.
  command->callback([flags, &line] {
    flags->quiet = line.quiet;
    line.run = [flags] { return nothing_to_say(run_dive(*flags)); };
  });
}

}  // namespace neritic::tools
