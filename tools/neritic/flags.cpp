#include "tools/neritic/flags.hpp"

#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdio>

namespace neritic::tools {

Result<std::pair<std::uint32_t, std::uint32_t>> parse_size(const std::string& flag, const std::string& text) {
  constexpr std::uint32_t kMax = 16384;
  const char* const end = text.data() + text.size();
  std::uint32_t width = 0, height = 0;
  const auto first = std::from_chars(text.data(), end, width);
  const bool cross = first.ec == std::errc{} && first.ptr != end && *first.ptr == 'x';
  const auto second = cross ? std::from_chars(first.ptr + 1, end, height) : first;
  if (!cross || second.ec != std::errc{} || second.ptr != end || width < 1 || height < 1 || width > kMax || height > kMax)
    return bad_input("{}: '{}'; WIDTHxHEIGHT of 1 to {} pixels a side is accepted", flag, text, kMax);
  return std::pair{width, height};
}

Result<std::vector<double>> parse_numbers(const std::string& flag, const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !std::isfinite(value)) break;
    numbers.push_back(value);
    at = next;
    if (at == end) break;
    if (*at != ',') break;
    ++at;
    if (at == end) numbers.clear();  // a comma at the end
  }
  if (at != end || numbers.size() != count)
    return bad_input("{}: '{}'; {} finite numbers with commas between are accepted", flag, text, count);
  return numbers;
}

Progress::Progress(std::string what, std::uint64_t total)
    : what_(std::move(what)), total_(total), shown_(total > 1 && isatty(STDERR_FILENO)) {}

void Progress::step() {
  ++done_;
  if (shown_) fmt::print(stderr, "\r{} {} of {}", what_, done_, total_), std::fflush(stderr);
}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\n");
}

}  // namespace neritic::tools
