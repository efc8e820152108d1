// Markers as a stream of Lab Streaming Layer (type "Markers", one channel of text), for what
// records a laboratory's other devices. By its library, if it is installed. One thread.
#pragma once

#include <memory>

#include "engine/core/clock.hpp"
#include "testbed/devices/shared_library.hpp"

namespace neritic::testbed {

class LslOutlet {
 public:
  // kUnsupported: there is no library.
  static Result<std::unique_ptr<LslOutlet>> create(const std::string& stream);
  ~LslOutlet();
  LslOutlet(const LslOutlet&) = delete;
  LslOutlet& operator=(const LslOutlet&) = delete;

  // Stamped by the library's clock, so long ago.
  void send(const std::string& text, TimeNs ago_ns);

 private:
  explicit LslOutlet(SharedLibrary library) : library_(std::move(library)) {}

  SharedLibrary library_;
  void* (*create_info_)(const char* name, const char* type, int channels, double rate_hz,
                        int format, const char* source) = nullptr;
  void* (*create_outlet_)(void* info, int chunk, int buffer_s) = nullptr;
  void (*destroy_outlet_)(void* outlet) = nullptr;
  void (*destroy_info_)(void* info) = nullptr;
  int (*push_)(void* outlet, const char** data, double stamp_s) = nullptr;
  double (*clock_)() = nullptr;
  void *info_ = nullptr, *outlet_ = nullptr;
};

}  // namespace neritic::testbed
