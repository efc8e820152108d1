// Small things that several subcommands share: parsing of flag values, progress on a terminal.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/result.hpp"

namespace neritic::tools {

// "1280x720"; each side 1 to kMaxPictureSide.
Result<std::pair<std::uint32_t, std::uint32_t>> parse_size(const std::string& flag,
                                                           const std::string& text);

// "a,b,c": fewest to most finite numbers. flag: its name without dashes.
Result<std::vector<double>> parse_numbers(const char* flag, const std::string& text,
                                          std::size_t fewest, std::size_t most);

// "frame 25 of 100, 3:00 left", supposing that the steps to come take as long as those done.
std::string progress_line(const std::string& what, std::uint64_t done, std::uint64_t total,
                          double elapsed_s);

// Where there is more than one step: one line on stderr that is rewritten, or, where stderr is no
// terminal, a line every half minute.
class Progress {
 public:
  Progress(std::string what, std::uint64_t total);
  ~Progress();
  void step();
  // Shows the current activity after the count.
  void now(std::string doing);
  // A line of its own that stays, also where no count is shown.
  void say(const std::string& line);

 private:
  void show();
  std::string what_, doing_;
  std::uint64_t total_, done_ = 0;
  TimeNs begun_ns_, said_ns_;
  bool shown_, terminal_;
};

}  // namespace neritic::tools
