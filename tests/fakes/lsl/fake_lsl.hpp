// The test's side of the fake liblsl (lsl.cpp): streams that are on its network, in this process.
// Found in the library by name. Any thread.
#pragma once

#include <dlfcn.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/check.hpp"

namespace neritic::test {

class FakeLsl {
 public:
  FakeLsl() : library_(::dlopen("liblsl.so", RTLD_NOW | RTLD_LOCAL)) {
    NERITIC_CHECK(library_, "{}", ::dlerror());
    find("fake_lsl_reset", reset_);
    find("fake_lsl_add", add_);
    find("fake_lsl_push", push_);
    find("fake_lsl_clock", clock_);
    find("fake_lsl_presence", presence_);
    find("fake_lsl_markers", markers_);
    find("fake_lsl_wrong_calls", wrong_calls_);
    find("fake_lsl_exchanges", exchanges_);
    find("lsl_local_clock", local_clock_);
    reset_();
  }
  ~FakeLsl() {
    reset_();
    ::dlclose(library_);
  }
  FakeLsl(const FakeLsl&) = delete;
  FakeLsl& operator=(const FakeLsl&) = delete;

  void add(const std::string& name, int channels, double rate_hz = 0.0) {
    add_(name.c_str(), channels, rate_hz);
  }
  // Samples, one after the other, stamped by the sender's clock.
  void push(const std::string& name, const std::vector<float>& values,
            const std::vector<double>& stamps) {
    push_(name.c_str(), values.data(), stamps.data(), static_cast<std::uint32_t>(stamps.size()));
  }
  // Local time less the sender's, as exchanges find it, and their uncertainty; that_fail: of the
  // next ones so many time out.
  void clock(const std::string& name, double correction_s, double uncertainty_s,
             int that_fail = 0) {
    clock_(name.c_str(), correction_s, uncertainty_s, that_fail);
  }
  enum Presence { kThere, kGoneForNow, kLost };
  // kGoneForNow: the library looks for it by itself. kLost: inlets say so, for ever.
  void presence(const std::string& name, Presence presence) { presence_(name.c_str(), presence); }
  // The samples that an outlet of text sent: "stamp text" a line.
  std::string markers(const std::string& name) { return markers_(name.c_str()); }
  // Calls that the interface does not allow, a line each.
  std::string wrong_calls() { return wrong_calls_(); }
  // How often the offset of that stream's clock was told.
  int exchanges(const std::string& name) { return exchanges_(name.c_str()); }
  double local_clock() { return local_clock_(); }

 private:
  template <class Function>
  void find(const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(::dlsym(library_, name));
    NERITIC_CHECK(function, "the fake has no {}", name);
  }
  void* library_;
  void (*reset_)() = nullptr;
  void (*add_)(const char*, int, double) = nullptr;
  void (*push_)(const char*, const float*, const double*, std::uint32_t) = nullptr;
  void (*clock_)(const char*, double, double, int) = nullptr;
  void (*presence_)(const char*, int) = nullptr;
  const char* (*markers_)(const char*) = nullptr;
  const char* (*wrong_calls_)() = nullptr;
  int (*exchanges_)(const char*) = nullptr;
  double (*local_clock_)() = nullptr;
};

}  // namespace neritic::test
