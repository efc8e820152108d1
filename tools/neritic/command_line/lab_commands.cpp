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
  command->add_option("--seed", flags->seed, "seed of the first run, in place of the scenario's")
      ->check(seed_number);
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
  command->fallthrough(false);  // else the program takes them for its own
  command->footer(
      "neritic study begin FOLDER --plan FILE.toml   a new study\n"
      "neritic study enrol FOLDER                    consent; gives a pseudonym and an order\n"
      "neritic study run FOLDER P01                  the blocks that P01 has yet to do\n"
      "neritic study ask FOLDER P01 nasa_tlx         one questionnaire (nasa_tlx, ssq, presence, "
      "trust)\n"
      "neritic study mark FOLDER P01 TEXT            a marker at this moment\n"
      "neritic study withdraw FOLDER P01             erases what P01 left, and nothing else\n"
      "neritic study table FOLDER                    the scores of run's questionnaires, by "
      "pseudonym\n"
      "neritic study wizard FOLDER P01               a console that flies the robot of a served "
      "dive\n"
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

void add_doctor(CLI::App& app, Run& run) {
  auto flags = std::make_shared<DoctorFlags>();
  CLI::App* command =
      app.add_subcommand("doctor", "reports what this machine has and which commands work on it");
  command->add_option("--device", flags->device, "Vulkan device: index or part of its name");
  command->add_flag("--json", flags->json, "JSON on standard output, for programs");
  command->callback(
      [flags, &run] { run = [flags] { return nothing_to_say(run_doctor(*flags)); }; });
}

}  // namespace neritic::tools
