// Small things that several subcommands share: parsing of flag values, progress on a terminal.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
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

// A line of progress where stderr is no terminal.
inline constexpr double kSayEvery_s = 30.0;

// Where there is more than one step: one line on stderr that is rewritten, or, where stderr is no
// terminal, a line every say_every_s, from a thread of its own: a step may take minutes. Any thread
// may call it.
class Progress {
 public:
  Progress(std::string what, std::uint64_t total, double say_every_s = kSayEvery_s);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void step();
  // Shows the current activity after the count.
  void now(std::string doing);
  // A line of its own that stays, also where no count is shown.
  void say(const std::string& line);

 private:
  // These with mutex_ locked.
  std::string line() const;
  void show();

  std::mutex mutex_;  // guards doing_ and done_
  std::string what_, doing_;
  std::uint64_t total_, done_ = 0;
  TimeNs begun_ns_;
  bool shown_, terminal_;
  std::condition_variable_any ends_;
  std::jthread teller_;  // last: it ends before what it reads
};

}  // namespace neritic::tools
