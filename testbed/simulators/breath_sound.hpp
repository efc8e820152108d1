// The sound of breathing at a regulator, as a microphone there hears it: bright bursts of breathing
// in, dull ones of breathing out. Plain value; same seed, same sound.
#pragma once

#include <cstdint>

namespace neritic::testbed {

class BreathSound {
 public:
  BreathSound(double rate_hz, std::uint64_t seed) : rate_hz_(rate_hz), seed_(seed) {}
  // The next sample, -1 to 1, of a person who breathes so often a minute.
  float next(double breath_bpm);

 private:
  double rate_hz_;
  std::uint64_t seed_, count_ = 0;
  double breath_ = 0.0, dull_ = 0.0;  // the phase in breaths; the slow part of the noise
};

}  // namespace neritic::testbed
