// Notes for a person, on stderr. Libraries log only what a user should know once (an optional
// extension that is ignored); what failed is returned as an Error instead. Thread-safe.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace neritic {

enum class LogLevel { kQuiet, kWarnings, kInfo, kDebug };

// Sets what is printed from now on (default kWarnings). Any thread.
void set_log_level(LogLevel level);
void log_line(LogLevel level, std::string_view line);
// The text with its control characters written out (\n, \x1b), so that it stays one line whatever
// a file's name holds.
std::string one_line(std::string_view text);

template <class... Args>
void log_warn(fmt::format_string<Args...> format, Args&&... args) {
  log_line(LogLevel::kWarnings, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  log_line(LogLevel::kInfo, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_debug(fmt::format_string<Args...> format, Args&&... args) {
  log_line(LogLevel::kDebug, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace neritic
