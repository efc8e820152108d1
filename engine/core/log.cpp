#include "engine/core/log.hpp"

#include <atomic>
#include <cstdio>
#include <string>

namespace neritic {
namespace {
std::atomic<LogLevel> g_level{LogLevel::kWarnings};  // the one process-wide setting: what to print
}

void set_log_level(LogLevel level) {
  g_level = level;
}

std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n')
      line += "\\n";
    else if (byte < 0x20 || byte == 0x7f)
      line += fmt::format("\\x{:02x}", byte);
    else
      line += c;
  }
  return line;
}

void log_line(LogLevel level, std::string_view line) {
  if (level > g_level.load()) return;
  const char* prefix = level == LogLevel::kWarnings ? "note: " : "";
  const std::string whole = fmt::format("{}{}\n", prefix, one_line(line));
  std::fwrite(whole.data(), 1, whole.size(), stderr);  // one write, so lines of threads stay whole
}

}  // namespace neritic
