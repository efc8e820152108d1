#include "hud/minute.hpp"

#include <algorithm>

namespace neritic::hud {

void Minute::add(const DiveData& data) {
  constexpr double kMinute_s = kPeriod_s * kSamples;
  const double late_s = data.time_s - next_s;
  if (!begun || !(late_s > -2.0 * kPeriod_s && late_s < kMinute_s)) {
    *this = Minute();
    begun = true;
    next_s = data.time_s;
  }
  for (; data.time_s >= next_s - 1e-9; next_s += kPeriod_s) {
    std::shift_left(heart_bpm.begin(), heart_bpm.end(), 1);
    std::shift_left(lungs_l.begin(), lungs_l.end(), 1);
    heart_bpm.back() = static_cast<float>(data.heart_bpm);
    lungs_l.back() = static_cast<float>(1e3 * data.lungs_m3);
  }
}

}  // namespace neritic::hud
