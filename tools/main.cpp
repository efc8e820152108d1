// The program `neritic`: reads the command line, runs one subcommand, returns its exit status.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "engine/core/log.hpp"
#include "tools/neritic/commands.hpp"

namespace {

int run(int argc, char** argv) {
  CLI::App app{"Neritic: divers and underwater robots together in one simulated sea", "neritic"};
  app.require_subcommand(1);
  app.fallthrough();
  bool verbose = false, quiet = false;
  app.add_flag("-v,--verbose", verbose, "say more on stderr");
  app.add_flag("-q,--quiet", quiet, "say only what failed");
  neritic::tools::Run chosen;
  neritic::tools::add_commands(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
      std::string names;
      for (const CLI::App* command : app.get_subcommands(nullptr)) names += (names.empty() ? "" : ", ") + command->get_name();
      std::fprintf(stderr, "neritic: '%s' is no command; %s are\n", argv[1], names.c_str());
      return 2;
    }
    std::fprintf(stderr, "neritic: %s (see neritic --help)\n", error.what());
    return 2;
  }
  if (verbose) neritic::set_log_level(neritic::LogLevel::kInfo);
  if (quiet) neritic::set_log_level(neritic::LogLevel::kQuiet);
  const neritic::Status status = chosen();
  if (status.ok()) return 0;
  std::fprintf(stderr, "neritic: %s\n", status.error().message.c_str());
  return neritic::exit_status(status.error().code);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "neritic: out of memory\n");
    return 1;
  }
}
