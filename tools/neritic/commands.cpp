#include "tools/neritic/commands.hpp"

namespace neritic::tools {

void add_commands(CLI::App& app, Run& run) {
  (void)app;
  (void)run;
}

}  // namespace neritic::tools
