// Reads the command line of `neritic`. The files of this folder alone know the parser, which takes
// long to compile.
#include "engine/core/version.hpp"
#include "tools/neritic/command_line/parser_words.hpp"
#include "tools/neritic/command_line/subcommands.hpp"

namespace neritic::tools {

Result<CommandLine> parse_command_line(const std::vector<std::string>& arguments) {
  CLI::App app{"Neritic: divers and underwater robots together in one simulated sea", "neritic"};
  app.require_subcommand(1);
  app.fallthrough();
  CommandLine line;
  app.set_version_flag("--version", std::string(program_version()));
  app.add_flag("-v,--verbose", line.verbose,
               "also prints on stderr what is loaded, chosen and compiled");
  app.add_flag("-q,--quiet", line.quiet, "no notes, and no summary of a dive except --json");
  add_render(app, line.run);
  add_sonar(app, line.run);
  add_dive(app, line);
  add_serve(app, line);
  add_keys(app, line.run);
  add_tradeoff(app, line);
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
  // The words of a command that there is not may be anything, --help too.
  const auto no_command = [&]() -> Error {
    std::string names;
    for (const CLI::App* command : app.get_subcommands(nullptr))
      names += (names.empty() ? "" : ", ") + command->get_name();
    return refusal("", fmt::format("command '{}'", arguments[0]), names);
  };
  const bool names_one = !arguments.empty() && !arguments[0].starts_with('-');
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(),
                                       arguments.rend()));  // back to front, as it wants them
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    if (chosen.empty() && names_one) return no_command();
    line.help = chosen.empty() ? app.help() : chosen.front()->help(app.get_name());
  } catch (const CLI::CallForVersion& version) {
    line.help = std::string(version.what()) + "\n";
  } catch (const CLI::ParseError& error) {
    if (app.get_subcommands().empty() && names_one) return no_command();
    const auto chosen = app.get_subcommands();
    const CLI::App& command = chosen.empty() ? app : *chosen.front();
    return bad_input("{} (see neritic {}--help)", parser_words(app, command, arguments, error),
                     chosen.empty() ? "" : command.get_name() + " ");
  }
  return line;
}

}  // namespace neritic::tools
