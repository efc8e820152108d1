#include "testbed/simulators/breath_sound.hpp"

#include <cmath>

#include "engine/core/math.hpp"
#include "engine/core/random.hpp"

namespace neritic::testbed {

float BreathSound::next(double breath_bpm) {
  breath_ += breath_bpm / 60.0 / rate_hz_;
  breath_ -= std::floor(breath_);
  const double white = 2.0 * random_uniform({seed_, 0x627265, 0}, count_++) - 1.0;
  dull_ += 0.15 * (white - dull_);
  const double bright = white - dull_;
  const double in = breath_ < 0.35 ? std::sin(kPi * breath_ / 0.35) : 0.0;
  const double out =
      breath_ > 0.45 && breath_ < 0.85 ? std::sin(kPi * (breath_ - 0.45) / 0.4) : 0.0;
  return static_cast<float>(0.25 * in * bright + 0.5 * out * dull_ + 0.002 * white);
}

}  // namespace neritic::testbed
