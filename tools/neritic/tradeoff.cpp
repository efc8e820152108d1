// `neritic tradeoff WHAT`: error against cost for one model, as table, curve and summary.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "tools/neritic/commands.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/tradeoff/sonar_tradeoff.hpp"

namespace neritic::tools {
namespace {

struct TradeoffFlags {
  std::string what, device, scene = "assets/scenes/wreck.toml";
  std::filesystem::path out;
  bool quick = false;
};

Status run_tradeoff(const TradeoffFlags& flags) {
  if (flags.what != "sonar")
    return bad_input("tradeoff: '{}' found, sonar is accepted", flags.what);
  SonarTradeoffOptions options;
  options.scene = flags.scene == "none" ? "" : flags.scene;
  options.device = flags.device;
  options.quick = flags.quick;
  Progress progress("tradeoff sonar", steps(options));
  options.step = [&] { progress.step(); };
  NERITIC_TRY(const SonarTradeoff tradeoff, run_sonar_tradeoff(options));
  return write_sonar_tradeoff(flags.out, tradeoff);
}

}  // namespace

void add_tradeoff_command(CLI::App& app, Run& run) {
  auto flags = std::make_shared<TradeoffFlags>();
  CLI::App* command =
      app.add_subcommand("tradeoff", "error against cost of one model, with its curve");
  command->add_option("what", flags->what, "sonar")->required();
  command->add_option("--out", flags->out, "folder for tradeoff.csv, .png, .json")->required();
  command
      ->add_option("--scene", flags->scene, "whose first sonar is taken; none: only closed forms")
      ->capture_default_str();
  command->add_option("--device", flags->device, "Vulkan device: part of its name, or its index");
  command->add_flag("--quick", flags->quick, "fewer rays, bins and points");
  command->callback([flags, &run] { run = [flags] { return run_tradeoff(*flags); }; });
}

}  // namespace neritic::tools
