// The program `neritic`: reads the command line, runs one subcommand, returns its exit status.
#include <cstdio>
#include <exception>
#include <new>

#include "engine/core/log.hpp"
#include "engine/core/memory.hpp"
#include "tools/neritic/commands.hpp"

namespace {

int failed(const neritic::Error& error) {
  std::fprintf(stderr, "neritic: %s\n", neritic::one_line(error.message).c_str());
  return neritic::exit_status(error.code);
}

// Output counts as printed only once it is flushed: a full disk or a closed pipe is an error.
int flushed(int status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  std::fprintf(stderr, "neritic: standard output cannot be written\n");
  return status == 0 ? 1 : status;
}

int run(int argc, char** argv) {
  const auto line =
      neritic::tools::parse_command_line(std::vector<std::string>(argv + 1, argv + argc));
  if (!line.ok()) return failed(line.error());
  if (!line->help.empty()) {
    std::fputs(line->help.c_str(), stdout);
    return 0;
  }
  if (line->verbose) neritic::set_log_level(neritic::LogLevel::kInfo);
  if (line->quiet) neritic::set_log_level(neritic::LogLevel::kQuiet);
  const auto done = line->run();
  if (!done.ok()) return failed(done.error());
  if (!line->quiet && !done->empty()) std::printf("%s\n", done->c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  neritic::keep_freed_memory();
  try {
    return flushed(run(argc, argv));
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "neritic: out of memory\n");
    return 1;
  } catch (const std::exception& error) {  // of a library; ours returns its errors
    std::fprintf(stderr, "neritic: %s\n", neritic::one_line(error.what()).c_str());
    return 1;
  }
}
