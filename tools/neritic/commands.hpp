// The subcommands of `neritic`: what each is asked (its flags, as typed) and what does it, one
// source file each. command_line.cpp reads the flags; it alone knows the parser. The text that some
// return says in one line where the results are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::tools {

// The files that a run of physics writes; empty: none.
struct StepFileFlags {
  std::string log, plot, record, save;
  std::optional<double> log_rate_hz;  // absent or 0: the controllers'
};

struct RenderFlags {
  std::string scene, out, size, device, dump_graph, water, clip;
  std::vector<std::string> sensors;
  std::vector<std::string> only;  // lists of datasets; none: all
  std::string compress;           // "npz", "png" or empty
  std::vector<double> offset_m;
  std::string replay, shown;       // a recording whose motion is seen; in another scene
  std::vector<std::string> added;  // files that are merged over the scene
  std::uint32_t frames = 0;        // 0: not given
  double time_s = 0.0;
  bool sheet = false, validation = false;
  double chart_cell_m = 0.0;
  bool track_only = false;  // no frame folders: only what accumulates over the frames
  // Of all sonars, and of all cameras' pictures, for what the scene says; empty: as it says.
  std::string quality, picture_quality;
  bool own_rates = false;  // a sensor is in those frames only in which its rate makes it due
  StepFileFlags files;     // of scenes with physics: the log
  std::optional<std::uint64_t> seed;  // instead of the scene's
  std::uint32_t runs = 0;             // 0: one, straight into out
};
Result<std::string> run_render(const RenderFlags& flags);

// depth, normals, labels, picture: a file, a folder of them or a pattern ("d/*_depth.png").
struct SonarFlags {
  std::string kind = "imaging";
  std::string depth, normals, labels, picture;
  std::filesystem::path sensor, out;
  std::string intrinsics, baseline, camera_pose;
  std::string range, azimuth, elevation, bins;  // empty: the sensor's, else the kind's
  std::string method = "gpu", gather, depth_kind = "planar", axes = "opengl";
  std::string normals_sign = "facing", pixel_centers = "half", device;
  std::string depth_scale = "1", gamma = "1";
  std::string side = "port", backscatter_db = "-27", altitude;
  std::string quality;  // of a sensor with terms; empty: as its file says
  std::uint64_t seed = 1;
  std::uint32_t workers = 0;  // 0: as many as cores
  bool no_pictures = false, overwrite = false, incidence = false, validation = false;
  std::set<std::string> given;  // flags that the user wrote, "--gamma"
};
Result<std::string> run_sonar(const SonarFlags& flags);

struct DiveFlags {
  std::string scene, size, device, screenshot, view;
  std::filesystem::path timeline;
  std::string hud, diver, units = "metric", quality;  // not given: chosen by window or headless
  std::vector<std::string> sensors;
  std::uint64_t frames = 0;
  std::optional<double> seconds;
  bool headless = false, fast = false, panels = false, validation = false;
  std::string display = "auto";  // auto, openxr or window
  double refresh_hz = 0.0;       // of a headset; 0: its own choice
  std::string bindings;          // a file; empty: ours
  // These need a scene with physics; play and realtime also --headless without pictures.
  StepFileFlags files;
  std::string play, replay, restore;
  std::vector<std::string> record_images;  // streams of images for --record
  std::string shown, water;                // of a replay: another scene, another Jerlov type
  std::vector<std::string> added;          // of a replay: files that are merged over the scene
  bool realtime = false, json = false;
  std::optional<std::uint64_t> seed;  // instead of the scene's
  std::optional<std::uint32_t> runs;  // with the seeds from there on
  bool quiet = false;                 // no summary but --json's
  bool operator_window = false;       // beside a headset
  bool swim = false;                  // in a window: the keys swim the first diver at once
  std::string task;                   // in a window: words for the person; empty: none
  std::string serve;                  // an address; empty: not for other programs
  std::string markers;                // a port or an address; empty: none
  std::filesystem::path keys;         // of its clients
};
Status run_dive(const DiveFlags& flags);

struct ServeFlags {
  std::string scene, bind = "tcp://127.0.0.1:47910", device;
  std::filesystem::path keys, recordings, record;  // empty: none
  std::uint32_t clients = 64;
  std::optional<std::uint64_t> seed;
  std::optional<double> seconds;  // of simulated time; absent: until it is stopped
  bool real_time = false, lock_step = false, no_shared_memory = false, validation = false,
       quiet = false;
};
Status run_serve(const ServeFlags& flags);

struct KeysFlags {
  std::filesystem::path folder;
  std::string client;
};
Result<std::string> run_keys(const KeysFlags& flags);

struct ExperimentFlags {
  std::string name, out;
  std::optional<std::uint64_t> runs, seed;
  std::vector<std::string> set;  // KEY=VALUE
  std::uint32_t workers = 0;     // 0: as many as cores
  bool resume = false, json = false, quiet = false;
  bool quick = false;  // of the trade-off: fewer runs and levels
};
// Becomes the Python module tools/experiment: returns only if that cannot be started.
Status run_experiment(const ExperimentFlags& flags);

struct TradeoffFlags {
  std::string what, device, kind, scene = "assets/scenes/harbour.toml";
  std::filesystem::path out, recordings;
  bool quick = false;
  ExperimentFlags experiment;  // of what "experiment" alone
};
Result<std::string> run_tradeoff(const TradeoffFlags& flags);

struct CheckFlags {
  std::string what, file, integrator = "guarded";
  double hz = 240.0;
  bool json = false;
};
Status run_check(const CheckFlags& flags);

struct PlanFlags {
  std::vector<std::string> gases;  // none: air
  std::vector<std::string> travel, levels, after, tanks;
  std::optional<double> depth_m, time_min;
  std::string gf = "30/85", convention = "stop-minutes", table, water, saturation, log, vehicle;
  std::string rmv = "20,17", minimum_gas = "2,2,4";
  // Not given: the convention's.
  std::optional<double> altitude_m, surface_bar, last_stop_m, ascent_m_min, descent_m_min;
  std::filesystem::path out, plot;
  bool json = false;
  bool depths_up = false;  // of the log: negative below the surface
};
Result<std::string> run_plan(const PlanFlags& flags);

// file: .csv, .wav or a WFDB record.
struct PhysioFlags {
  std::string what, file, channel, annotations, intrinsics;
  std::string estimator = "multiband";
  std::string method;  // of gaze: empty for the default
  std::filesystem::path out, plot;
  double rate_hz = 0.0;                           // 0: the file's
  std::optional<double> window_s, reference_bpm;  // not given: the default; none
  bool json = false, table = false, headset = false, realtime = false;
};
Result<std::string> run_physio(const PhysioFlags& flags);

struct HudFlags {
  std::string scene, replay, layouts, diver, units = "metric";
  std::string connect;                    // an address, instead of replay
  std::filesystem::path key, server_key;  // of the connection; empty: none
  std::uint64_t frames = 0;               // that are seen; 0: all of the recording
  bool validation = false;
};
Status run_hud(const HudFlags& flags);

struct RegisterFlags {
  std::string file, lab_up = "y";
  bool headset = false;  // the lab's side is measured by holding a headset at each place
  bool tilted = false, json = false;
};
Status run_register(const RegisterFlags& flags);

// words: of `neritic study`, which tools/experiment/study reads.
Status run_study(const std::vector<std::string>& words);

// what: info, check, repair or export; out: of repair a file, of export a folder.
struct RecordingFlags {
  std::string what, file, format = "csv";
  std::filesystem::path out;
  std::vector<std::string> topics;  // none: all
  bool json = false;
};
Result<std::string> run_recording(const RecordingFlags& flags);

// what: devices (a kind or a source's name), which send by the host's clock; or "lab", "flood",
// "latency".
struct SimulateFlags {
  std::vector<std::string> what;
  std::string scene = "assets/scenes/lab.toml", to;
  std::optional<double> seconds;
  double delay_ms = 0.0, jitter_ms = 0.0;
  double loss = 0.0, repeat = 0.0, cut = 0.0, corrupt = 0.0, garbage = 0.0;  // percent
  std::uint64_t seed = 1;
  std::string limbs, buttons, ecg, sound;  // recordings; empty: as the person does
  double suit_hz = 240.0, rate_hz = 100'000.0;
  double picture_hz = 0.0;   // of latency; 0: the camera's
  std::string size, device;  // of its pictures
  bool no_gloves = false, json = false, quiet = false;
  StepFileFlags files;  // of a lab
};
Status run_simulate(const SimulateFlags& flags);

struct DoctorFlags {
  std::string device;
  bool json = false;
};
Status run_doctor(const DoctorFlags& flags);

// A parsed command line: a command to run, or help to print.
struct CommandLine {
  // Gives one line that says where the results are, or nothing.
  std::function<Result<std::string>()> run;
  std::string help;  // not empty: print this instead (help, version)
  bool verbose = false, quiet = false;
};
// arguments without the program's name. kBadInput names the argument.
Result<CommandLine> parse_command_line(const std::vector<std::string>& arguments);

}  // namespace neritic::tools
