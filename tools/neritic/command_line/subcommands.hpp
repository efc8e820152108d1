// Each adds its subcommand to the parser, which sets what runs if the user names it. Any thread.
#pragma once

#include "tools/neritic/command_line/shared_flags.hpp"

namespace neritic::tools {

void add_render(CLI::App& app, Run& run);
void add_dive(CLI::App& app, CommandLine& line);
void add_sonar(CLI::App& app, Run& run);
void add_tradeoff(CLI::App& app, CommandLine& line);
void add_check(CLI::App& app, Run& run);
void add_plan(CLI::App& app, Run& run);
void add_physio(CLI::App& app, Run& run);
void add_hud(CLI::App& app, Run& run);
void add_serve(CLI::App& app, CommandLine& line);
void add_keys(CLI::App& app, Run& run);
void add_simulate(CLI::App& app, CommandLine& line);
void add_register(CLI::App& app, Run& run);
void add_experiment(CLI::App& app, CommandLine& line);
// Of `experiment` and of `tradeoff experiment`.
void add_flags_of_runs(CLI::App& command, ExperimentFlags& flags);
void add_study(CLI::App& app, CommandLine& line);
void add_recording(CLI::App& app, Run& run);
void add_doctor(CLI::App& app, Run& run);

}  // namespace neritic::tools
