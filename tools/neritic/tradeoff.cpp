// `neritic tradeoff WHAT`: error against cost for one model, as table, curve and summary.
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "engine/core/refusal.hpp"
#include "tools/common/outputs.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/load_scene.hpp"
#include "tools/tradeoff/camera_tradeoff.hpp"
#include "tools/tradeoff/deco_tradeoff.hpp"
#include "tools/tradeoff/modem_tradeoff.hpp"
#include "tools/tradeoff/navigation_tradeoff.hpp"
#include "tools/tradeoff/network_tradeoff.hpp"
#include "tools/tradeoff/optics_tradeoff.hpp"
#include "tools/tradeoff/physics_tradeoff.hpp"
#include "tools/tradeoff/physiology_tradeoff.hpp"
#include "tools/tradeoff/sonar_tradeoff.hpp"
#include "tools/tradeoff/swim_tradeoff.hpp"
#include "tools/tradeoff/tether_tradeoff.hpp"
#include "tools/tradeoff/xr_tradeoff.hpp"

namespace neritic::tools {
namespace {

// Where the results are.
std::string files(const TradeoffFlags& flags, const char* stem, bool drawn) {
  return fmt::format("{}: {}.csv, .md, .json, .plot.json{}", flags.out.string(), stem,
                     drawn ? ", .png" : "");
}

// The files that nobody named are the project's, by paths from its folder. other: what else would
// do.
Status must_be_here(const char* command, const std::filesystem::path& path,
                    const std::string& other = "") {
  std::error_code none;
  if (std::filesystem::exists(path, none)) return {};
  return refusal(command, fmt::format("no {} in this folder", path.string()),
                 "a start in the project's folder" + other);
}

Result<std::string> trade_physics(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff physics", fmt::format("kind '{}'", flags.kind), "none");
  PhysicsTradeoffOptions options;
  options.quick = flags.quick;
  NERITIC_TRY_STATUS(must_be_here("tradeoff physics", options.scene));
  Progress progress("tradeoff physics", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const PhysicsTradeoff tradeoff, run_physics_tradeoff(options));
  NERITIC_TRY(const bool drawn, write_physics_tradeoff(flags.out, tradeoff));
  return files(flags, "physics", drawn);
}

Result<std::string> trade_navigation(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff navigation", fmt::format("kind '{}'", flags.kind), "none");
  NavigationTradeoffOptions options;
  options.quick = flags.quick;
  NERITIC_TRY_STATUS(must_be_here("tradeoff navigation", options.vehicle));
  Progress progress("tradeoff navigation", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const NavigationTradeoff tradeoff, run_navigation_tradeoff(options));
  NERITIC_TRY(const bool drawn, write_navigation_tradeoff(flags.out, tradeoff));
  return files(flags, "navigation", drawn);
}

Result<std::string> trade_swim(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff swim", fmt::format("kind '{}'", flags.kind), "none");
  SwimTradeoffOptions options;
  options.quick = flags.quick;
  Progress progress("tradeoff swim", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const bool drawn, write_swim_tradeoff(flags.out, run_swim_tradeoff(options)));
  return files(flags, "swim", drawn);
}

Result<std::string> trade_physiology(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff physiology", fmt::format("kind '{}'", flags.kind), "none");
  PhysiologyTradeoffOptions options;
  options.quick = flags.quick;
  options.recordings = flags.recordings;
  Progress progress("tradeoff physiology", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const PhysiologyTradeoff tradeoff, run_physiology_tradeoff(options));
  NERITIC_TRY(const bool drawn, write_physiology_tradeoff(flags.out, tradeoff));
  return files(flags, "physiology", drawn);
}

Result<std::string> trade_deco(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff deco", fmt::format("kind '{}'", flags.kind), "none");
  DecoTradeoffOptions options;
  options.quick = flags.quick;
  Progress progress("tradeoff deco", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const bool drawn, write_deco_tradeoff(flags.out, run_deco_tradeoff(options)));
  return files(flags, "deco", drawn);
}

Result<std::string> trade_modem(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff modem", fmt::format("kind '{}'", flags.kind), "none");
  NERITIC_TRY(const bool drawn,
              write_modem_tradeoff(flags.out, run_modem_tradeoff(flags.quick ? 100 : 20'000)));
  return fmt::format("{}: modem.csv, .md, .plot.json{}", flags.out.string(), drawn ? ", .png" : "");
}

Result<std::string> trade_tether(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff tether", fmt::format("kind '{}'", flags.kind), "none");
  NERITIC_TRY(const bool drawn, write_tether_tradeoff(flags.out, run_tether_tradeoff(flags.quick)));
  return fmt::format("{}: tether.csv, .md, .plot.json{}", flags.out.string(),
                     drawn ? ", .png" : "");
}

Result<std::string> trade_xr(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff xr", fmt::format("kind '{}'", flags.kind), "none");
  XrTradeoffOptions options;
  if (flags.scene != TradeoffFlags().scene)
    options.scene = flags.scene;
  else
    NERITIC_TRY_STATUS(must_be_here("tradeoff xr", options.scene, ", or --scene FILE"));
  options.device = flags.device;
  options.quick = flags.quick;
  Progress progress("tradeoff xr", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const XrTradeoff tradeoff, run_xr_tradeoff(options));
  NERITIC_TRY(const bool drawn, write_xr_tradeoff(flags.out, tradeoff));
  return files(flags, "xr", drawn);
}

Result<std::string> trade_camera(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff camera", fmt::format("kind '{}'", flags.kind), "none");
  CameraTradeoffOptions options;
  if (flags.scene != TradeoffFlags().scene)
    options.scene = flags.scene;
  else
    NERITIC_TRY_STATUS(must_be_here("tradeoff camera", options.scene, ", or --scene FILE"));
  options.device = flags.device;
  options.quick = flags.quick;
  Progress progress("tradeoff camera", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const CameraTradeoff tradeoff, run_camera_tradeoff(options));
  NERITIC_TRY(const bool drawn, write_camera_tradeoff(flags.out, tradeoff));
  return files(flags, "camera", drawn);
}

Result<std::string> trade_optics(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff optics", fmt::format("kind '{}'", flags.kind), "none");
  OpticsTradeoffOptions options;
  options.device = flags.device;
  options.quick = flags.quick;
  Progress progress("tradeoff optics", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const OpticsTradeoff tradeoff, run_optics_tradeoff(options));
  NERITIC_TRY(const bool drawn, write_optics_tradeoff(flags.out, tradeoff));
  return files(flags, "optics", drawn);
}

Result<std::string> trade_network(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff network", fmt::format("kind '{}'", flags.kind), "none");
  NetworkTradeoffOptions options;
  const bool named = flags.scene != TradeoffFlags().scene;
  if (!named)
    NERITIC_TRY_STATUS(
        must_be_here("tradeoff network", SimulateFlags().scene, ", or --scene FILE"));
  NERITIC_TRY(options.scene, load_scene_or_model(named ? flags.scene : SimulateFlags().scene, ""));
  options.quick = flags.quick;
  Progress progress("tradeoff network", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const NetworkTradeoff tradeoff, run_network_tradeoff(options));
  NERITIC_TRY(const bool drawn, write_network_tradeoff(flags.out, tradeoff));
  return files(flags, "network", drawn);
}

// Becomes the module tools/experiment, which says what it wrote.
Result<std::string> trade_experiment(const TradeoffFlags& flags) {
  if (!flags.kind.empty())
    return refusal("tradeoff experiment", fmt::format("kind '{}'", flags.kind), "none");
  ExperimentFlags experiment = flags.experiment;
  experiment.name = "tradeoff";
  experiment.out = flags.out.string();
  experiment.quick = flags.quick;
  NERITIC_TRY_STATUS(run_experiment(experiment));
  return std::string();
}

// The flags of many runs mean nothing to the others.
Status must_be_of_experiment(const TradeoffFlags& flags) {
  const ExperimentFlags& e = flags.experiment;
  const char* given = e.runs           ? "--runs"
                      : e.seed         ? "--seed"
                      : !e.set.empty() ? "--set"
                      : e.workers      ? "--workers"
                      : e.resume       ? "--resume"
                      : e.json         ? "--json"
                                       : nullptr;
  if (!given || flags.what == "experiment") return {};
  return refusal("tradeoff " + flags.what, given, "that flag of tradeoff experiment alone");
}

Result<std::string> trade_sonar(const TradeoffFlags& flags) {
  SonarTradeoffOptions options;
  options.scene = flags.scene == "none" ? "" : flags.scene;
  options.device = flags.device;
  options.quick = flags.quick;
  options.kind = flags.kind;
  if (!flags.kind.empty()) {
    const auto known = [&](scene::SonarKind k) { return flags.kind == scene::name_of(k); };
    using enum scene::SonarKind;
    if (std::ranges::none_of(std::array{kImaging, kProfiling, kEchoSounder, kSideScan, kMechanical},
                             known))
      return refusal("tradeoff sonar", fmt::format("kind '{}'", flags.kind),
                     "imaging, profiling, echosounder, sidescan or mechanical");
    if (options.scene.empty())
      return refusal("tradeoff sonar", fmt::format("kind '{}' without a scene", flags.kind),
                     "with --scene FILE");
  }
  if (flags.scene == TradeoffFlags().scene)
    NERITIC_TRY_STATUS(must_be_here("--scene", flags.scene, ", --scene FILE, or --scene none"));
  Progress progress("tradeoff sonar", steps(options));
  options.step = [&] { progress.step(); };
  options.now = [&](const std::string& doing) { progress.now(doing); };
  // Each finished part is written at once, so that it stays if a later part fails.
  bool all_drawn = true;
  options.part_done = [&](const std::string& part, const SonarTradeoff& so_far) -> Status {
    const std::string name = part == "plain" ? "tradeoff" : part;
    NERITIC_TRY(const bool drawn, part == "plain" ? write_plain(flags.out, so_far)
                                                  : write_last_kind(flags.out, so_far));
    all_drawn = all_drawn && drawn;
    progress.say(fmt::format("{}: {}/{}.csv{}", part, flags.out.string(), name,
                             drawn ? ", .png" : ", .plot.json"));
    return {};
  };
  NERITIC_TRY(const SonarTradeoff tradeoff, run_sonar_tradeoff(options));
  const char* const drawn = all_drawn ? ", .png" : "";
  std::string files = tradeoff.points.empty()
                          ? ""
                          : fmt::format("tradeoff.csv, .json, .plot.json{} and plain.md", drawn);
  for (const KindResult& kind : tradeoff.kinds)
    files += fmt::format("{}{}.csv, _terms.csv, .plot.json{}", files.empty() ? "" : "; ", kind.kind,
                         drawn);
  if (!tradeoff.kinds.empty()) files += "; tradeoff.md and quality.json of all";
  if (tradeoff.quick) files += "; --quick tells no quality levels";
  return fmt::format("{}: {}", flags.out.string(), files);
}

}  // namespace

Result<std::string> run_tradeoff(const TradeoffFlags& flags) {
  NERITIC_TRY_STATUS(must_be_of_experiment(flags));
  NERITIC_TRY_STATUS(check_output_folder("--out", flags.out));
  if (flags.what == "sonar") return trade_sonar(flags);
  if (flags.what == "physics") return trade_physics(flags);
  if (flags.what == "navigation") return trade_navigation(flags);
  if (flags.what == "swim") return trade_swim(flags);
  if (flags.what == "physiology") return trade_physiology(flags);
  if (flags.what == "deco") return trade_deco(flags);
  if (flags.what == "modem") return trade_modem(flags);
  if (flags.what == "tether") return trade_tether(flags);
  if (flags.what == "xr") return trade_xr(flags);
  if (flags.what == "network") return trade_network(flags);
  if (flags.what == "experiment") return trade_experiment(flags);
  if (flags.what == "camera") return trade_camera(flags);
  if (flags.what == "optics") return trade_optics(flags);
  return refusal("tradeoff", fmt::format("'{}'", flags.what),
                 "sonar, physics, navigation, swim, deco, physiology, modem, tether, network, "
                 "xr, experiment, camera or optics");
}

}  // namespace neritic::tools
