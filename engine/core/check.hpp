// NERITIC_CHECK: a bug of ours stops the program with the values, in release too.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace neritic {
[[noreturn]] inline void check_failed(const char* file, int line, const char* condition,
                                      const std::string& values) {
  fmt::print(stderr, "{}:{}: check failed: {} {}\n", file, line, condition, values);
  std::fflush(stderr);
  std::abort();
}
}  // namespace neritic

// NERITIC_CHECK(i < n, "i {} n {}", i, n)
#define NERITIC_CHECK(condition, ...)                                                    \
  do {                                                                                   \
    if (!(condition)) [[unlikely]]                                                       \
      ::neritic::check_failed(__FILE__, __LINE__, #condition, fmt::format(__VA_ARGS__)); \
  } while (false)
