// A signal as a device sent it, a microphone's sound or a strap's ECG, from the device's thread to
// the recording that wants it, one at a time. Bounded: half a minute that nobody takes is dropped.
// Any thread.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/clock.hpp"

namespace neritic::testbed {

// A packet of it: when its first sample was taken, by the clock of the device's samples.
struct SignalPacket {
  TimeNs captured_ns = 0;
  double rate_hz = 0.0;
  std::vector<float> samples;  // sound: -1 to 1; ECG: microvolts
};

class SignalQueue {
 public:
  static constexpr double kMost_s = 30.0;

  // Nothing is kept while nobody wants it.
  void want(bool wanted) {
    const std::lock_guard lock(mutex_);
    wanted_ = wanted;
    waiting_.clear();
    waiting_s_ = 0.0;
  }
  void push(TimeNs captured_ns, double rate_hz, const std::vector<float>& samples) {
    const std::lock_guard lock(mutex_);
    if (!wanted_) return;
    if (waiting_s_ > kMost_s) waiting_.clear(), waiting_s_ = 0.0;
    waiting_.push_back({captured_ns, rate_hz, samples});
    waiting_s_ += static_cast<double>(samples.size()) / rate_hz;
  }
  std::vector<SignalPacket> take() {
    const std::lock_guard lock(mutex_);
    waiting_s_ = 0.0;
    return std::exchange(waiting_, {});
  }

 private:
  std::mutex mutex_;
  bool wanted_ = false;
  double waiting_s_ = 0.0;
  std::vector<SignalPacket> waiting_;
};

// What the source of that name sends: "sound" or "ecg".
struct SignalSource {
  std::string name, kind;
  SignalQueue* queue = nullptr;
};

}  // namespace neritic::testbed
