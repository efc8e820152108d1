// Shared by the tests of `neritic sonar`: the command as typed, its arrays, small images.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/core/npy.hpp"
#include "engine/gpu/device.hpp"
#include "tests/support/device_gate.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::test {

using Words = std::vector<std::string>;

// As a user types it after `neritic sonar`.
inline Status sonar_command(Words words) {
  words.insert(words.begin(), "sonar");
  const bool on_gpu = std::ranges::none_of(
      words, [](const std::string& w) { return w == "reference" || w == "image"; });
  if (on_gpu && gpu::validation_layer_present()) words.push_back("--validate");
  NERITIC_TRY(const tools::CommandLine line, tools::parse_command_line(words));
  const auto done = line.run();
  return done.ok() ? Status() : Status(done.error());
}

// False only where tests may go without.
inline bool have_device() {
  return !may_skip_without_device();
}

inline std::vector<double> numbers_of(const std::filesystem::path& path) {
  const auto array = read_npy(path);
  EXPECT_TRUE(array.ok()) << array.error().message;
  return array.ok() ? array->to_doubles() : std::vector<double>();
}

inline double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double v : values) total += v;
  return total;
}

// Where the command runs: with a Vulkan device, or by the reference.
inline Words by_any_method() {
  return have_device() ? Words{"--method", "gpu"} : Words{"--method", "reference"};
}

inline Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace neritic::test
