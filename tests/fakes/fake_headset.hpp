// A fake headset for one test: makes the fake OpenXR runtime the one that the loader finds, gives
// it a script (README.md) and, at the end of the test, fails it for each rule that the client
// broke. One at a time; the client's OpenXR objects must be gone before it.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/support.hpp"

namespace neritic::fakes {

class FakeHeadset {
 public:
  explicit FakeHeadset(const std::string& script = "") {
    library_ = dlopen(NERITIC_FAKE_OPENXR, RTLD_NOW | RTLD_LOCAL);
    if (!library_) {
      ADD_FAILURE() << dlerror();
      std::abort();
    }
    find<void()>("neritic_fake_xr_reset")();
    std::ofstream(manifest()) << R"({"file_format_version": "1.0.0", "runtime": {"library_path": ")"
                              << NERITIC_FAKE_OPENXR << R"("}})";
    setenv("XR_RUNTIME_JSON", manifest().c_str(), 1);
    write(script);
  }
  ~FakeHeadset() {
    unsetenv("XR_RUNTIME_JSON");
    std::string broken;
    std::istringstream lines(faults());
    for (std::string line; std::getline(lines, line);)
      if (forgiven_.empty() || line.find(forgiven_) == std::string::npos) broken += line + "\n";
    if (!expected_faults_) {
      EXPECT_EQ(broken, "") << "the client broke OpenXR's rules";
    }
    find<void()>("neritic_fake_xr_reset")();
    dlclose(library_);
  }
  FakeHeadset(const FakeHeadset&) = delete;
  FakeHeadset& operator=(const FakeHeadset&) = delete;

  // More lines of the script.
  void write(const std::string& script) {
    const char* wrong = find<const char*(const char*)>("neritic_fake_xr_script")(script.c_str());
    if (wrong) ADD_FAILURE() << "the headset's script: " << wrong;
  }
  // Makes one thing happen now ("exit", "session_lost", ...).
  void happen(const std::string& line) {
    const char* wrong = find<const char*(const char*)>("neritic_fake_xr_do")(line.c_str());
    if (wrong) ADD_FAILURE() << "the headset: " << wrong;
  }
  // The broken rules so far, a sentence a line.
  std::string faults() { return find<const char*()>("neritic_fake_xr_faults")(); }
  // The test is about the faults: they do not fail it.
  void expect_faults() { expected_faults_ = true; }
  // Faults that have these words are not the client's: they do not fail it.
  void forgive(const std::string& words) { forgiven_ = words; }
  // A line for each frame that ended.
  std::string log() { return find<const char*()>("neritic_fake_xr_log")(); }
  // The processor's time in the runtime's functions since this was first called, ms. Between calls.
  double spent_ms() {
    const auto spent_ns = find<std::int64_t()>("neritic_fake_xr_spent_ns");
    return 1e-6 * static_cast<double>(spent_ns());
  }
  // Seconds of simulated time.
  double now_s() {
    return static_cast<double>(find<std::int64_t()>("neritic_fake_xr_now")() - 10'000'000'000) *
           1e-9;
  }
  // The file that XR_RUNTIME_JSON names.
  std::string manifest() const { return (folder_ / "runtime.json").string(); }

 private:
  template <class Function>
  Function* find(const char* name) {
    return reinterpret_cast<Function*>(dlsym(library_, name));
  }
  test::ScratchFolder folder_;
  void* library_ = nullptr;
  bool expected_faults_ = false;
  std::string forgiven_;
};

}  // namespace neritic::fakes
