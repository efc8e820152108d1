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

void log_line(LogLevel level, std::string_view line) {
  if (level > g_level.load()) return;
  const char* prefix = level == LogLevel::kWarnings ? "note: " : "";
  const std::string whole = fmt::format("{}{}\n", prefix, line);
  std::fwrite(whole.data(), 1, whole.size(), stderr);  // one write, so lines of threads stay whole
}

}  // namespace neritic
