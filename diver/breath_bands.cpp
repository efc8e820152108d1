#include "diver/breath_bands.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/math.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

// Faster sound is averaged down: nothing above the highest band counts.
constexpr double kMostBandRate_hz = 16000.0;
constexpr double kEnvelopeLow_hz = 100.0, kEnvelopeHigh_hz = 2000.0;
constexpr double kMostSound = 1e6;
// A share of the sampling rate: a band pass that ends closer to one half is none.
constexpr double kHighestShare = 0.45;

// b over a, of a prototype 1 / (s^2 + sqrt 2 s + 1), warped so that the cut is exact.
struct Warped {
  double k, norm;
};
Warped warp(double cut_hz, double rate_hz) {
  const double k = std::tan(kPi * cut_hz / rate_hz);
  return {k, 1.0 / (1.0 + std::sqrt(2.0) * k + k * k)};
}

}  // namespace

Status check_sound_rate(double rate_hz) {
  if (rate_hz >= kLeastSoundRate_hz && rate_hz <= kMostSoundRate_hz) return {};
  return refusal("breath", fmt::format("a rate of {:g} Hz", rate_hz),
                 fmt::format("{:g} to {:g}", kLeastSoundRate_hz, kMostSoundRate_hz));
}

SecondOrderFilter SecondOrderFilter::low_pass(double cut_hz, double rate_hz) {
  const auto [k, norm] = warp(cut_hz, rate_hz);
  SecondOrderFilter f;
  f.b0_ = f.b2_ = k * k * norm;
  f.b1_ = 2.0 * f.b0_;
  f.a1_ = 2.0 * (k * k - 1.0) * norm;
  f.a2_ = (1.0 - std::sqrt(2.0) * k + k * k) * norm;
  return f;
}

SecondOrderFilter SecondOrderFilter::high_pass(double cut_hz, double rate_hz) {
  const auto [k, norm] = warp(cut_hz, rate_hz);
  SecondOrderFilter f;
  f.b0_ = f.b2_ = norm;
  f.b1_ = -2.0 * norm;
  f.a1_ = 2.0 * (k * k - 1.0) * norm;
  f.a2_ = (1.0 - std::sqrt(2.0) * k + k * k) * norm;
  return f;
}

double SecondOrderFilter::step(double x) {
  const double y = b0_ * x + s1_;
  s1_ = b1_ * x - a1_ * y + s2_;
  s2_ = b2_ * x - a2_ * y;
  // In silence the state would fade into numbers too small to be quick.
  if (std::abs(s1_) < 1e-30) s1_ = 0.0;
  if (std::abs(s2_) < 1e-30) s2_ = 0.0;
  return y;
}

BreathBands::BreathBands(double rate_hz) {
  NERITIC_CHECK(check_sound_rate(rate_hz).ok(), "{} Hz", rate_hz);
  decimation_ = std::max(1, static_cast<int>(std::ceil(rate_hz / kMostBandRate_hz)));
  rate_hz_ = rate_hz / decimation_;
  const double highest_hz = kHighestShare * rate_hz_;
  double low_hz = kLowestBreathBand_hz;
  for (int i = 0; i < kMostBreathBands && low_hz * 1.5 < highest_hz; ++i, low_hz *= 2.0) {
    const double high_hz = std::min(2.0 * low_hz, highest_hz);
    filters_.push_back({SecondOrderFilter::high_pass(low_hz, rate_hz_),
                        SecondOrderFilter::low_pass(high_hz, rate_hz_)});
    widths_hz_.push_back(high_hz - low_hz);
  }
  whole_ = {SecondOrderFilter::high_pass(kEnvelopeLow_hz, rate_hz_),
            SecondOrderFilter::low_pass(std::min(kEnvelopeHigh_hz, highest_hz), rate_hz_)};
}

void BreathBands::push(double sample, std::vector<BreathFrame>& out) {
  if (!(std::abs(sample) <= kMostSound)) {
    ++refused_;
    sample = held_;
  }
  held_ = sample;
  block_sum_ += sample;
  if (++block_count_ < decimation_) return;
  const double mean = block_sum_ / decimation_;
  block_sum_ = 0.0;
  block_count_ = 0;
  take(mean, out);
}

void BreathBands::take(double value, std::vector<BreathFrame>& out) {
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    const double x = filters_[i].step(value);
    sum_.power[i] += x * x;
  }
  sum_.envelope += std::abs(whole_.step(value));
  ++in_frame_;
  // By counting from the start, frames of a rate that 20 does not divide stay in step.
  const double ends = static_cast<double>(frames_ + 1) * rate_hz_ / kBreathFrames_hz;
  if (static_cast<double>(++samples_) < ends) return;
  for (double& power : sum_.power) power /= in_frame_;
  sum_.envelope /= in_frame_;
  out.push_back(sum_);
  sum_ = {};
  in_frame_ = 0;
  ++frames_;
}

}  // namespace neritic::diver
