// A diver's breath as it is recorded: ten seconds of sound are analysed on one thread while the
// next are recorded on another, as published. No sample is lost while an estimate is made.
#pragma once

#include <atomic>
#include <semaphore>
#include <thread>
#include <vector>

#include "diver/breath_rate.hpp"
#include "diver/physio_recording.hpp"
#include "engine/sim/triple_buffer.hpp"

namespace neritic::diver {

struct BreathSettings {
  BreathEstimator estimator = BreathEstimator::kMultiBand;
  double block_s = 10.0;  // of sound, handed over at once: an estimate each
  // Sound that an estimate uses: two blocks, the knee of `tradeoff physiology`.
  double window_s = 20.0;
};
// The sound that is kept for breath of less than 6 a minute, if the window is shorter: three
// breaths of 4 a minute.
inline constexpr double kSlowWindow_s = 45.0;
// kBadInput: blocks of 0.5 to 60 s, windows of a block to 300 s.
Status check_breath_settings(const BreathSettings& settings);

// The analysis. One owner, one thread.
class BreathAnalyser {
 public:
  // Precondition: check_sound_rate and check_breath_settings.
  BreathAnalyser(double rate_hz, const BreathSettings& settings);
  // The next sound, of any length.
  const BreathState& take(std::span<const float> sound);
  // Lost blocks: the sound before and after them is not continuous.
  void lose(std::uint64_t blocks, double seconds);

 private:
  double rate_hz_;
  BreathSettings settings_;
  BreathBands bands_;
  std::vector<BreathFrame> frames_;  // the last window's, or kSlowWindow_s
  std::uint64_t samples_ = 0;
  double lost_s_ = 0.0;
  BreathState state_;
};

// Every block of a recording, one after the other; the last one may be shorter.
std::vector<BreathState> analyse_breath(const Recording& sound, const BreathSettings& settings);

// The two threads. record() is called by whoever has the microphone, state() by whoever reads, each
// from one thread; the analysis has its own.
class BreathMonitor {
 public:
  BreathMonitor(double rate_hz, const BreathSettings& settings);
  ~BreathMonitor();
  BreathMonitor(const BreathMonitor&) = delete;
  BreathMonitor& operator=(const BreathMonitor&) = delete;

  // Never waits: where the analysis is a whole block behind, the block is lost and counted.
  void record(std::span<const float> sound);
  // Recorder's thread: waits until what was handed over is analysed.
  void wait();
  // Recorder's thread: the sound is over. The last block, shorter than the others, is analysed too;
  // waits for it.
  void finish();
  // Reader's thread.
  const BreathState& state();

 private:
  void analyse();
  void hand_over();

  double rate_hz_;
  std::size_t block_samples_;
  BreathAnalyser analyser_;        // the analysing thread's
  std::vector<float> recording_;   // the recorder's
  std::vector<float> handed_;      // the recorder's while not full_, else the analysing thread's
  std::uint64_t lost_ = 0;         // the recorder's, since the last hand-over
  std::uint64_t handed_lost_ = 0;  // with handed_
  std::atomic<bool> full_{false}, stop_{false};
  std::counting_semaphore<> work_{0};
  sim::TripleBuffer<BreathState> states_{BreathState{}};
  std::thread thread_;
};

}  // namespace neritic::diver
