// How often a diver breathes, out of frames of the sound. Pure functions; any thread.
#pragma once

#include <span>

#include "diver/breath_bands.hpp"

namespace neritic::diver {

// 3 to 42 breaths a minute. A window must hold two breaths: one of 20 s measures 6 a minute and
// more, one of 40 s all.
inline constexpr double kSlowestBreath_hz = 0.05, kFastestBreath_hz = 0.7;
// The slowest rate that a window of this many seconds is searched for.
double slowest_breath_hz(double window_s);

enum class BreathEstimator : std::uint8_t {
  // The largest line in the spectrum of the envelope, as published. Breathing in and breathing out
  // are both bursts of sound, so it finds twice the rate where they are alike.
  kSpectrum,
  // The envelope's autocorrelation: the same trap, a finer scale. estimate_newest_breath gives its
  // rate only near the one of kMultiBand, so that it is never that of halves.
  kAutocorrelation,
  // The line that loudness and colour of all bands share (breath_rhythm.hpp): in and out differ in
  // colour, so that only a whole breath is like the one before. The default.
  kMultiBand,
};
const char* name_of(BreathEstimator estimator);
Result<BreathEstimator> breath_estimator_of(const std::string& name);

// The confidence below which no rate is given: 0.9, 0.25 and, as published, none.
double confidence_asked(BreathEstimator estimator);

struct BreathEstimate {
  double rate_bpm = 0.0;  // 0: no breath
  // 0 to 1. kMultiBand: the share of sounds without rhythm that would look less like breath;
  // kAutocorrelation: how alike a breath is to the one before; kSpectrum: the line's share of all
  // power.
  double confidence = 0.0;
  double depth_db = 0.0;        // how far the level goes up and down
  std::uint64_t breathing = 0;  // 1: there is breath

  static void fields(auto&& field, auto& self) {
    field("rate_bpm", self.rate_bpm);
    field("confidence", self.confidence);
    field("depth_db", self.depth_db);
    field("breathing", self.breathing);
  }
};

enum class BreathQuality : std::uint8_t {
  kNone,  // steady sound, or silence
  // The sound goes up and down, but no rate is sure; or the rate is that of kSpectrum, which may be
  // twice the breath's.
  kPoor,
  kGood,  // a rate is known
};
const char* name_of(BreathQuality quality);
BreathQuality quality_of(const BreathEstimate& breath, BreathEstimator estimator);

// A snapshot's data about the breath (breath_monitor.hpp). Always finite.
struct BreathState {
  double time_s = 0.0;  // of the newest sample analysed
  BreathEstimate estimate;
  double quiet_s = 0.0;  // since the last burst of sound: a pause
  std::uint64_t blocks = 0, refused = 0;
  std::uint64_t lost_blocks = 0;  // recorded while the one before was still being analysed

  static void fields(auto&& field, auto& self) {
    field("time_s", self.time_s);
    field("estimate", self.estimate);
    field("quiet_s", self.quiet_s);
    field("blocks", self.blocks);
    field("refused", self.refused);
    field("lost_blocks", self.lost_blocks);
  }
};

// The estimate of a window of frames; `front` says which bands exist. There is no breath in steady
// noise, in silence, in less than four seconds, where the confidence is less than asked and, for
// all but kSpectrum, where the sound pauses for 1.25 breaths of the rate.
BreathEstimate estimate_breath(std::span<const BreathFrame> frames, const BreathBands& front,
                               BreathEstimator estimator, double least_confidence);
BreathEstimate estimate_breath(std::span<const BreathFrame> frames, const BreathBands& front,
                               BreathEstimator estimator);

// The same for the last seconds of a longer history. kMultiBand: if the breath is longer than the
// window can measure, or it is not sure whether a rate is the breath's or that of its halves, the
// whole history is the window.
BreathEstimate estimate_newest_breath(std::span<const BreathFrame> history, double window_s,
                                      const BreathBands& front, BreathEstimator estimator);

// Since when no burst was heard, in seconds, at the window's end: a pause. The whole window where
// there is none.
double quiet_for(std::span<const BreathFrame> frames, const BreathBands& front);

}  // namespace neritic::diver
