#include "tests/fakes/openxr/control.hpp"

#include <time.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

const char* kept(std::string& keep, const std::optional<std::string>& text) {
  if (!text) return nullptr;
  keep = *text;
  return keep.c_str();
}

// The script of the environment, when the library is loaded.
struct FromEnvironment {
  FromEnvironment() {
    const char* path = std::getenv("NERITIC_FAKE_XR");
    if (!path) return;
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    Runtime& rt = runtime();
    if (!file) rt.fault(std::string("NERITIC_FAKE_XR: cannot read ") + path + ".");
    if (const auto wrong = read_script(text, rt.script))
      rt.fault("NERITIC_FAKE_XR: " + *wrong + ".");
  }
};
const FromEnvironment from_environment;

}  // namespace
}  // namespace neritic::fakes

using neritic::fakes::runtime;
#define NERITIC_EXPORT __attribute__((visibility("default")))

NERITIC_EXPORT void neritic_fake_xr_reset() {
  auto& rt = runtime();
  const std::lock_guard held(rt.lock);
  if (auto* instance = rt.instance()) rt.destroy(*instance);
  rt.script = {};
  rt.now = neritic::fakes::kEpoch;
  rt.host_epoch_ns = 0;
  rt.faults.clear();
  rt.made_vulkan.clear();
  rt.log.clear();
  neritic::fakes::SpentTime::counted = false;
  neritic::fakes::SpentTime::spent_ns = 0;
}

NERITIC_EXPORT const char* neritic_fake_xr_script(const char* lines) {
  static std::string keep;
  const std::lock_guard held(runtime().lock);
  return neritic::fakes::kept(keep, neritic::fakes::read_script(lines, runtime().script));
}

NERITIC_EXPORT const char* neritic_fake_xr_do(const char* line) {
  static std::string keep;
  const std::lock_guard held(runtime().lock);
  return neritic::fakes::kept(keep, neritic::fakes::perform(runtime(), line));
}

NERITIC_EXPORT const char* neritic_fake_xr_faults() {
  static std::string keep;
  const std::lock_guard held(runtime().lock);
  return neritic::fakes::kept(keep, neritic::fakes::joined(runtime().faults));
}

NERITIC_EXPORT const char* neritic_fake_xr_log() {
  static std::string keep;
  const std::lock_guard held(runtime().lock);
  return neritic::fakes::kept(keep, neritic::fakes::joined(runtime().log));
}

NERITIC_EXPORT std::int64_t neritic_fake_xr_spent_ns() {
  neritic::fakes::SpentTime::counted = true;
  return neritic::fakes::SpentTime::spent_ns;
}

NERITIC_EXPORT std::int64_t neritic_fake_xr_now() {
  const std::lock_guard held(runtime().lock);
  return runtime().now;
}
