// Signals whose truth is known, for `neritic tradeoff physiology`: an ECG of given beats, breath of
// a given rate in three kinds of sound; and recordings with their references. Pure functions of
// their seed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diver/breath_bands.hpp"
#include "diver/physio_recording.hpp"
#include "engine/core/random.hpp"

namespace neritic::tools {

struct MadeHeart {
  std::vector<double> beats_s;
  std::vector<double> rate_bpm;  // at each beat, without what breath and extra beats do to it
};
// From rest over effort and back, with respiratory arrhythmia and one extra beat in thirty.
MadeHeart make_heart(double seconds, std::uint64_t seed);
// Gaussian waves around each beat, and white noise snr_db decibels below the signal's power.
std::vector<double> make_ecg(const std::vector<double>& beats_s, double rate_hz, double seconds,
                             double snr_db, std::uint64_t seed);

struct BreathSound {
  std::string kind;  // "chest", "regulator", "alike"; recorded: the sensor, as files are named
  double true_bpm = 0.0;
  diver::Recording sound;
};
// chest: in and out differ a little in colour and loudness; regulator: a valve's hiss, then
// bubbles; alike: in and out are the same, and only breaths' lengths tell. Breaths vary by 5 %.
std::vector<BreathSound> make_breath(const std::vector<double>& rates_bpm, double seconds,
                                     std::uint64_t seed);
// The .wav files of a folder and those below it whose names hold a rate (SENSOR_12bpm_...).
Result<std::vector<BreathSound>> read_breath(const std::filesystem::path& folder);
// Pieces of 0.3 to 3 s in random order: as loud, as colourful, without rhythm.
std::vector<diver::BreathFrame> in_pieces(const std::vector<diver::BreathFrame>& frames,
                                          const RandomKey& key);

}  // namespace neritic::tools
