#include "tools/neritic/commands.hpp"

namespace neritic::tools {

void add_commands(CLI::App& app, Run& run) {
  add_render_command(app, run);
}

}  // namespace neritic::tools
