// A liblsl for tests: the functions of Lab Streaming Layer's C interface that the program loads
// (signatures, error codes and waiting as liblsl 1.16 documents them), over streams that a test
// keeps in this process (fake_lsl.hpp). A call that the interface does not allow is noted. A stream
// that is not there is not waited for.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#define FAKE_LSL extern "C" __attribute__((visibility("default")))

namespace {

enum Error : std::int32_t { kNone = 0, kTimeout = -1, kLostStream = -2, kArgument = -3 };
enum Presence { kThere, kGoneForNow, kLost };

struct Stream {
  int channels = 1;
  double rate_hz = 0.0;
  struct Sample {
    std::vector<float> values;
    double stamp = 0.0;
  };
  std::deque<Sample> samples;
  double correction_s = 0.0, uncertainty_s = 0.0;
  int failing_exchanges = 0, exchanges = 0;
  Presence presence = kThere;
  bool open = false;  // an inlet listens
  std::string markers;
};
struct Info {
  std::string name;
  int channels = 1;
  double rate_hz = 0.0;
  bool text = false;
};
struct Inlet {
  std::string name;
  bool lost = false;
  std::optional<double> asked_s;  // for the offset of its sender's clock, first
};
struct Outlet {
  std::string name;
};

struct World {
  std::mutex mutex;
  std::condition_variable came;
  std::map<std::string, Stream> streams;
  std::set<void*> infos, inlets, outlets;
  std::string wrong, told;
};
World& world() {
  static World one;
  return one;
}

using Lock = std::unique_lock<std::mutex>;

void wrong(const std::string& line) {
  world().wrong += line + "\n";
}

Stream* stream_of(const std::string& name) {
  const auto at = world().streams.find(name);
  return at == world().streams.end() ? nullptr : &at->second;
}

// The inlet, if it is one; else notes the call.
Inlet* inlet_of(void* handle, const char* call) {
  if (world().inlets.contains(handle)) return static_cast<Inlet*>(handle);
  wrong(std::string(call) + ": no inlet");
  return nullptr;
}

void put(std::int32_t* error, Error value) {
  if (error) *error = value;
}

}  // namespace

FAKE_LSL double lsl_local_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

FAKE_LSL std::int32_t lsl_resolve_byprop(void** buffer, std::uint32_t most, const char* property,
                                         const char* value, std::int32_t minimum, double) {
  const Lock lock(world().mutex);
  if (!buffer || most == 0 || minimum < 0) return kArgument;
  if (std::strcmp(property, "name") != 0) wrong(std::string("resolve by ") + property);
  const Stream* found = stream_of(value);
  if (!found || found->presence != kThere) return 0;
  auto* info = new Info{value, found->channels, found->rate_hz, false};
  world().infos.insert(info);
  buffer[0] = info;
  return 1;
}

FAKE_LSL void* lsl_create_streaminfo(const char* name, const char*, std::int32_t channels,
                                     double rate_hz, std::int32_t format, const char*) {
  constexpr std::int32_t kString = 3;
  const Lock lock(world().mutex);
  auto* info = new Info{name, channels, rate_hz, format == kString};
  world().infos.insert(info);
  return info;
}

FAKE_LSL void lsl_destroy_streaminfo(void* handle) {
  const Lock lock(world().mutex);
  if (world().infos.erase(handle) == 0) return wrong("destroy_streaminfo: no info");
  delete static_cast<Info*>(handle);
}

FAKE_LSL std::int32_t lsl_get_channel_count(void* handle) {
  const Lock lock(world().mutex);
  if (world().infos.contains(handle)) return static_cast<Info*>(handle)->channels;
  wrong("get_channel_count: no info");
  return 0;
}

FAKE_LSL double lsl_get_nominal_srate(void* handle) {
  const Lock lock(world().mutex);
  if (world().infos.contains(handle)) return static_cast<Info*>(handle)->rate_hz;
  wrong("get_nominal_srate: no info");
  return 0.0;
}

FAKE_LSL void* lsl_create_inlet(void* handle, std::int32_t buffer_s, std::int32_t,
                                std::int32_t recover) {
  const Lock lock(world().mutex);
  if (!world().infos.contains(handle) || buffer_s <= 0) {
    wrong("create_inlet: no info or no buffer");
    return nullptr;
  }
  if (recover != 1) wrong("create_inlet: a stream that goes is not looked for");
  auto* inlet = new Inlet{static_cast<Info*>(handle)->name, false};
  world().inlets.insert(inlet);
  return inlet;
}

FAKE_LSL void lsl_destroy_inlet(void* handle) {
  const Lock lock(world().mutex);
  Inlet* const inlet = inlet_of(handle, "destroy_inlet");
  if (!inlet) return;
  world().inlets.erase(handle);
  delete inlet;
}

FAKE_LSL void lsl_open_stream(void* handle, double, std::int32_t* error) {
  const Lock lock(world().mutex);
  put(error, kNone);
  const Inlet* inlet = inlet_of(handle, "open_stream");
  if (!inlet) return put(error, kArgument);
  Stream* stream = stream_of(inlet->name);
  if (!stream || stream->presence != kThere) return put(error, kTimeout);
  stream->open = true;
}

// Waits until the buffer is full or the time is over, as the library does.
FAKE_LSL unsigned long lsl_pull_chunk_f(void* handle, float* data, double* stamps,
                                        unsigned long data_size, unsigned long stamps_size,
                                        double timeout_s, std::int32_t* error) {
  Lock lock(world().mutex);
  put(error, kNone);
  Inlet* const inlet = inlet_of(handle, "pull_chunk_f");
  if (!inlet) {
    put(error, kArgument);
    return 0;
  }
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  unsigned long written = 0;
  while (true) {
    Stream* const stream = stream_of(inlet->name);
    if (stream && stream->presence == kLost) inlet->lost = true;
    if (!stream || inlet->lost) {
      put(error, kLostStream);
      return written;
    }
    const auto channels = static_cast<unsigned long>(stream->channels);
    if (data_size % channels != 0 || stamps_size * channels != data_size) {
      wrong("pull_chunk_f: buffers that do not fit " + std::to_string(channels) + " channels");
      put(error, kArgument);
      return written;
    }
    while (written < data_size && stream->presence == kThere && !stream->samples.empty()) {
      const Stream::Sample& sample = stream->samples.front();
      std::memcpy(data + written, sample.values.data(), channels * sizeof(float));
      stamps[written / channels] = sample.stamp;
      written += channels;
      stream->samples.pop_front();
    }
    if (written == data_size || world().came.wait_until(lock, until) == std::cv_status::timeout)
      return written;
  }
}

// The first estimate is there 0.64 s after the first call: eight exchanges every 0.064 s, and 0.128
// s for the last answer (liblsl's time_receiver.cpp).
FAKE_LSL double lsl_time_correction_ex(void* handle, double* remote_s, double* uncertainty_s,
                                       double timeout_s, std::int32_t* error) {
  constexpr double kFirst_s = 8 * 0.064 + 0.128;
  Lock lock(world().mutex);
  put(error, kNone);
  Inlet* inlet = inlet_of(handle, "time_correction_ex");
  if (inlet) {
    if (!inlet->asked_s) inlet->asked_s = lsl_local_clock();
    const double left_s = *inlet->asked_s + kFirst_s - lsl_local_clock();
    const auto wait = std::chrono::duration<double>(std::min(timeout_s, left_s));
    lock.unlock();
    if (left_s > 0.0) std::this_thread::sleep_for(wait);
    lock.lock();
    if (left_s > timeout_s || !world().inlets.contains(handle)) {
      put(error, kTimeout);
      return 0.0;
    }
  }
  Stream* stream = inlet ? stream_of(inlet->name) : nullptr;
  if (!stream || stream->presence != kThere || stream->failing_exchanges > 0) {
    if (stream && stream->failing_exchanges > 0) --stream->failing_exchanges;
    put(error, kTimeout);
    return 0.0;
  }
  ++stream->exchanges;
  *remote_s = lsl_local_clock() - stream->correction_s;
  *uncertainty_s = stream->uncertainty_s;
  return stream->correction_s;
}

FAKE_LSL void* lsl_create_outlet(void* handle, std::int32_t, std::int32_t) {
  const Lock lock(world().mutex);
  const auto* info = static_cast<Info*>(handle);
  if (!world().infos.contains(handle) || !info->text || info->channels != 1) {
    wrong("create_outlet: no info of one channel of text");
    return nullptr;
  }
  world().streams[info->name] = Stream{};
  auto* outlet = new Outlet{info->name};
  world().outlets.insert(outlet);
  return outlet;
}

FAKE_LSL void lsl_destroy_outlet(void* handle) {
  const Lock lock(world().mutex);
  if (world().outlets.erase(handle) == 0) return wrong("destroy_outlet: no outlet");
  delete static_cast<Outlet*>(handle);
}

FAKE_LSL std::int32_t lsl_push_sample_strt(void* handle, const char** data, double stamp) {
  const Lock lock(world().mutex);
  if (!world().outlets.contains(handle)) {
    wrong("push_sample_strt: no outlet");
    return kArgument;
  }
  if (Stream* stream = stream_of(static_cast<Outlet*>(handle)->name))
    stream->markers += std::to_string(stamp) + " " + data[0] + "\n";
  return kNone;
}

// The test's side.

FAKE_LSL void fake_lsl_reset() {
  const Lock lock(world().mutex);
  world().streams.clear();
  world().wrong.clear();
  world().came.notify_all();
}

FAKE_LSL void fake_lsl_add(const char* name, int channels, double rate_hz) {
  const Lock lock(world().mutex);
  world().streams[name] = Stream{.channels = channels, .rate_hz = rate_hz};
}

// Samples that nobody listens to are gone, as the library's.
FAKE_LSL void fake_lsl_push(const char* name, const float* values, const double* stamps,
                            std::uint32_t samples) {
  const Lock lock(world().mutex);
  Stream* stream = stream_of(name);
  if (!stream || !stream->open || stream->presence != kThere) return;
  const auto channels = static_cast<std::size_t>(stream->channels);
  for (std::size_t i = 0; i < samples; ++i)
    stream->samples.push_back(
        {std::vector<float>(values + i * channels, values + (i + 1) * channels), stamps[i]});
  world().came.notify_all();
}

FAKE_LSL void fake_lsl_clock(const char* name, double correction_s, double uncertainty_s,
                             int that_fail) {
  const Lock lock(world().mutex);
  if (Stream* stream = stream_of(name)) {
    stream->correction_s = correction_s;
    stream->uncertainty_s = uncertainty_s;
    stream->failing_exchanges = that_fail;
  }
}

FAKE_LSL void fake_lsl_presence(const char* name, int presence) {
  const Lock lock(world().mutex);
  if (Stream* stream = stream_of(name)) stream->presence = static_cast<Presence>(presence);
  world().came.notify_all();
}

FAKE_LSL const char* fake_lsl_markers(const char* name) {
  const Lock lock(world().mutex);
  const Stream* stream = stream_of(name);
  world().told = stream ? stream->markers : "";
  return world().told.c_str();
}

FAKE_LSL const char* fake_lsl_wrong_calls() {
  const Lock lock(world().mutex);
  world().told = world().wrong;
  return world().told.c_str();
}

FAKE_LSL int fake_lsl_exchanges(const char* name) {
  const Lock lock(world().mutex);
  const Stream* stream = stream_of(name);
  return stream ? stream->exchanges : 0;
}
