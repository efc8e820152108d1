// The subcommands of `neritic`, one file each. Each adds its flags to the parser and, when chosen,
// leaves what to do in run.
#pragma once

#include <functional>

#include "engine/core/result.hpp"

namespace CLI {
class App;
}

namespace neritic::tools {

using Run = std::function<Status()>;

void add_commands(CLI::App& app, Run& run);

void add_render_command(CLI::App& app, Run& run);
void add_sonar_command(CLI::App& app, Run& run);
void add_tradeoff_command(CLI::App& app, Run& run);
void add_dive_command(CLI::App& app, Run& run);
void add_doctor_command(CLI::App& app, Run& run);

}  // namespace neritic::tools
