#include "tools/neritic/commands.hpp"

namespace neritic::tools {

void add_commands(CLI::App& app, Run& run) {
  add_render_command(app, run);
  add_sonar_command(app, run);
  add_dive_command(app, run);
  add_tradeoff_command(app, run);
  add_doctor_command(app, run);
}

}  // namespace neritic::tools
