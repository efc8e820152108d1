// The flags of the commands that connect programs, machines and devices: serve, keys, simulate,
// register; of those about many runs, people or recorded runs: experiment, study, recording; and of
// doctor.
#include <memory>

#include "tools/neritic/command_line/shared_flags.hpp"
#include "tools/neritic/command_line/subcommands.hpp"

namespace neritic::tools {

void add_serve(CLI::App& app, CommandLine& line) {
  auto flags = std::make_shared<ServeFlags>();
  CLI::App* command = app.add_subcommand(
      "serve",
      "runs a scene for clients: Python's neritic.connect, also on other machines (neritic keys)");
  command->add_option("scene", flags->scene, "scene file")->required();
  command
      ->add_option("--bind", flags->bind,
                   "address to listen at: tcp://ADDRESS:PORT; beyond 127.x.x.x with --keys")
      ->capture_default_str();
  command->add_option("--keys", flags->keys,
                      "folder of keys: only clients with a key of it may connect (neritic keys)");
  CLI::Option* real_time =
      command->add_flag("--realtime", flags->real_time,
                        "runs by itself, at the pace of the clock; clients need not tick");
  command
      ->add_flag("--lockstep", flags->lock_step, "runs only as far as a client ticks (the default)")
      ->excludes(real_time);
  command->add_option("--clients", flags->clients, "largest number of clients at a time")
      ->capture_default_str()
      ->check(between(1u, 4096u));
  command->add_option("--seconds", flags->seconds, "ends after this simulated time")
      ->check(between(1e-3, 1e9));
  command->add_option("--seed", flags->seed, "seed instead of the scene's")->check(seed_number);
  command->add_option("--record", flags->record, "records the whole run, for dive --replay");
  command->add_option("--recordings", flags->recordings,
                      "folder in which clients may record; without it they may not");
  command->add_flag("--no-shared-memory", flags->no_shared_memory,
                    "sends arrays as frames, also to clients on this machine");
  command->add_option("--device", flags->device, "Vulkan device: index or part of its name");
  command->add_flag("--validate", flags->validation, "runs with Vulkan validation; slow");
  command->callback([flags, &line] {
    flags->quiet = line.quiet;
    line.run = [flags] { return nothing_to_say(run_serve(*flags)); };
  });
}

void add_keys(CLI::App& app, Run& run) {
  auto flags = std::make_shared<KeysFlags>();
  CLI::App* command =
      app.add_subcommand("keys", "makes the keys of a server and of its clients (CURVE)");
  command->add_option("folder", flags->folder, "folder of keys; keys that are there stay")
      ->required()
      ->check(named);
  command->add_option(
      "--client", flags->client,
      "makes the keys of a client that may connect; copy its secret to its machine");
  command->callback([flags, &run] { run = [flags] { return run_keys(*flags); }; });
}

void add_simulate(CLI::App& app, CommandLine& line) {
  auto flags = std::make_shared<SimulateFlags>();
  CLI::App* command =
      app.add_subcommand("simulate",
                         "sends what a lab's devices send: those of a scene's [sources], on a "
                         "simulated swimmer, or recordings (docs/devices.md)");
  command
      ->add_option(
          "what", flags->what,
          "suit, strap, jacket, microphone, gaze or a source's name, one or more: sends to a "
          "dive that runs elsewhere. lab: a dive with all of its devices in simulated "
          "time. flood: a dive that gets --rate packets a second. latency: measures the "
          "time from a suit's packet to the picture that shows it")
      ->required();
  command->add_option("--scene", flags->scene, "scene with [sources]")->capture_default_str();
  command->add_option("--to", flags->to,
                      "IPv4 address of the machine that listens (default: as the scene says)");
  command->add_option("--seconds", flags->seconds,
                      "duration (default: devices until Ctrl-C, lab and flood 60)");
  command->add_option("--delay-ms", flags->delay_ms, "delay of every packet");
  command->add_option(
      "--jitter-ms", flags->jitter_ms,
      "additional delay, evenly distributed up to this, so that packets overtake one another");
  command->add_option("--loss", flags->loss, "percent of packets that are lost");
  command->add_option("--repeat", flags->repeat, "percent of packets that come twice");
  command->add_option("--cut", flags->cut, "percent of packets that are cut short");
  command->add_option("--corrupt", flags->corrupt, "percent of packets with a wrong bit");
  command->add_option("--garbage", flags->garbage, "percent of packets that are random bytes");
  command->add_option("--seed", flags->seed, "seed of faults, clocks and noise")
      ->check(seed_number);
  command->add_option("--limbs", flags->limbs, "suit: joint angles (.csv, as swim.motion)");
  command->add_option("--buttons", flags->buttons, "jacket: presses (.csv, as jacket_buttons)");
  command->add_option("--ecg", flags->ecg, "strap: a recording in uV (.csv, .wav, .hea)");
  command->add_option("--sound", flags->sound, "microphone: a recording (.wav)");
  command->add_option("--suit-hz", flags->suit_hz, "suit: frames a second")->capture_default_str();
  command->add_flag("--no-gloves", flags->no_gloves, "suit: without fingers");
  command->add_option("--rate", flags->rate_hz, "flood: packets a second")->capture_default_str();
  command->add_option("--picture-hz", flags->picture_hz,
                      "latency: pictures a second (default: the first camera's rate)");
  command->add_option("--size", flags->size, "latency: WxH of the pictures [320x180]");
  command->add_option("--device", flags->device,
                      "latency: Vulkan device: index or part of its name");
  command->add_option("--record", flags->files.record,
                      "lab: records every sample and state (neritic dive --replay)");
  command->add_option("--log", flags->files.log, "lab: the log of the dive as a .csv");
  command->add_flag("--json", flags->json,
                    "lab, flood, latency: JSON on standard output, for programs");
  command->callback([flags, &line] {
    flags->quiet = line.quiet;
    line.run = [flags] { return nothing_to_say(run_simulate(*flags)); };
  });
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
                    "measures the lab's side: hold the headset still at each place in turn for 2 "
                    "s, always turned the same way (docs/headsets.md)");
  command
      ->add_option("--lab-up", flags->lab_up, "the lab's vertical axis: y (headsets) or z (suits)")
      ->check(CLI::IsMember({"y", "z"}))
      ->capture_default_str();
  command->add_flag("--tilted", flags->tilted,
                    "the lab's vertical axis may be tilted against the scene's");
  command->add_flag("--json", flags->json, "prints JSON on standard output");
  command->footer("Example: neritic register marks.csv >> scene.toml");
  command->callback(
      [flags, &run] { run = [flags] { return nothing_to_say(run_register(*flags)); }; });
}

void add_flags_of_runs(CLI::App& command, ExperimentFlags& flags) {
  command.add_option("--runs", flags.runs, "runs of each condition, in place of the scenario's")
      ->check(between(1, 1000000));
  command.add_option("--seed", flags.seed, "seed of the first run, in place of the scenario's")
      ->check(between<std::int64_t>(0, INT64_MAX));  // as a scene's file
  command.add_option("--set", flags.set,
                     "KEY=VALUE: a setting in place of the scenario's; a list [A, B] makes "
                     "conditions; may be repeated");
  command
      .add_option("--workers", flags.workers,
                  "number of runs at the same time; 0: as many as cores")
      ->check(between(0, 1024));
  command.add_flag("--resume", flags.resume, "keeps the finished runs that are in --out");
  command.add_flag("--json", flags.json, "prints JSON on standard output");
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
  add_flags_of_runs(*command, *flags);
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
  command->fallthrough(false);  // else the program takes them for its own
  command->footer(
      "neritic study begin FOLDER --plan FILE.toml   a new study\n"
      "neritic study enrol FOLDER                    consent; gives a pseudonym and an order\n"
      "neritic study run FOLDER P01                  the blocks that P01 has not done yet\n"
      "neritic study ask FOLDER P01 nasa_tlx         one questionnaire (nasa_tlx, ssq, presence, "
      "trust)\n"
      "neritic study mark FOLDER P01 TEXT            a marker at this moment\n"
      "neritic study withdraw FOLDER P01             erases the data of P01 alone\n"
      "neritic study table FOLDER                    the scores of run's questionnaires, by "
      "pseudonym\n"
      "neritic study wizard FOLDER P01               a console that flies the robot of a served "
      "dive;\n"
      "    --robot NAME, --server ADDRESS, --key FILE, --server-key FILE: which robot, and where;\n"
      "    --speak COMMAND: a program that says its phrases\n"
      "More: tools/experiment/STUDIES.md");
  command->callback([command, &line] {
    line.run = [words = command->remaining()] { return nothing_to_say(run_study(words)); };
  });
}

void add_recording(CLI::App& app, Run& run) {
  auto flags = std::make_shared<RecordingFlags>();
  CLI::App* command = app.add_subcommand(
      "recording", "inspects, repairs and exports a recording of a dive (.mcap)");
  command
      ->add_option(
          "what", flags->what,
          "info: prints the content; check: tests whether it is whole; repair: writes the readable "
          "part of a damaged one as a whole one; export: writes its messages in other forms")
      ->required();
  command->add_option("file", flags->file, "the recording")->required();
  command->add_option("--out", flags->out, "repair: the new file; export: a folder")->check(named);
  command
      ->add_option("--format", flags->format,
                   "export: csv (default) and npy: a file a topic; xdf: one file of all numbers, "
                   "for physiology; wav: sound; png: images of cameras and sonars")
      ->check(CLI::IsMember({"csv", "npy", "xdf", "wav", "png"}));
  command->add_option("--topic", flags->topics, "export: only this topic; may be repeated")
      ->expected(1)
      ->take_all();
  command->add_flag("--json", flags->json, "info: prints JSON on standard output");
  command->footer("Example: neritic recording export dive.mcap --out tables --topic /rov/imu");
  command->callback([flags, &run] { run = [flags] { return run_recording(*flags); }; });
}

void add_doctor(CLI::App& app, Run& run) {
  auto flags = std::make_shared<DoctorFlags>();
  CLI::App* command =
      app.add_subcommand("doctor", "reports what this machine has and which commands work on it");
  command->add_option("--device", flags->device, "Vulkan device: index or part of its name");
  command->add_flag("--json", flags->json, "prints JSON on standard output");
  command->callback(
      [flags, &run] { run = [flags] { return nothing_to_say(run_doctor(*flags)); }; });
}

}  // namespace neritic::tools
