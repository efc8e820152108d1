#include "tools/neritic/flags.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "engine/core/image.hpp"
#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::tools {

Result<std::pair<std::uint32_t, std::uint32_t>> parse_size(const std::string& flag,
                                                           const std::string& text) {
  const char* const end = text.data() + text.size();
  std::uint32_t width = 0, height = 0;
  const auto first = std::from_chars(text.data(), end, width);
  const bool cross = first.ec == std::errc{} && first.ptr != end && *first.ptr == 'x';
  const auto second = cross ? std::from_chars(first.ptr + 1, end, height) : first;
  if (!cross || second.ec != std::errc{} || second.ptr != end || width < 1 || height < 1 ||
      width > kMaxPictureSide || height > kMaxPictureSide)
    return refusal(flag, fmt::format("'{}'", text),
                   fmt::format("WIDTHxHEIGHT, 1 to {} pixels a side", kMaxPictureSide));
  return std::pair{width, height};
}

Result<std::vector<double>> parse_numbers(const char* flag, const std::string& text,
                                          std::size_t fewest, std::size_t most) {
  std::vector<double> out;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    double value = 0.0;
    const char* end = text.data() + comma;
    const auto [stop, error] = std::from_chars(text.data() + at, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value))
      return refusal(fmt::format("--{}", flag), fmt::format("'{}'", text),
                     most == 1 ? "a number" : "numbers separated by commas");
    out.push_back(value);
    at = comma + 1;
  }
  if (out.size() < fewest || out.size() > most)
    return refusal(
        fmt::format("--{}", flag),
        fmt::format("{} number{} in '{}'", out.size(), out.size() == 1 ? "" : "s", text),
        fewest == most ? fmt::format("{}", most) : fmt::format("{} or {}", fewest, most));
  return out;
}

std::string progress_line(const std::string& what, std::uint64_t done, std::uint64_t total,
                          double elapsed_s) {
  std::string line = fmt::format("{} {} of {}", what, done, total);
  if (done == 0 || done >= total) return line;
  const double left_s = elapsed_s * static_cast<double>(total - done) / static_cast<double>(done);
  const auto whole_s = static_cast<std::uint64_t>(std::ceil(std::min(left_s, 1e9)));
  if (whole_s >= 3600)
    return line + fmt::format(", {} h {:02} min left", whole_s / 3600, whole_s / 60 % 60);
  return line + fmt::format(", {}:{:02} left", whole_s / 60, whole_s % 60);
}

Progress::Progress(std::string what, std::uint64_t total, double say_every_s)
    : what_(std::move(what)),
      total_(total),
      begun_ns_(now_ns()),
      shown_(total > 1),
      terminal_(isatty(STDERR_FILENO)) {
  if (!shown_ || terminal_) return;
  teller_ = std::jthread([this, say_every_s](const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    auto due = std::chrono::steady_clock::now();
    while (true) {
      due += std::chrono::duration_cast<std::chrono::steady_clock::duration>(
          std::chrono::duration<double>(say_every_s));
      ends_.wait_until(lock, stop, due, [] { return false; });
      if (stop.stop_requested()) return;
      log_line(LogLevel::kWarnings, line());
    }
  });
}

void Progress::step() {
  const std::scoped_lock lock(mutex_);
  ++done_;
  show();
}

void Progress::now(std::string doing) {
  const std::scoped_lock lock(mutex_);
  doing_ = std::move(doing);
  show();
}

void Progress::say(const std::string& line) {
  const std::scoped_lock lock(mutex_);
  if (shown_ && terminal_) fmt::print(stderr, "\r\033[K");
  log_line(LogLevel::kWarnings, line);
  doing_.clear();
  show();
}

std::string Progress::line() const {
  return progress_line(what_, done_, total_, 1e-3 * to_ms(now_ns() - begun_ns_)) +
         (doing_.empty() ? "" : ": " + doing_);
}

void Progress::show() {
  if (!shown_ || !terminal_) return;
  // A line that was longer leaves nothing behind.
  fmt::print(stderr, "\r{}\033[K", line());
  std::fflush(stderr);
}

Progress::~Progress() {
  if (shown_ && terminal_) fmt::print(stderr, "\n");
}

}  // namespace neritic::tools
