// The flags of the commands about a person's dive: plan, physio, hud.
#include <memory>

#include "tools/neritic/command_line/shared_flags.hpp"
#include "tools/neritic/command_line/subcommands.hpp"

namespace neritic::tools {

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
                   "leaves it; may be repeated")
      ->expected(1)
      ->take_all();
  command
      ->add_option("--after", flags->after,
                   "DEPTH,MIN,INTERVAL[,GAS]: an earlier dive and the surface interval after it, "
                   "minutes; may be repeated, oldest first")
      ->expected(1)
      ->take_all();
  command->add_option("--gf", flags->gf, "gradient factors low/high, percent")
      ->capture_default_str();
  command
      ->add_option("--convention", flags->convention,
                   "stop-minutes, run-minutes or msw: named sets of rules in which planners differ "
                   "(diver/README.md)")
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
                      "speed of gas uptake and release, percent of the model's, such as 110/90");
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
                      "with --log: uses the rows of this participant (column vehicle)");
  command->add_flag("--depths-up", flags->depths_up,
                    "with --log: depths are negative below the surface");
  command->add_option("--plot", flags->plot, "writes the picture to this file (.png)")
      ->check(png_file);
  command
      ->add_option(
          "--out", flags->out,
          "folder for plan.json and plan.png, or log.csv and log.png, and the picture's data")
      ->check(named);
  command->add_flag("--json", flags->json, "prints JSON on standard output");
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
  command->add_option("--window", flags->window_s, "breath: seconds of sound for one estimate");
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
  command->add_option(
      "--intrinsics", flags->intrinsics,
      "gaze: fx,fy,cx,cy of a camera at the eye; adds each fixation's place in its pixels");
  command->add_option("--out", flags->out, "folder for the table and the JSON");
  command->add_option("--plot", flags->plot, "writes the picture to this file (.png)")
      ->check(png_file);
  command->add_flag("--table", flags->table,
                    "prints each beat, estimate or eye movement on standard output, too (.csv)");
  command->add_flag("--json", flags->json, "prints JSON on standard output instead of the summary");
  command->callback([flags, &run] { run = [flags] { return run_physio(*flags); }; });
}

void add_hud(CLI::App& app, Run& run) {
  auto flags = std::make_shared<HudFlags>();
  CLI::App* command =
      app.add_subcommand("hud",
                         "shows a diver's instruments over any other OpenXR program "
                         "(XR_EXTX_overlay), from a recorded or a running dive");
  command->add_option("scene", flags->scene,
                      "scene (.toml) of the dive, if it is not the recorded one");
  auto* from = command->add_option_group("where the numbers come from");
  from->add_option("--replay", flags->replay,
                   "a recording (dive --record), shown at the pace of the dive");
  from->add_option("--connect", flags->connect,
                   "a running dive (serve, dive --serve): tcp://ADDRESS:PORT");
  from->require_option(1);
  command->add_option("--key", flags->key,
                      "with --connect to a server with keys: NAME.secret of `neritic keys`");
  command->add_option("--server-key", flags->server_key,
                      "server.public, if it is not beside NAME.secret");
  command->add_option("--hud", flags->layouts,
                      "any of mask (default), corner, wrist, console, separated by commas");
  command->add_option("--diver", flags->diver, "whose instruments (default: the first diver)");
  command->add_option("--units", flags->units, "metric (default), imperial")
      ->check(CLI::IsMember({"metric", "imperial"}));
  command->add_option("--frames", flags->frames, "stops after this number of visible frames")
      ->check(between(1, 1000000));
  command->add_flag("--validate", flags->validation,
                    "runs with Vulkan validation; any message is a failure");
  command->footer(
      "Examples: neritic hud --replay dive.mcap --hud mask,wrist\n"
      "          neritic hud --connect tcp://192.168.1.20:47910 --key ada.secret");
  command->callback([flags, &run] { run = [flags] { return nothing_to_say(run_hud(*flags)); }; });
}

}  // namespace neritic::tools
