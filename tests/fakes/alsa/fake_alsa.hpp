// The test's side of the fake libasound (alsa.cpp): one sound card, in this process. Found in the
// library by name. Any thread.
#pragma once

#include <dlfcn.h>

#include <cstdint>
#include <vector>

#include "engine/core/check.hpp"

namespace neritic::test {

class FakeAlsa {
 public:
  FakeAlsa() : library_(::dlopen("libasound.so.2", RTLD_NOW | RTLD_LOCAL)) {
    NERITIC_CHECK(library_, "{}", ::dlerror());
    call<void()>("fake_alsa_reset")();
  }
  ~FakeAlsa() { ::dlclose(library_); }
  FakeAlsa(const FakeAlsa&) = delete;
  FakeAlsa& operator=(const FakeAlsa&) = delete;

  // What the card hears next.
  void push(const std::vector<std::int16_t>& samples) {
    call<void(const std::int16_t*, std::uint32_t)>("fake_alsa_push")(
        samples.data(), static_cast<std::uint32_t>(samples.size()));
  }
  // Pulls it out, puts it back.
  void plug(bool there) { call<void(int)>("fake_alsa_plug")(there ? 1 : 0); }
  // Its queue runs over.
  void overrun() { call<void()>("fake_alsa_overrun")(); }
  int opens() { return call<int()>("fake_alsa_opens")(); }    // so far
  int opened() { return call<int()>("fake_alsa_opened")(); }  // now
  unsigned rate_hz() { return call<unsigned()>("fake_alsa_rate")(); }

 private:
  template <class Function>
  Function* call(const char* name) {
    auto* function = reinterpret_cast<Function*>(::dlsym(library_, name));
    NERITIC_CHECK(function, "the fake has no {}", name);
    return function;
  }
  void* library_;
};

}  // namespace neritic::test
