// The flags of `neritic sonar`, and of the two that hold models against references: tradeoff and
// check.
#include <memory>

#include "tools/neritic/command_line/shared_flags.hpp"
#include "tools/neritic/command_line/subcommands.hpp"

namespace neritic::tools {

namespace {

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

}  // namespace

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

void add_tradeoff(CLI::App& app, CommandLine& line) {
  auto flags = std::make_shared<TradeoffFlags>();
  CLI::App* command = app.add_subcommand(
      "tradeoff", "measures the error of a model against its cost, over all of its settings");
  command
      ->add_option(
          "what", flags->what,
          "sonar, physics, navigation, swim, deco, physiology, modem, tether, network, xr, camera, "
          "optics or experiment (time to block and success of the task `shark`)")
      ->required();
  command
      ->add_option("--out", flags->out,
                   "folder for the tables (.csv, .md), their pictures and the quality levels")
      ->required()
      ->check(named);
  command
      ->add_option("scene,--scene", flags->scene,
                   "scene. sonar: its first sonar gives the place (none: only scenes with a "
                   "closed-form answer); xr: its first camera is the head (dive.toml); camera: its "
                   "first camera is measured (wreck.toml); network: it has [sources] (lab.toml)")
      ->capture_default_str();
  command->add_option(
      "--kind", flags->kind,
      "sonar: only this kind: imaging, profiling, echosounder, sidescan or mechanical");
  command->add_option("--recordings", flags->recordings,
                      "physiology: also measures the paced breath sounds in this folder (.wav, "
                      "rate in the name: ..._12bpm_...)");
  command->add_option("--device", flags->device, "Vulkan device: part of its name, or its index");
  command->add_flag("--quick", flags->quick,
                    "a fast trial with fewer rays, bins, points, runs and levels; gives no quality "
                    "levels");
  add_flags_of_runs(*command, flags->experiment);
  for (const char* flag : {"--runs", "--seed", "--set", "--workers", "--resume", "--json"})
    command->get_option(flag)->group("Of experiment alone");
  command->callback([flags, &line] {
    flags->experiment.quiet = line.quiet;
    line.run = [flags] { return run_tradeoff(*flags); };
  });
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

}  // namespace neritic::tools
